/* The 3x3 mean from four samples: at two thirds of a texel off centre, bilinear filtering gives each of the nine texels one
 * ninth. Nienhaus 2005, section 3.4, with its listing 3-3 repaired (it samples one corner twice). Row E02. */
layout(location = 0) out vec4 out_0;

void main()
{
    vec2 off = vec2(2.0 / 3.0) / u_size;
    vec2 at = gl_FragCoord.xy / u_size;
    out_0 = 0.25 * (texture(t_shade, at + off * vec2(-1.0, 1.0)) + texture(t_shade, at + off) + texture(t_shade, at - off) +
                    texture(t_shade, at + off * vec2(1.0, -1.0)));
    /* Only inside the figure: its boundary stays sharp. */
    if (texelFetch(t_id, ivec2(gl_FragCoord.xy), 0).r == 0u || out_0.a < 0.999)
        out_0 = texelFetch(t_shade, ivec2(gl_FragCoord.xy), 0);
}
