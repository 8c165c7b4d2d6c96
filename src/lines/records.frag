/* Edges of meshes as lines, straight into the edge map, which keeps the darkest of each class; and the pixels that need no other edge. */
#include "lines/stroke/visible.glsl"
#include "lines/record.glsl"
flat in vec4 v_begin;
flat in vec4 v_end;
flat in vec4 v_look;
#ifdef SHORT_EDGES
flat in uvec4 v_seen;
flat in float v_seen_count;
#endif
#include "light/piece.glsl"
#include "lines/cover.glsl"
#include "lines/room.glsl"
#include "lines/steps.glsl"
layout(location = 0) out vec4 out_edge;
layout(location = 1) out vec4 out_bare;

/* What lies beneath a line and so far beyond would only make its side rough: faces about a pixel high come and go there. */
const float BENEATH = 0.75, WHOLE = 0.9;
const float APART = 2.0, BEHIND = 1.5; /* pixels */

#ifdef OPEN_BODIES
/* Where parts of the model are left out, an edge before what is seen may be one of those. */
bool is_on_surface(vec3 axis, bool wanted)
{
    const vec2 X = vec2(1.0, 0.0), Y = vec2(0.0, 1.0);
    bool on = false;
    int turns = wanted ? 9 : 0;
    for (int i = 0; i < turns; i++) {
        turns = on ? 0 : turns;
        vec2 pixel = floor(axis.xy) + vec2(float(i % 3) - 1.0, float(i / 3) - 1.0), off = axis.xy - pixel - 0.5;
        float here = depth_at(pixel);
        vec2 slope = vec2(smaller(depth_at(pixel + X) - here, here - depth_at(pixel - X)), smaller(depth_at(pixel + Y) - here, here - depth_at(pixel - Y)));
        on = on || (here < 1.0 && abs(axis.z - here - dot(slope, off)) <= ROUNDING + (abs(slope.x) + abs(slope.y)));
    }
    return on;
}
#endif

bool is_seen(vec3 axis, bool wanted)
{
#ifdef OPEN_BODIES
    return is_on_surface(axis, wanted);
#else
    return is_mostly_visible(axis, wanted);
#endif
}

/* As most of three positions along the edge are: where faces are about a pixel high, single ones come and go, and lines would be stitches and beads. */
#ifdef SHORT_EDGES
uint seen_bit(int place)
{
    uvec2 half_of = place < 64 ? v_seen.xy : v_seen.zw;
    return ((place & 32) == 0 ? half_of.x : half_of.y) >> uint(place & 31) & 1u;
}

bool is_short_seen(float at, float size)
{
    int last = int(v_seen_count) - 1, place = clamp(int(at * v_seen_count), 0, last), apart = max(int(APART * v_seen_count / max(size, 1.0) + 0.5), 1);
    return seen_bit(max(place - apart, 0)) + seen_bit(place) + seen_bit(min(place + apart, last)) >= 2u;
}
#endif
#if !defined(SHORT_EDGES) || defined(ALL_EDGES)
bool is_long_seen(vec3 axis, float at, float size, bool wanted)
{
    float apart = APART / max(size, 1e-6);
    vec3 before = mix(v_begin.xyz, v_end.xyz, max(at - apart, 0.0)), behind = mix(v_begin.xyz, v_end.xyz, min(at + apart, 1.0));
    bool first = is_seen(axis, wanted), second = is_seen(before, wanted), third = is_seen(behind, wanted && first != second);
    return first == second ? first : third;
}
#endif

bool is_seen_around(vec3 axis, float at, float size, bool wanted)
{
#ifdef ALL_EDGES
    return v_seen_count > 0.0 ? is_short_seen(at, size) : is_long_seen(axis, at, size, wanted);
#elif defined(SHORT_EDGES)
    return is_short_seen(at, size);
#else
    return is_long_seen(axis, at, size, wanted);
#endif
}

#if defined(HAS_ID) && PARTS
uint piece_at(vec2 at)
{
    return piece_of(texelFetch(t_id, ivec2(clamp(at, vec2(0.0), u_far_corner)), 0).rg);
}
#endif

/* Of an outline of what is smooth, at a position of its axis: how much of it pixels find there, or, where what is behind it is hardly deeper, all along. */
float outline_at(vec3 axis, vec2 normal, out bool judged)
{
    vec2 away = BEHIND * normal;
    float found = step_at(axis.xy, normal);
    int within = 1;
    judged = false;
#if defined(HAS_ID) && PARTS
    within = piece_at(axis.xy + away) != piece_at(axis.xy - away) ? 0 : 1;
#endif
    for (int once = 0; once < within; once++) {
        float one = depth_at(floor(axis.xy + away)), other = depth_at(floor(axis.xy - away)), behind = max(one, other);
        float beyond = depth_at(floor(axis.xy + (one > other ? 2.0 : -2.0) * away));
        int doubtful = found > 0.0 && is_much_deeper(axis.z, behind, (beyond - behind) / BEHIND) ? 0 : 1;
        for (int again = 0; again < doubtful; again++) {
            float share = steps_along(axis.xy, normal, found);
            judged = share > 0.0;
            found = smoothstep(STEPS_FEW, STEPS_MANY, share);
        }
    }
    return found;
}

/* From the curve over the chord (record_bends.h), as far as its slope is small; `way` turns to it. */
float distance_of_curve(float at, float size, vec2 along, inout vec2 way)
{
    float rest = 1.0 - at, height = at * rest * (rest * v_look.y + at * v_look.z);
    float slope = (rest * (1.0 - 3.0 * at) * v_look.y + at * (2.0 - 3.0 * at) * v_look.z) / max(size, 1e-6);
    bool inside = at > 0.0 && at < 1.0;
    vec2 forward = along / max(size, 1e-6), normal = vec2(-forward.y, forward.x);
    float across = (dot(way, normal) - height) * inversesqrt(1.0 + slope * slope);
    bool bent = inside && (v_look.y != 0.0 || v_look.z != 0.0);
    way = bent ? (normal - slope * forward) * across : way;
    return bent ? abs(across) : length(way);
}

void main()
{
    vec2 along = v_end.xy - v_begin.xy, from = gl_FragCoord.xy - v_begin.xy;
    float size = length(along), at = clamp(dot(from, along) / max(size * size, 1e-12), 0.0, 1.0);
    float half_width = 0.5 * line_width_at(gl_FragCoord.xy) * (v_look.x < 0.0 ? u_line_crease_width : 1.0);
    vec3 axis = mix(v_begin.xyz, v_end.xyz, at);
    vec2 way = gl_FragCoord.xy - axis.xy;
    float chord_d = length(way), reach = max(0.5 * u_line_width + 0.75, RECORD_REACH);
    vec2 way_of_line = way;
    float d = distance_of_curve(at, size, along, way_of_line);
    bool within = min(d, chord_d) <= reach;
    int wanted = is_seen_around(axis, at, size, within) && within ? 1 : 0;
    bool judged = false; /* pixels that find a step of depth there are to draw none */
    vec2 ink = vec2(0.0), strength = vec2(0.0); /* of outlines and of creases */
    for (int once = 0; once < wanted; once++) {
        vec2 normal = vec2(-along.y, along.x) / max(size, 1e-6);
        strength = vec2(v_look.x > RECORDED_OUTLINE && v_look.x < RECORDED_QUIET ? 1.0 : 0.0, max(-v_look.x, 0.0));
#ifdef SMOOTH_OUTLINES /* have a line only where something is behind them */
        if (v_look.x == RECORDED_OUTLINE)
            strength.x = outline_at(axis, normal, judged);
#endif
        ink = strength * line_cover(d, length(way_of_line) > 0.01 ? normalize(way_of_line) : normal, half_width);
        wanted = judged || max(strength.x, strength.y) > 0.0 || v_look.x == RECORDED_QUIET ? wanted : 0;
    }
    if (wanted == 0)
        discard;
    vec2 left = 1.0 - ink;
    out_edge = vec4(left.x, left.y, left.x * left.y, 1.0);
    /* Beside a crease another piece may have an outline. */
    float bare = min(d, chord_d) <= (max(strength.x, strength.y) >= WHOLE ? max(0.5 * u_line_width + BENEATH, RECORD_REACH) : RECORD_REACH) ? 0.0 : 1.0;
    out_bare = vec4(ink.x > 0.0 || (v_look.x > 0.0 && v_look.x < RECORDED_QUIET) ? bare : 1.0, bare, strength.y > 0.0 ? bare : 1.0, 1.0);
}
