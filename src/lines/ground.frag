/* The picture behind the lines: the figure's shade over the page. Luminance is what matters. */
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 shade = texelFetch(t_shade, pixel, 0);
    vec4 page = texelFetch(t_page, pixel, 0);
    /* A transparent page counts as white paper. */
    vec3 under = page.rgb + vec3(1.0 - page.a);
    out_0 = vec4(shade.rgb + under * (1.0 - shade.a), 1.0);
}
