/* A trail: what was here last shows, the fainter the longer ago, its colour smeared along the way. Großmann 2011, section 4.4. */
#include "motion/along.glsl"
layout(location = 0) out vec4 out_0;

#if BLEND == 1
/* As coverage of samples would: a pixel is there or not, in 16 steps over four by four pixels (Bayer 1973). */
float covered(float alpha, ivec2 pixel)
{
    const float order[16] = float[16](0.0, 8.0, 2.0, 10.0, 12.0, 4.0, 14.0, 6.0, 3.0, 11.0, 1.0, 9.0, 15.0, 7.0, 13.0, 5.0);
    return step(order[(pixel.x & 3) + 4 * (pixel.y & 3)] + 0.5, 16.0 * alpha);
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    crossing c = crossing_of(pixel);
    int count = c.depth <= texelFetch(t_scene_depth, pixel, 0).r ? samples_of(c, u_samples) : 0;
    vec4 sum = vec4(0.0);
    float trail = 0.0, latest = 2.0;
    for (int i = 0; i < count; i++) {
        float s = (float(i) + 0.5) / float(count);
        vec4 colour = mover_ago(c, s);
        latest = colour.a > 0.5 ? min(latest, s) : latest;
        float counts = s <= latest + u_smear ? 1.0 : 0.0;
        trail = max(trail, colour.a * pow(1.0 - float(i) / float(count), u_fade)); /* since half a sample */
        sum += counts * colour;
    }
    trail *= u_opacity;
#if BLEND == 1
    trail = covered(trail, pixel);
#endif
    vec4 colour = sum.a > 0.0 ? sum / sum.a * trail : vec4(0.0), whole = count > 0 ? texelFetch(t_mover, pixel, 0) : vec4(0.0);
    colour = whole + (1.0 - whole.a) * colour;
    if (colour.a < 1.0 / 1024.0)
        discard;
    out_0 = colour;
    gl_FragDepth = c.depth;
}
