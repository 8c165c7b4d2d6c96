/* The edge map, two pixels wide, from pairs of pixels; and where between them an edge runs. Records of edges know it. Where there are none the picture must tell. Two planes that meet are crossed: window depth is affine on planes. Where surfaces part, the pattern of
 * the boundary tells the slant, as it does morphological antialiasing: a straight edge passes the middle between two pixels where the boundary moves on by one. */
#define OWN_WIDTH
#include "lines/edge/found.glsl"
#include "lines/plane.glsl"
#ifdef HAS_BARE
#include "lines/steps.glsl"
#endif
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

#ifdef HAS_MEETING
/* The same of the plane of another rule's surface. */
vec4 crossing_of_meeting(float depth, vec4 normal_depth)
{
    vec2 bend = slope_of(normal_depth, gl_FragCoord.xy) - meeting_slope();
    float size = max(length(bend), 1e-20);
    return vec4(bend / size, (meeting_depths(vec2(0.0)).y - depth) / size, 1.0);
}
#endif

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

/* The first one that is above 0, as the only one. */
vec4 first_of(vec4 some)
{
    vec4 one = step(0.5, some);
    return one * vec4(1.0, 1.0 - one.x, (1.0 - one.x) * (1.0 - one.y), (1.0 - one.x) * (1.0 - one.y) * (1.0 - one.z));
}

vec4 foot_of(vec4 steps, vec4 creases, vec4 borders, float depth, vec4 beside, vec4 normal_depth, uvec2 id)
{
    vec4 found = vec4(0.0);
    bool stepped = max(max(steps.x, steps.y), max(steps.z, steps.w)) > 0.0;
    vec4 classes = stepped ? steps : max(creases, borders);
    float most = max(max(classes.x, classes.y), max(classes.z, classes.w));
    float longest = 0.0;
    /* To the right, left, up and down. One of those that are wanted a turn, so that pixels beside each other, which want different ones, are done in as many turns as one of them
     * needs; without indices, which software drivers follow through memory. */
    vec4 left = step(0.5 * most, classes) * (stepped ? vec4(greaterThan(steps, vec4(0.0))) : vec4(1.0));
    int turns = int(dot(left, vec4(1.0)));
    for (int i = 0; i < turns; i++) {
        vec4 one = first_of(left);
        vec2 side = vec2(one.x - one.y, one.z - one.w);
        float next = dot(one, beside);
        left -= one;
        vec4 crossed = stepped ? vec4(0.0) : crossing(side, depth, next, normal_depth);
#ifdef HAS_MEETING
        bool met = !stepped && meets(side);
        crossed = met ? crossing_of_meeting(depth, normal_depth) : crossed;
#endif
        bool better = crossed.w > 0.0 && (longest < 1000.0 || abs(crossed.z) < abs(found.z));
        found = better ? crossed : found;
        longest = better ? 1000.0 : longest;
        int pattern = longest < 1000.0 ? 1 : 0;
        for (int again = 0; again < pattern; again++) {
            vec4 seen = by_pattern(side, stepped, depth, next, piece_of(id));
            found = seen.w > longest ? vec4(seen.xyz, 1.0) : found;
            longest = max(longest, seen.w);
        }
    }
    return found;
}

#ifdef HAS_BARE
const float GOES_ON = 0.9; /* of the places along it */

/* Outlines within a mesh have records. Where pixels find a step that none explains, what is behind it is hardly deeper and it does not go on, there is no line. */
bool is_doubtful(vec4 steps, float depth, vec4 beside, uvec2 id)
{
    const vec2 sides[4] = vec2[4](vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0));
    bool within = true;
    for (int k = 0; k < 4; k++) {
        float beyond = neighbour(t_depth, 2.0 * sides[k]).r - beside[k], before = depth - neighbour(t_depth, -sides[k]).r;
        bool sure = is_much_deeper(min(depth, beside[k]), max(depth, beside[k]), max(abs(beyond), abs(before)));
#if defined(HAS_ID) && PARTS
        uvec2 other = textureLod(t_id, (gl_FragCoord.xy + sides[k]) * u_texel, 0.0).rg;
        sure = sure || piece_of(other) != piece_of(id) || ((id.g | other.g) & (SURFACE_OPERAND | SURFACE_CUT)) != 0u;
#endif
        within = within && !(sure && steps[k] > 0.0);
    }
    return within;
}
#endif

void main()
{
    found_edges found = find_edges();
    vec4 foot = vec4(0.0);
    int unknown = found.profile + found.inks.x + found.inks.y > 0.0 ? 1 : 0;
    for (int once = 0; once < unknown; once++) {
        vec4 normal_depth = neighbour(t_normal_depth, vec2(0.0));
        vec4 beside = vec4(neighbour(t_depth, vec2(1.0, 0.0)).r, neighbour(t_depth, vec2(-1.0, 0.0)).r, neighbour(t_depth, vec2(0.0, 1.0)).r, neighbour(t_depth, vec2(0.0, -1.0)).r);
        uvec2 id = uvec2(0u);
#if defined(HAS_ID) && PARTS
        id = texelFetch(t_id, ivec2(gl_FragCoord.xy), 0).rg;
#endif
        float depth = neighbour(t_depth, vec2(0.0)).r;
        foot = foot_of(found.steps, found.creases, found.borders, depth, beside, normal_depth, id);
#ifdef HAS_BARE
        int doubtful = found.profile > 0.0 && foot.w > 0.0 && is_doubtful(found.steps, depth, beside, id) ? 1 : 0;
        for (int again = 0; again < doubtful; again++)
            found.profile *= step(GOES_ON, steps_along(gl_FragCoord.xy + foot.z * foot.xy, foot.xy, 1.0));
        foot *= found.profile + found.inks.x + found.inks.y > 0.0 ? 1.0 : 0.0;
#endif
    }
    write_edges(1.0 - found.profile, 1.0 - found.inks.x, 1.0 - found.inks.y);
    out_feet = foot;
}
