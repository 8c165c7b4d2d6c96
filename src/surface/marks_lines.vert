/* Engraved lines: each piece is a record four times, a corner each. Both ends decide about themselves, so that lines swell and run out: marks/marks_flow.c in the vertex stage. */
#include "surface/marks.glsl"

layout(location = 0) in vec4 a_from;        /* the level at which it comes */
layout(location = 1) in vec4 a_to;          /* its own level + 32 times the number of its set + 128 times how dark its group is, 0 ... 62 */
layout(location = 2) in vec4 a_from_normal; /* how wide its strip is at four levels, packed */
layout(location = 3) in vec4 a_to_normal;
layout(location = 4) in vec4 a_along;       /* how far both ends are from where the line runs out, brightness of the model at both, packed, how broad its face is at both, packed */
layout(location = 5) in vec4 a_group;       /* of both ends, packed: fraction of the stroke drawn, how far off the line, shade on a flat face, how far from an edge */

uniform float u_near_plane, u_levels, u_apart, u_sag; /* distance of the first level; how far pieces leave the surface */

flat out vec3 v_normal; /* of its surface, towards the viewer */
flat out vec4 v_ends;    /* of the piece, pixels */
flat out vec4 v_depths;  /* 1 / depth of both ends (or depth), tolerance as fraction of the depth (or as depth), which ends lie on an edge: 1 the first + 2 the second */
out float v_half_width;

const float RAMP = 0.5, UNEVEN = 0.3, SPARSE = 14.0, GRAZING = 0.05, BLACK = 0.8, FILLED = 2.0;

vec4 spaces_of(float packed_spaces)
{
    vec4 shifted = floor(packed_spaces / vec4(1.0, 64.0, 4096.0, 262144.0));
    return (shifted - 64.0 * vec4(shifted.yzw, 0.0)) * 0.04;
}

float cover_of_set(float dark, float set)
{
    float first = u_crossed + (0.9 - u_crossed) * (dark - u_crossed) / max(1.0 - u_crossed, 1e-6);
#if SERIES == 1
    return dark;
#elif STEADY
    float left = dark;
    for (float before = 0.5; before < set; before += 1.0)
        left = max(left - u_crossed, 0.0) / max(1.0 - u_crossed, 1e-6);
    return set > float(SERIES) - 1.5 ? left : min(left, u_crossed);
#else
    if (dark <= u_crossed)
        return set < 0.5 ? dark : 0.0;
    return set < 0.5 ? first : 1.0 - pow((1.0 - dark) / (1.0 - first), 1.0 / float(SERIES - 1));
#endif
}

/* How much lines have grown that began so long ago, summed up to now. */
float grown(float since)
{
    float t = clamp(since, 0.0, RAMP);
    return t * t / (2.0 * RAMP) + max(since - RAMP, 0.0);
}

/* Of its strip's width at a level; marks/marks_flow.c. */
float strip_of(float own, float rank, vec4 spaces, float level)
{
    float whole = clamp(floor(level), 0.0, u_levels - 1.0), after = whole - own, last = step(u_levels - 1.5, whole);
    float coming = level > 0.0 ? (grown(level - whole - 0.1) - grown(level - whole - 0.1 - UNEVEN)) / UNEVEN * (1.0 - last) : 0.0;
    float now = after > 3.5 ? 1.0 : after > 2.5 ? spaces.w : after > 1.5 ? spaces.z : after > 0.5 ? spaces.y : spaces.x;
    float next = after > 2.5 ? 1.0 : after > 1.5 ? spaces.w : after > 0.5 ? spaces.z : spaces.y;
    float old = now + coming * (0.5 * next - now), fresh = 0.5 * spaces.x * clamp((level - rank) / RAMP, 0.0, 1.0) * (1.0 - last);
    return (after < -1.5 ? 0.0 : after < -0.5 ? fresh : old) * exp2(-whole);
}

/* Pixels to a unit across the line. */
float across_on_page(mark_position m, vec3 direction)
{
    float depth = u_perspective > 0.5 ? max(-m.eye.z, 1e-20) : 1.0;
    float area = u_perspective > 0.5 ? abs(dot(m.eye, m.normal)) / (depth * depth * depth) : abs(m.normal.z);
    vec2 seen = u_perspective > 0.5 ? direction.xy + m.eye.xy * (direction.z / depth) : direction.xy;
    return u_focal * area * depth / max(length(seen), 0.02);
}

/* How much of the width is left so many distances from where the line runs out; all where lines join. */
float tip_at(float to_end, float cover)
{
    float left = pow(clamp(to_end / max(u_taper, 1e-20), 0.0, 1.0), u_tip);
    return mix(left, 1.0, smoothstep(0.5 * u_join, u_join, cover));
}

/* One of two numbers, 0 ... 1, that belong to the piece's ends. */
float of_end(float packed_numbers, bool at_end)
{
    float second = floor(packed_numbers / 4096.0);
    return (at_end ? second : packed_numbers - 4096.0 * second) / 4095.0;
}

/* The same, −1 ... 1. */
float signed_of_end(float packed_numbers, bool at_end)
{
    return of_end(packed_numbers, at_end) * (4095.0 / 2047.0) - 1.0;
}

/* A length, in distances of the finest lines. */
float length_of_end(float packed_lengths, bool at_end)
{
    return exp2(of_end(packed_lengths, at_end) * 4095.0 / 256.0) - 1.0;
}

/* Of the edge. */
float to_edge_of(bool at_end)
{
    return length_of_end(a_group.w, at_end);
}

/* Darker by so much where strokes are dark; where they are light, it is the dark between them that changes. */
float graded(float cover, float by)
{
    return clamp(strokes_are_light() ? 1.0 - (1.0 - cover) * by : cover * by, 0.0, 1.0);
}

float with_sparse(float cover, float ink)
{
    return strokes_are_light() ? min(cover, 1.0 - ink) : max(cover, ink);
}

/* What is covered next to edges where light leaves the page bare: marks/marks_flow.c. */
float sparse_at(float distances, float own)
{
    float line = fract(a_from.w * 61.0 + own * 0.73 + 0.5), reach = SPARSE * line * line / max(u_sparse * u_sparse, 1e-6);
    return line < u_sparse ? 1.6 * u_least * clamp(1.5 * (1.0 - distances / max(reach, 1e-6)), 0.0, 1.0) : 0.0;
}

/* Half the width of the line at an end, pixels. */
float half_width_at(mark_position m, vec3 direction, float spaces, float to_end, bool at_end)
{
    float group = floor(a_to.w / 128.0), set = floor(a_to.w / 32.0) - 4.0 * group, own = a_to.w - 128.0 * group - 32.0 * set;
    float across = across_on_page(m, direction), level = log2(max(u_apart * across / u_scale, 1e-6));
    if (own > level + 1.0 && own > 0.0)
        return 0.0;
    float strip = strip_of(own, a_from.w, spaces_of(spaces), level) * u_apart * across;
    float swell = fract(a_from.w * 97.0 + own * 0.37) - 0.5;
    float bright = of_end(a_along.z, at_end), dark = darkness_at(m, bright * bright);
#ifdef WITH_GRADIENT
    dark = graded(dark, 1.0 + u_gradient * signed_of_end(a_group.z, at_end));
#endif
    float cover = cover_of_set(dark, set) * (1.0 + u_swell * swell);
    cover *= (1.0 + u_pressure * (1.0 - 2.0 * of_end(a_group.x, at_end))) * (1.0 + u_patchy * (group / 31.0 - 1.0));
#ifdef WITH_SPARSE
    if (set < 0.5)
        cover = with_sparse(cover, sparse_at(to_edge_of(at_end) * exp2(1.0 - u_levels) * u_apart * across / u_scale, own));
#endif
    float most = u_widest < 2.0 ? u_widest * u_scale : 1e9;
#ifdef WITH_ROOM
    float room = length_of_end(a_along.w, at_end) * exp2(1.0 - u_levels) * u_apart;
    float needed = u_room * (1.0 + set), roomy = smoothstep(0.5 * needed, needed, room * across / u_scale);
    cover *= roomy;
#ifdef WITH_BLACK
    /* The first set fills what has no room for it; further ones, which need more, are only left out. */
    cover += set < 0.5 ? (1.0 - roomy) * FILLED * (strokes_are_light() ? step(1.0 - dark, u_black) : step(u_black, dark)) : 0.0;
    most = strokes_are_light() ? most : min(most, room * across);
#endif
#endif
    cover *= smoothstep(u_least / (1.0 + 5.0 * u_fade), u_least, cover);
    cover *= mix(smoothstep(GRAZING, 3.0 * GRAZING, abs(m.facing)), 1.0, smoothstep(BLACK, 1.0, dark));
    return 0.5 * min(strip * cover, most) * tip_at(to_end * across / u_scale, cover);
}

/* Where the hand puts an end: beside the line, by so many distances; marks/marks_page.c. */
vec3 strayed(vec3 eye, vec3 model_normal, vec3 along, float shift)
{
    mark_position m;
    m.eye = eye;
    m.normal = normalize(u_normal_matrix * model_normal);
    m.facing = 1.0;
    vec3 direction = normalize(along + vec3(1e-30));
    float plain = u_perspective > 0.5 ? u_focal / max(-eye.z, 1e-20) : u_focal; /* at a grazing angle less than distances on the page */
    float by = u_stray * shift * u_scale / max(max(across_on_page(m, direction), 0.5 * plain), 1e-20);
    vec3 aside = cross(m.normal, direction);
    return eye + aside * (by / max(length(aside), 1e-20));
}

bool clip_near(inout vec3 a, inout vec3 b)
{
    float from = -a.z - u_near_plane, to = -b.z - u_near_plane;
    if (from <= 0.0 && to <= 0.0)
        return false;
    float fraction = from / (from - to);
    if (from < 0.0)
        a = mix(a, b, fraction);
    else if (to < 0.0)
        b = mix(a, b, fraction);
    return true;
}

/* Does it turn away where what is seen there does not? Then it is on the far side. */
bool is_back(mark_position m)
{
    vec2 at = page_of(u_projection * vec4(m.eye, 1.0));
    return m.far || m.facing < 0.0 && dot(texelFetch(t_normal_depth, ivec2(clamp(at, vec2(0.0), u_size - 1.0)), 0).xyz, towards_viewer(m.eye)) > 0.0;
}

void put_corner(mark_position m, vec3 from, vec3 to, bool at_end)
{
    float half_width = half_width_at(m, normalize(to - from + vec3(1e-30)), at_end ? a_to_normal.w : a_from_normal.w, at_end ? a_along.y : a_along.x, at_end);
#ifdef WITH_STRAY
    vec3 before = from;
    from = strayed(from, a_from_normal.xyz, to - before, signed_of_end(a_group.y, false));
    to = strayed(to, a_to_normal.xyz, to - before, signed_of_end(a_group.y, true));
#endif
    if (u_perspective > 0.5 && !clip_near(from, to))
        return;
    vec2 a = page_of(u_projection * vec4(from, 1.0)), b = page_of(u_projection * vec4(to, 1.0));
    float size = length(b - a);
    vec2 direction = size > 1e-4 ? (b - a) / size : vec2(1.0, 0.0), aside = vec2(-direction.y, direction.x);
    float sag = u_sag * u_focal / (u_perspective > 0.5 ? max(-m.eye.z, 1e-20) : 1.0);
    float tolerance = max(0.75, 0.5 + sag) + max(0.5, sag) * steepness(m);
    v_normal = m.facing < 0.0 ? -m.normal : m.normal;
    v_ends = vec4(a, b);
    v_depths = vec4(u_perspective > 0.5 ? -1.0 / from.z : -from.z, u_perspective > 0.5 ? -1.0 / to.z : -to.z, tolerance / u_focal,
                    (to_edge_of(false) > 0.0 ? 0.0 : 1.0) + (to_edge_of(true) > 0.0 ? 0.0 : 2.0));
    v_half_width = half_width;
    vec2 corner = vec2(float(gl_VertexID & 1), float((gl_VertexID >> 1) & 1)) * 2.0 - 1.0;
    float aside_by = half_width > 0.0 ? max(half_width, 0.5) + 0.75 : 0.0; /* of pieces without any width nothing is drawn */
    float past = to_edge_of(at_end) > 0.0 ? 1.0 : max(half_width, 1.0); /* up to the edge, which may lie askew */
    vec2 at = (at_end ? b : a) + direction * (corner.x * past) + aside * (corner.y * aside_by);
    gl_Position = vec4(at / u_size * 2.0 - 1.0, 0.0, 1.0);
}

void main()
{
    gl_Position = NOWHERE;
    bool at_end = (gl_VertexID & 1) == 1;
    mark_position m = position_of_mark(at_end ? a_to.xyz : a_from.xyz, at_end ? a_to_normal.xyz : a_from_normal.xyz);
    vec3 from = (u_model_view * vec4(a_from.xyz, 1.0)).xyz, to = (u_model_view * vec4(a_to.xyz, 1.0)).xyz;
    /* Both ends come to the same decision: by the piece's beginning. */
    mark_position first = position_of_mark(a_from.xyz, a_from_normal.xyz);
    int wanted = is_back(first) ? 0 : 1;
    for (int once = 0; once < wanted; once++)
        put_corner(m, from, to, at_end);
}
