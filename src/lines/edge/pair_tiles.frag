/* Which tiles have pairs of pixels that an edge parts and records of edges have not drawn, within reach of one pixel's neighbours. */
layout(location = 0) out vec4 out_0;

const int BESIDE = 2;

void main()
{
    ivec2 corner = ivec2(gl_FragCoord.xy) * TILE_PIXELS, first = max(corner - BESIDE, ivec2(0)), end = min(corner + TILE_PIXELS + BESIDE, ivec2(u_size));
    float most = 0.0;
    for (int y = first.y; y < end.y; y++)
        for (int x = first.x; x < end.x; x++) {
            vec4 pairs = texelFetch(t_pairs, ivec2(x, y), 0);
            vec2 ink = pairs.xz + pairs.yw;
#ifdef HAS_BARE
            ink = ink.x + ink.y > 0.0 ? ink * texelFetch(t_bare, ivec2(x, y), 0).rg : vec2(0.0);
#endif
            most += ink.x + ink.y;
        }
    out_0 = vec4(most > 0.0 ? 1.0 : 0.0);
}
