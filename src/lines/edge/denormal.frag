/* One filtered sample, half a texel off centre so that four normals weigh the same: N·N = cos²(θ/2) for two that differ by θ;
 * out = 1 − 4 (1 − N·N − ε). */
#define FINDS_MEETINGS
#include "lines/edge/edge.glsl"

void main()
{
    vec4 mean = texture(t_filtered, (gl_FragCoord.xy + 0.5) / u_size);
    float smooth_length = dot(mean.xyz, mean.xyz) + u_line_tolerance;
    float inner = 1.0 - 4.0 * (1.0 - smooth_length);
    float profile = 1.0;
#if DEPTH
    /* Row OI-08: depth d as the unit vector (cos πd, sin πd); its mean is as long as the cosine of half the step's angle. */
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 4; i++) {
        float d = texel(t_filtered, ivec2(gl_FragCoord.xy) + ivec2(i & 1, i >> 1)).w * 3.14159265;
        sum += 0.25 * vec2(cos(d), sin(d));
    }
    profile = 1.0 - 4.0 * (1.0 - (dot(sum, sum) + u_line_tolerance));
#endif
    write_edges(profile, inner, 1.0);
}
