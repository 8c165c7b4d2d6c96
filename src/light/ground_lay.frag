/* The shaded ground onto the page: with its paper, which is the page's. */
uniform sampler2D  t_shade;
uniform usampler2D t_id;
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (texelFetch(t_id, pixel, 0).r == 0u)
        discard;
    out_0 = texelFetch(t_shade, pixel, 0);
}
