/* Directions averaged with those around on the same surface, farther in each round; sure ones count for more. Seed 004, section 4.1, step 5, in the picture. */
#ifndef SIZE_DECLARED
#define SIZE_DECLARED
uniform vec2 u_size;
#endif
uniform int u_iteration;
layout(location = 0) out vec4 out_0;

vec4 weighed(ivec2 texel, vec3 normal, float weight)
{
    ivec2 at = clamp(texel, ivec2(0), textureSize(t_direction, 0) - 1);
    vec3 other = texelFetch(t_normal_depth, min(at * 2, ivec2(u_size) - 1), 0).xyz;
    return texelFetch(t_direction, at, 0) * (weight * step(0.8, dot(normal, other)));
}

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy);
    int far = u_iteration == 0 ? 1 : 3;
    vec4 own = texelFetch(t_direction, texel, 0);
    vec3 normal = texelFetch(t_normal_depth, min(texel * 2, ivec2(u_size) - 1), 0).xyz;
    vec4 sum = own * 4.0;
    sum += weighed(texel + ivec2(far, 0), normal, 2.0) + weighed(texel - ivec2(far, 0), normal, 2.0);
    sum += weighed(texel + ivec2(0, far), normal, 2.0) + weighed(texel - ivec2(0, far), normal, 2.0);
    sum += weighed(texel + ivec2(far, far), normal, 1.0) + weighed(texel - ivec2(far, far), normal, 1.0);
    sum += weighed(texel + ivec2(far, -far), normal, 1.0) + weighed(texel - ivec2(far, -far), normal, 1.0);
    out_0 = own.a > 0.0 ? vec4(sum.xy / sum.a, 0.0, 1.0) : vec4(0.0);
}
