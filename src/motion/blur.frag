/* Motion blur: the mean of what crosses a pixel. */
#include "motion/along.glsl"
layout(location = 0) out vec4 out_0;

#ifdef WITH_GLINTS
/* Bright samples count more: what glints stays as bright along its way. Named by Großmann 2011, section 4.5.7, after Tatarchuk. */
float weight_of(vec4 colour)
{
    float light = dot(colour.rgb, vec3(0.2126, 0.7152, 0.0722)) / max(colour.a, 1e-4);
    return exp2(12.0 * u_glints * (light - 1.0));
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    crossing c = crossing_of(pixel);
    int count = c.depth <= texelFetch(t_scene_depth, pixel, 0).r ? samples_of(c, u_samples) : 0;
    vec4 sum = vec4(0.0), bright = vec4(0.0);
    for (int i = 0; i < count; i++) {
        vec4 colour = mover_ago(c, count > 1 ? (float(i) + 0.5) / float(count) : 0.0);
        sum += colour;
#ifdef WITH_GLINTS
        bright += colour * weight_of(colour);
#endif
    }
    sum /= float(max(count, 1));
#ifdef WITH_GLINTS
    sum.rgb = bright.a > 0.0 ? bright.rgb * (sum.a / bright.a) : sum.rgb;
#endif
    if (sum.a < 1.0 / 1024.0)
        discard;
    out_0 = sum;
    gl_FragDepth = c.depth;
}
