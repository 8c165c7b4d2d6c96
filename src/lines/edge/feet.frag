/* The edge map, two pixels wide, from pairs of pixels; and where between them an edge runs. Records of edges know it. Where there are none the picture must tell. Two planes that meet are crossed: window depth is affine on planes. Where surfaces part, the pattern of
 * the boundary tells the slant, as it does morphological antialiasing: a straight edge passes the middle between two pixels where the boundary moves on by one. */
#define OWN_WIDTH
#include "lines/edge/edge.glsl"

#include "light/piece.glsl"
#include "lines/plane.glsl"
layout(location = 1) out vec4 out_feet; /* x, y: unit normal of the edge; z: how far it is from the pixel's middle along it; w: 1 where there is one */

/* Pixels along the boundary that are looked at, to either side. */
const int FARTHEST = 16;
/* Planes that cross farther away than this meet elsewhere. */
const float ACROSS_LEAST = -0.3, ACROSS_MOST = 1.3;

/* Where the planes of this pixel and its neighbour cross; w = 0: not between them. */
vec4 crossing(vec2 side, float depth, float next, vec4 normal_depth)
{
    vec2 own = slope_of(normal_depth, gl_FragCoord.xy), other = slope_of(neighbour(t_normal_depth, side), gl_FragCoord.xy + side), bend = own - other;
    float size = length(bend), difference = depth - next + dot(other, side), along = dot(bend, side);
    float across = -difference / (abs(along) < 1e-20 ? 1e-20 : along);
    bool between = size > 0.1 * max(length(own), length(other)) && size > 0.0 && across > ACROSS_LEAST && across < ACROSS_MOST;
    return between ? vec4(bend / size, -difference / size, 1.0) : vec4(0.0);
}

/* Is the pixel on the same side of the boundary as this one? */
bool is_beside(vec2 off, bool by_depth, float middle, bool own_nearer, uint piece)
{
    bool same = (neighbour(t_depth, off).r < middle) == own_nearer;
#if defined(HAS_ID) && PARTS
    uint other = piece_of(textureLod(t_id, (gl_FragCoord.xy + off) * u_texel, 0.0).rg);
    same = by_depth ? same : other == piece;
#endif
    return same;
}

/* How many pixels the boundary goes on straight to one side, and to where it then moves: 1, −1 or 0. */
vec2 run_of(vec2 side, vec2 along, bool by_depth, float middle, bool own_nearer, uint piece)
{
    vec2 found = vec2(float(FARTHEST), 0.0);
    int last = FARTHEST;
    for (int i = 1; i <= last; i++) {
        vec2 off = float(i) * along;
        bool here = is_beside(off, by_depth, middle, own_nearer, piece), there = is_beside(off + side, by_depth, middle, own_nearer, piece);
        bool ends = !here || there;
        found = ends ? vec2(float(i), here == there ? (here ? 1.0 : -1.0) : 0.0) : found;
        last = ends ? 0 : last;
    }
    return found;
}

/* The edge between this pixel and the neighbour at `side`, by the pattern around; w: how long the boundary is straight. */
vec4 by_pattern(vec2 side, bool by_depth, float depth, float next, uint piece)
{
    vec2 along = vec2(-side.y, side.x);
    float middle = 0.5 * (depth + next);
    vec2 ahead = run_of(side, along, by_depth, middle, depth < next, piece), back = run_of(side, -along, by_depth, middle, depth < next, piece);
    float before = back.x - 0.5, after = ahead.x - 0.5, half_size = 0.5 * (before + after);
    vec2 heights = 0.5 * vec2(back.y, ahead.y);
    float slant, height;
    if (heights.x * heights.y < 0.0) {
        slant = (heights.y - heights.x) / (2.0 * half_size);
        height = heights.x + slant * before;
    } else {
        bool first = before < after;
        float from = first ? before : after, end = first ? heights.x : heights.y;
        height = end * max(1.0 - from / half_size, 0.0);
        slant = from < half_size ? -end / half_size * (first ? 1.0 : -1.0) : 0.0;
    }
    vec2 normal = normalize(side - slant * along);
    return vec4(normal, dot(normal, side) * (0.5 + height), back.x + ahead.x);
}

vec4 foot_of(vec4 steps, vec4 creases, vec4 borders, float depth, vec4 beside, vec4 normal_depth, uvec2 id)
{
    const vec2 sides[4] = vec2[4](vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0));
    vec4 found = vec4(0.0);
    bool stepped = max(max(steps.x, steps.y), max(steps.z, steps.w)) > 0.0;
    vec4 classes = stepped ? steps : max(creases, borders);
    float most = max(max(classes.x, classes.y), max(classes.z, classes.w));
    float longest = 0.0;
    for (int k = 0; k < 4; k++) {
        int wanted = classes[k] >= 0.5 * most && (!stepped || steps[k] > 0.0) ? 1 : 0;
        for (int once = 0; once < wanted; once++) {
            vec4 crossed = stepped ? vec4(0.0) : crossing(sides[k], depth, beside[k], normal_depth);
            bool better = crossed.w > 0.0 && (longest < 1000.0 || abs(crossed.z) < abs(found.z));
            found = better ? crossed : found;
            longest = better ? 1000.0 : longest;
            int pattern = longest < 1000.0 ? 1 : 0;
            for (int again = 0; again < pattern; again++) {
                vec4 seen = by_pattern(sides[k], stepped, depth, beside[k], piece_of(id));
                found = seen.w > longest ? vec4(seen.xyz, 1.0) : found;
                longest = max(longest, seen.w);
            }
        }
    }
    return found;
}

#if defined(HAS_BARE) && defined(HAS_ID) && PARTS
/* Surfaces that turn less against each other are one where they meet: cosine. */
const float ONE_SURFACE = 0.9976;

/* 1 where a border between parts may be drawn, for the four neighbours. Shells that nearly coincide change places from pixel to pixel, so where surfaces go on smoothly, borders
 * are where records say. What has no records is left alone: solids and cut faces. */
vec4 apart(vec4 steps, vec3 normal, uvec2 id)
{
    const vec2 sides[4] = vec2[4](vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0));
    vec4 found = vec4(1.0);
    for (int k = 0; k < 4; k++) {
        uint kinds = id.g | textureLod(t_id, (gl_FragCoord.xy + sides[k]) * u_texel, 0.0).g;
        bool one = abs(dot(normal, neighbour(t_normal_depth, sides[k]).xyz)) > ONE_SURFACE && steps[k] == 0.0;
        found[k] = one && (kinds & (SURFACE_OPERAND | SURFACE_CUT)) == 0u ? 0.0 : 1.0;
    }
    return found;
}
#endif

vec4 pairs_at(ivec2 off)
{
    ivec2 at = ivec2(gl_FragCoord.xy) + off;
    return min(at.x, at.y) < 0 ? vec4(0.0) : texelFetch(t_pairs, at, 0);
}

void main()
{
    vec4 own = pairs_at(ivec2(0)), left = pairs_at(ivec2(-1, 0)), down = pairs_at(ivec2(0, -1));
    vec4 steps = vec4(own.x, left.x, own.y, down.y), both = vec4(own.z, left.z, own.w, down.w);
    vec4 borders = step(2.0, both), creases = both - 2.0 * borders, foot = vec4(0.0);
#ifdef HAS_BARE
    /* What steps beside a crease is the foot of a face too narrow for pixels, and would be drawn in some of them: the surface goes on, or another one is where it ends, as
     * at kerbs. Outlines there have records of their own. */
    steps *= texelFetch(t_bare, ivec2(gl_FragCoord.xy), 0).b;
#endif
    float profile = max(max(steps.x, steps.y), max(steps.z, steps.w));
#if defined(HAS_BARE) && defined(HAS_ID) && PARTS
    int bordered = borders != vec4(0.0) ? 1 : 0;
    for (int once = 0; once < bordered; once++)
        borders *= apart(steps, neighbour(t_normal_depth, vec2(0.0)).xyz, texelFetch(t_id, ivec2(gl_FragCoord.xy), 0).rg);
#endif
    vec2 inks = vec2(max(max(creases.x, creases.y), max(creases.z, creases.w)), max(max(borders.x, borders.y), max(borders.z, borders.w)));
#ifdef HAS_BARE
    /* Records have drawn it already. */
    vec2 bare = texelFetch(t_bare, ivec2(gl_FragCoord.xy), 0).rg;
    profile *= bare.x;
    inks *= bare.y;
#endif
    int unknown = profile + inks.x + inks.y > 0.0 ? 1 : 0;
    for (int once = 0; once < unknown; once++) {
        vec4 normal_depth = neighbour(t_normal_depth, vec2(0.0));
        vec4 beside = vec4(neighbour(t_depth, vec2(1.0, 0.0)).r, neighbour(t_depth, vec2(-1.0, 0.0)).r, neighbour(t_depth, vec2(0.0, 1.0)).r, neighbour(t_depth, vec2(0.0, -1.0)).r);
        uvec2 id = uvec2(0u);
#if defined(HAS_ID) && PARTS
        id = texelFetch(t_id, ivec2(gl_FragCoord.xy), 0).rg;
#endif
        foot = foot_of(steps, creases, borders, neighbour(t_depth, vec2(0.0)).r, beside, normal_depth, id);
    }
    write_edges(1.0 - profile, 1.0 - inks.x, 1.0 - inks.y);
    out_feet = foot;
}
