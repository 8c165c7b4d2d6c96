/* Ink where any of the four diagonal and four straight neighbours inside the width has another id. Ids are never filtered. */
#define FINDS_MEETINGS
#define MEETINGS_ARE_BORDERS
#include "lines/edge/edge.glsl"
#include "light/piece.glsl"

uint id_at(ivec2 off)
{
    uvec2 id = texelFetch(t_id, clamp(ivec2(gl_FragCoord.xy) + off, ivec2(0), ivec2(u_size) - 1), 0).rg;
#if OF == 0
    return piece_of(id);
#else
    return id.r * 4096u + (id.g & (SURFACE_INDEX_MASK | SURFACE_CUT));
#endif
}

void detect_edges()
{
    uint own = id_at(ivec2(0));
    bool up = id_at(ivec2(0, 1)) != own || id_at(ivec2(1, 0)) != own;
    bool down = id_at(ivec2(0, -1)) != own || id_at(ivec2(-1, 0)) != own;
    /* One pixel wide, the line lies on one side of the border; at two it lies on both. */
    float ink = up ? 1.0 : down ? 1.0 : 0.0;
    write_edges(1.0, 1.0, 1.0 - ink);
}
