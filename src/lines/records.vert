/* Edges of meshes as narrow quads, for where they are on the page. Those that are no lines are moved out of sight. */
#include "lines/stroke/decide.glsl"
#include "lines/stroke/quad.glsl"
#include "lines/stroke/visible.glsl"
#include "lines/record.glsl"
#ifdef SHORT_EDGES
flat out uvec4 v_seen;       /* one bit a position */
flat out float v_seen_count; /* of them */
#define DRAWS_SHORT true
#else
#define DRAWS_SHORT false
#endif
#ifdef SMOOTH_OUTLINES
#define DRAWS_SMOOTH true
#else
#define DRAWS_SMOOTH false
#endif
/* ALL_EDGES: both kinds of both at once; of long ones v_seen_count is then 0. */
uniform mat4 u_clip; /* from the mesh's axes to clip space */

vec3 on_page(vec4 clip)
{
    vec3 position = 0.5 * clip.xyz / clip.w + 0.5;
    return vec3(position.xy * u_size, position.z);
}

uniform vec2 u_judged; /* cosines of so much of `faint` and of `crease` */

/* The code of a record (lines/record.glsl); 0 where there is no line. */
float code_of(int line)
{
    int bits = int(a_begin.w);
    /* Whole chains are as strong as they are in the mean, so that none ends where one of its edges turns less. */
    float cosine = a_first.w > 0.0 ? cos(a_first.w) : dot(a_first.xyz, a_second.xyz);
    float faint = u_judged.x, sharp = u_judged.y;
    float crease = (bits & RECORD_ROUNDED) != 0 ? 1.0 : (bits & RECORD_CREASE) != 0 ? clamp((faint - cosine) / max(faint - sharp, 1e-4), 0.0, 1.0) : 0.0;
    float quiet = (bits & RECORD_QUIET) != 0 ? RECORDED_QUIET : 0.0;
    return line == INNER ? -crease : line != PROFILE ? quiet : (bits & RECORD_BORDER) != 0 ? RECORDED_BORDER : RECORDED_OUTLINE + crease;
}

const float LEVELS = 127.0, BASE = 2.0 * LEVELS + 2.0, BEND_SHARE = 4.0 / 27.0;

vec3 bend_of(float word)
{
    vec3 levels = mod(floor(word / vec3(BASE * BASE, BASE, 1.0)), BASE);
    return word > 0.0 ? (levels - LEVELS) / LEVELS : vec3(0.0);
}

float height_of(vec3 at, vec3 bend, float size, vec2 page, vec2 normal)
{
    vec4 clip = u_clip * vec4(at + size * bend, 1.0);
    return clip.w > 0.0 ? dot(on_page(clip).xy - page, normal) : 0.0;
}

/* How the curve leaves the chord at both ends, pixels; both less where it would be farther from it than it may. */
vec2 bends_of(bool whole)
{
    vec2 along = v_end.xy - v_begin.xy, heights = vec2(0.0);
    float size = length(along);
    if (u_line_round <= 0.0 || size < 1.0 || !whole)
        return heights;
    vec2 normal = vec2(-along.y, along.x) / size;
    float chord = distance(a_begin.xyz, a_end.xyz);
    heights = vec2(height_of(a_begin.xyz, bend_of(a_second.w), chord, v_begin.xy, normal), height_of(a_end.xyz, bend_of(-a_end.w), chord, v_end.xy, normal));
    float farthest = BEND_SHARE * (abs(heights.x) + abs(heights.y));
    return heights * min(1.0, u_line_round / max(farthest, 1e-6));
}

void place_edge(float code)
{
    vec4 begin = u_clip * vec4(a_begin.xyz, 1.0), end = u_clip * vec4(a_end.xyz, 1.0);
    float first = begin.z + begin.w, second = end.z + end.w;
    if (first <= 0.0 && second <= 0.0)
        return;
    if (first <= 0.0)
        begin = mix(end, begin, second / (second - first));
    else if (second <= 0.0)
        end = mix(begin, end, first / (first - second));
    v_begin = vec4(on_page(begin), 0.0);
    v_end = vec4(on_page(end), 0.0);
    v_look = vec4(code, bends_of(first > 0.0 && second > 0.0), 0.0);
    /* A quad has half a pixel more. The curves' factors are 4/27 at most. */
    v_begin.w = v_end.w = max(0.5 * u_line_width + 0.75, RECORD_REACH) - 0.5 + BEND_SHARE * (abs(v_look.y) + abs(v_look.z));
    gl_Position = corner_of(v_begin, v_end);
}

/* Positions along the edge are looked at STEP apart, in pixels, of long ones MOST, so that those wholly hidden cost no fragments; and by turns in each
 * of PARTS_OF_EDGE, so that the first few tell of the whole edge. Of short ones fragments are told which positions are seen, so that none has to look for itself. */
const float STEP = 2.0;
const int MOST = 120;
const int PARTS_OF_EDGE = 4;
/* What a rim hides, less than a pixel beside it, is seen here and there as pixels have their middles, in many places with less weight than this; what is before all, with half or
 * more nearly everywhere. One place of the one kind counts as many of the other; the first few tell which it is. */
const float POORLY = 0.3;
const int AGAINST = 2, SURELY = 2, OF_SHORT = 4; /* of no more positions than these one will do */

bool is_hidden(float size, bool is_short)
{
    int positions = min(int(ceil(max(size, STEP) / STEP)), MOST), parts = min(positions, PARTS_OF_EDGE), each = (positions + parts - 1) / parts;
    int found = 0, score = 0, surely = positions <= OF_SHORT ? 1 : SURELY, turns = each * parts;
    float share = 1.0 / float(turns);
    bool decided = false;
    for (int i = 0; i < turns; i++) {
        int place = i % parts * each + i / parts;
        float weight = seen_weight(mix(v_begin.xyz, v_end.xyz, (float(place) + 0.5) * share), POORLY, true);
        found += weight > 0.0 ? 1 : 0;
        score += decided ? 0 : weight >= POORLY ? 1 : weight > 0.0 ? -AGAINST : 0;
        bool seen = score >= surely, hidden = score <= -surely * AGAINST;
        decided = seen || hidden;
#ifdef SHORT_EDGES
        uint bit = weight >= ENOUGH ? 1u << uint(place & 31) : 0u;
        ivec4 word = ivec4(place >> 5) - ivec4(0, 1, 2, 3);
        v_seen |= bit * uvec4(equal(word, ivec4(0)));
        turns = hidden || (decided && !is_short) ? 0 : turns;
#else
        turns = decided ? 0 : turns;
#endif
    }
#ifdef SHORT_EDGES
    v_seen_count = is_short ? float(each * parts) : 0.0;
#endif
    return found == 0 ? size <= STEP * float(MOST) : score < 0;
}

void main()
{
    int line = line_of_edge();
    float code = code_of(line);
    gl_Position = NOWHERE;
    v_begin = v_end = v_look = vec4(0.0);
#ifdef SHORT_EDGES
    v_seen = uvec4(0u);
    v_seen_count = 0.0;
#endif
    if (code != 0.0)
        place_edge(code);
    float size = distance(v_begin.xy, v_end.xy);
    bool is_short = size <= LONGEST_SHORT, wanted = v_look.x != 0.0;
#ifndef ALL_EDGES
    wanted = wanted && is_short == DRAWS_SHORT && (v_look.x == RECORDED_OUTLINE) == DRAWS_SMOOTH;
#endif
    if (!wanted || is_hidden(size, is_short))
        gl_Position = NOWHERE;
}
