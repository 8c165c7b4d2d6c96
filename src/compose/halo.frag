/* The widened ink of one layer, widened upwards too and added to that of the layers before. */
uniform vec2 u_texel;
layout(location = 0) out vec4 out_0;

void main()
{
    int reach = int(ceil(u_halo));
#ifdef HAS_HALO
    float ink = texelFetch(t_halo, ivec2(gl_FragCoord.xy), 0).r;
#else
    float ink = 0.0;
#endif
    for (int y = -reach; y <= reach; y++)
        ink = max(ink, textureLod(t_halo_row, (gl_FragCoord.xy + vec2(0.0, float(y))) * u_texel, 0.0).r);
    out_0 = vec4(ink);
}
