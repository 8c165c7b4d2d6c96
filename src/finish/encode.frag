/* The page to sRGB with straight alpha, once, at the end. Supersamples are averaged here, as they are encoded: browsers blend coverage so, and then a line weighs in a picture what it
 * weighs in vectors. What differs from the ground, ink, is rubbed onto the paper. */
uniform sampler2D t_page;
uniform int u_samples; /* a side */
layout(location = 0) out vec4 out_0;

vec3 encoded(vec3 linear)
{
    vec3 low = linear * 12.92;
    vec3 high = 1.055 * pow(max(linear, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, vec3(lessThanEqual(linear, vec3(0.0031308))));
}

vec3 encoded_straight(vec4 colour)
{
    return colour.a > 0.0 ? encoded(clamp(colour.rgb / colour.a, 0.0, 1.0)) : vec3(0.0);
}

#ifdef HAS_PAPER
#include "finish/paper.glsl"
#endif

#ifdef HAS_PAPER
vec3 decoded(vec3 encoded_colour)
{
    vec3 high = pow((encoded_colour + 0.055) / 1.055, vec3(2.4));
    return mix(high, encoded_colour / 12.92, vec3(lessThanEqual(encoded_colour, vec3(0.04045))));
}
#endif

void main()
{
    ivec2 corner = ivec2(gl_FragCoord.xy) * u_samples;
    vec4 sum = vec4(0.0);
    for (int y = 0; y < u_samples; y++)
        for (int x = 0; x < u_samples; x++) {
            vec4 page = texelFetch(t_page, corner + ivec2(x, y), 0);
            sum += vec4(encoded_straight(page) * page.a, page.a);
        }
    sum /= float(u_samples * u_samples);
    vec4 mean = vec4(sum.a > 0.0 ? sum.rgb / sum.a : vec3(0.0), sum.a);
#ifdef HAS_PAPER
    vec4 page = u_samples == 1 ? texelFetch(t_page, corner, 0) : vec4(decoded(mean.rgb) * mean.a, mean.a);
    page = on_paper(page, gl_FragCoord.xy);
    mean = vec4(encoded_straight(page), page.a);
#endif
    out_0 = mean;
}
