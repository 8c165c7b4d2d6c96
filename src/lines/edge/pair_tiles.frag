/* Which tiles have pairs of pixels that an edge parts and records of edges have not drawn, within reach of one pixel's neighbours; and whether lines crowd there. */
#include "lines/calm.glsl"
layout(location = 0) out vec4 out_0; /* where each line is on the page is asked */
#ifdef WRITES_TOO
layout(location = 1) out vec4 out_calm; /* it is not */
#endif

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
            vec2 bare = texelFetch(t_bare, ivec2(x, y), 0).rg;
#ifdef HAS_MEETING
            bare.g = 1.0; /* some of these nobody has drawn: found.glsl */
#endif
            ink = ink.x + ink.y > 0.0 ? ink * bare : vec2(0.0);
#endif
            most += ink.x + ink.y;
        }
    bool inked = most > 0.0;
#ifdef WRITES_TOO
    bool calm = is_calm(ivec2(gl_FragCoord.xy));
    out_calm = vec4(inked && calm ? 1.0 : 0.0);
    inked = inked && !calm;
#endif
    out_0 = vec4(inked ? 1.0 : 0.0);
}
