/* Strokes: each piece is a record four times, a corner each, drawn as a quad of the same width wherever it is (EX-12). A stroke's tone is decided at its middle, so that it is drawn whole. */
#include "surface/marks.glsl"

#if LAYOUT == 0
layout(location = 0) in vec4 a_from;   /* light priority */
layout(location = 1) in vec4 a_to;     /* perspective priority */
layout(location = 2) in vec4 a_middle; /* brightness of the model there */
layout(location = 3) in vec4 a_normal; /* at the middle; density: length of strokes to a unit of area */
layout(location = 4) in vec4 a_along;  /* where the piece begins and ends, fractions of the stroke; its direction at its middle, packed (stage/mark_sets.c); of layers of priorities, 0: none */
#else
/* The same in 64 bytes (EX-29). */
layout(location = 0) in vec3 a_begins;
layout(location = 1) in vec3 a_ends;
layout(location = 2) in vec3 a_centre;
layout(location = 3) in vec2 a_numbers;  /* light priority, density */
layout(location = 4) in vec4 a_shares;   /* perspective priority, where the piece begins and ends, brightness */
layout(location = 5) in vec4 a_turns;    /* normal and direction, as octahedra */
layout(location = 6) in vec2 a_fractions; /* of layers; a quarter of how much longer than 1 the normal is */

vec4 a_from, a_to, a_middle, a_normal, a_along;
#endif

uniform float u_near_plane;

/* How far strokes of one set are from being side by side, to being strewn at random. */
#if PLACED == 0
const float CROWDED = 0.0;
#elif PLACED == 3
const float CROWDED = 1.0;
#else
const float CROWDED = 0.24;
#endif

flat out vec3 v_normal; /* of its surface, towards the viewer */
flat out vec4 v_ends;   /* of the piece, pixels */
flat out vec4 v_depths; /* 1 / depth of both ends (or depth), tolerance as fraction of the depth (or as depth), half the width in pixels */
flat out vec3 v_run;    /* where both ends are, fractions of the stroke; 1 / fraction over which an end runs out, 0: it does not */
flat out float v_ink;   /* opacity of what is thinner than a pixel */

/* The piece's part in front of the eye, in clip space. */
bool clip_near(inout vec3 a, inout vec3 b, inout vec2 arcs)
{
    float from = -a.z - u_near_plane, to = -b.z - u_near_plane;
    if (from <= 0.0 && to <= 0.0)
        return false;
    float fraction = from / (from - to);
    if (from < 0.0) {
        a = mix(a, b, fraction);
        arcs.x = mix(arcs.x, arcs.y, fraction);
    } else if (to < 0.0) {
        b = mix(a, b, fraction);
        arcs.y = mix(arcs.x, arcs.y, fraction);
    }
    return true;
}

/* From its place on an octahedron, −1 … 1. */
vec3 unfolded(vec2 at)
{
    float z = 1.0 - abs(at.x) - abs(at.y), under = max(-z, 0.0);
    return normalize(vec3(at.x + (at.x < 0.0 ? under : -under), at.y + (at.y < 0.0 ? under : -under), z));
}

#if LAYOUT == 0
vec3 direction_in_middle()
{
    const float MOST = 2047.0;
    float y = floor(a_along.z / 4096.0);
    return unfolded((vec2(a_along.z - 4096.0 * y, y) - MOST) / MOST);
}
#else
vec3 direction_in_middle()
{
    return unfolded(a_turns.zw);
}

void unpack()
{
    a_from = vec4(a_begins, a_numbers.x);
    a_to = vec4(a_ends, a_shares.x);
    a_middle = vec4(a_centre, a_shares.w);
    a_normal = vec4(unfolded(a_turns.xy) * (1.0 + 4.0 * a_fractions.y), a_numbers.y);
    a_along = vec4(a_shares.yz, 0.0, a_fractions.x);
}
#endif

/* Native lines are no wider than a pixel (EX-11). */
float full_width()
{
#if PRIMITIVE == 1
    return min(u_width, 1.0);
#else
    return u_width;
#endif
}

/* Fraction of the strokes that shall be there for where they are: marks/marks_law.c. */
float fraction_there(mark_position m, vec3 direction, float d)
{
#if LAW == 0
    return d * (u_perspective > 0.5 ? abs(dot(m.eye, m.normal)) / dot(m.eye, m.eye) : abs(m.normal.z));
#else
    float depth = u_perspective > 0.5 ? max(-m.eye.z, 1e-20) : 1.0;
    float area = u_perspective > 0.5 ? abs(dot(m.eye, m.normal)) / (depth * depth * depth) : abs(m.normal.z);
    vec2 seen = u_perspective > 0.5 ? direction.xy + m.eye.xy * (direction.z / depth) : direction.xy;
    return d * area * depth / max(length(seen), 0.02);
#endif
}

/* Fraction of its width that the stroke has; `fraction`: of strokes that shall be there for where they are. */
float ink_of_stroke(mark_position m, float fraction)
{
    float darkest = full_width() * (1.0 - u_taper) / u_scale, darkness = darkness_at(m, a_middle.w);
    bool equalised = u_equalised || a_along.w > 0.0;
    float light_fraction = clamp(equalised ? ink_of_strokes(darkness, darkest, a_along.w, CROWDED) / darkest : darkness, 0.0, 1.0);
    if (a_along.w > 0.0)
        return ink_of_rank(1.0 - a_to.w, clamp((a_from.w - 1.0 + light_fraction) / a_along.w, 0.0, 1.0) * fraction, 1.0, u_fade);
    float lack = max((1.0 - light_fraction) * (1.0 + u_fade) - a_from.w, (1.0 - clamp(fraction, 0.0, 1.0)) * (1.0 + u_fade) - a_to.w);
    return clamp(1.0 - lack / u_fade, 0.0, 1.0);
}

/* Where it is in depth, −1 … 1: before its own surface. */
float depth_before(vec3 eye, float tolerance)
{
    vec4 clip = u_projection * vec4(u_perspective > 0.5 ? eye * (1.0 - tolerance / u_focal) : eye + vec3(0.0, 0.0, tolerance / u_focal), 1.0);
    return clamp(clip.z / clip.w, -1.0, 1.0);
}

/* Does the stroke turn away where what is seen at its middle does not? Then it is on the far side. */
bool is_back(mark_position m)
{
    vec2 at = page_of(u_projection * vec4(m.eye, 1.0));
    return m.far || m.facing < 0.0 && dot(texelFetch(t_normal_depth, ivec2(clamp(at, vec2(0.0), u_size - 1.0)), 0).xyz, towards_viewer(m.eye)) > 0.0;
}

/* A corner of a piece that has so much ink. What has none is left out in one of the ways that hardware without a way to say so offers (EX-13): by default its corners lie outside of all that is drawn. */
void put_corner(mark_position m, vec3 from, vec3 to, float ink)
{
    vec2 arcs = a_along.xy;
    bool gone = ink <= 0.0;
    if ((HIDING == 0 && gone) || (u_perspective > 0.5 && !clip_near(from, to, arcs)))
        return;
    vec2 a = page_of(u_projection * vec4(from, 1.0)), b = page_of(u_projection * vec4(to, 1.0));
    float size = length(b - a), width = full_width() * (gone ? 1.0 : ink), half_width = 0.5 * max(width, 1.0);
    vec2 direction = size > 1e-4 ? (b - a) / size : vec2(1.0, 0.0), aside = vec2(-direction.y, direction.x);
    float tolerance = 1.5 + 1.5 * steepness(m);
    v_normal = m.facing < 0.0 ? -m.normal : m.normal;
    v_ends = vec4(a, b);
    v_depths = u_perspective > 0.5 ? vec4(-1.0 / from.z, -1.0 / to.z, tolerance / u_focal, half_width) : vec4(-from.z, -to.z, tolerance / u_focal, half_width);
    v_run = vec3(arcs, u_taper > 0.0 ? 1.0 / u_taper : 0.0);
    v_ink = !gone || HIDING < 4 ? min(width, 1.0) : HIDING == 4 ? -1.0 : 0.0;
    vec2 corner = vec2(float(gl_VertexID & 1), float((gl_VertexID >> 1) & 1)) * 2.0 - 1.0;
    float around = half_width + 0.5, depth = 0.0;
#if PLACED == 3
    depth = depth_before(corner.x > 0.0 ? to : from, tolerance);
#endif
#if HIDING == 1
    corner.y = gone ? -corner.y : corner.y;
#elif HIDING == 2
    around = gone ? 0.0 : around;
#elif HIDING == 3
    depth = gone ? 1.0 : depth;
#endif
#if PRIMITIVE == 1
    vec2 at = corner.x > 0.0 ? b : a;
#else
    vec2 at = mix(a, b, 0.5 + 0.5 * corner.x) + (direction * corner.x + aside * corner.y) * around;
#endif
    gl_Position = vec4(at / u_size * 2.0 - 1.0, depth, 1.0);
}

void main()
{
    gl_Position = NOWHERE;
#if LAYOUT > 0
    unpack();
#endif
    mark_position m = position_of_mark(a_middle.xyz, a_normal.xyz);
    vec3 from = (u_model_view * vec4(a_from.xyz, 1.0)).xyz, to = (u_model_view * vec4(a_to.xyz, 1.0)).xyz;
    vec3 direction = normalize(mat3(u_model_view) * direction_in_middle());
    float fraction = fraction_there(m, direction, u_focal / max(a_normal.w * u_scale, 1e-20));
    /* Most are too many wherever they are, whatever the light. Software drivers skip loops that nobody enters, but not branches. */
#if PLACED == 3
    int wanted = 1.0 - a_to.w <= fraction * (1.0 + u_fade) ? 1 : 0; /* what grows on the far side may look over it */
#else
    int wanted = 1.0 - a_to.w <= fraction * (1.0 + u_fade) && !is_back(m) ? 1 : 0;
#endif
    float ink = 0.0;
    for (int once = 0; once < wanted; once++)
        ink = ink_of_stroke(m, fraction);
    int placed = HIDING > 0 || ink > 0.0 ? 1 : 0;
    for (int once = 0; once < placed; once++)
        put_corner(m, from, to, ink);
}
