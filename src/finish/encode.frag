/* The page with straight alpha, once, at the end; supersamples are averaged here, and what differs from the ground, ink, is rubbed onto the paper. */
uniform sampler2D t_page;
uniform int u_samples; /* a side */
layout(location = 0) out vec4 out_0;

#ifdef HAS_PAPER
#include "finish/paper.glsl"
#endif

void main()
{
    ivec2 corner = ivec2(gl_FragCoord.xy) * u_samples;
    vec4 sum = vec4(0.0);
    for (int y = 0; y < u_samples; y++)
        for (int x = 0; x < u_samples; x++)
            sum += texelFetch(t_page, corner + ivec2(x, y), 0);
    sum /= float(u_samples * u_samples);
#ifdef HAS_PAPER
    sum = on_paper(sum, gl_FragCoord.xy);
#endif
    vec3 straight = sum.a > 0.0 ? clamp(sum.rgb / sum.a, 0.0, 1.0) : vec3(0.0);
    out_0 = vec4(straight, sum.a);
}
