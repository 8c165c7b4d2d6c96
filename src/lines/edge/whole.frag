/* The edge map of all pairs of pixels that an edge parts: lines two pixels wide, for passes that work on whole lines. */
#define OWN_WIDTH
#include "lines/edge/edge.glsl"

vec4 pairs_at(ivec2 off)
{
    ivec2 at = ivec2(gl_FragCoord.xy) + off;
    return min(at.x, at.y) < 0 ? vec4(0.0) : texelFetch(t_pairs, at, 0);
}

void main()
{
    vec4 own = pairs_at(ivec2(0)), left = pairs_at(ivec2(-1, 0)), down = pairs_at(ivec2(0, -1));
    vec4 both = vec4(own.z, left.z, own.w, down.w), borders = step(2.0, both), creases = both - 2.0 * borders;
    float profile = max(max(own.x, left.x), max(own.y, down.y));
    write_edges(1.0 - profile, 1.0 - max(max(creases.x, creases.y), max(creases.z, creases.w)), 1.0 - max(max(borders.x, borders.y), max(borders.z, borders.w)));
}
