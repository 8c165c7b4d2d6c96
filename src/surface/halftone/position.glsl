/* Where strokes lie: plane coordinates on the surface with their rates of change in the picture. They are worked out from normal and depth alone, so that surfaces
 * may be shaded with their geometry or later, with the same result. */
#include "light/light.glsl"

/* A position is measured where the part is when nothing has moved, so that strokes go with it. */
#ifdef SHADED_LATER
#include "surface/halftone/part_frame.glsl"
#else
mat3 turn_to_rest()
{
    return transpose(mat3(u_rest[0].xyz, u_rest[1].xyz, u_rest[2].xyz));
}
#endif

/* From directions in eye space to those at rest. Of what is deformed they belong to the pixel. */
mat3 s_to_rest;

#if defined(HAS_REST) || defined(HAS_REST_POSITION)
#define DEFORMED
/* The linear map of a surface that takes two steps along it to two others, and its normal to the other's. */
mat3 map_of_steps(vec3 right, vec3 up, vec3 rest_right, vec3 rest_up, mat3 otherwise)
{
    float size = max(length(right), length(up));
    vec3 across = cross(right, up), rest_across = cross(rest_right, rest_up);
    if (!(length(across) > 1e-5 * size * size) || !(length(rest_across) > 0.0))
        return otherwise;
    return mat3(rest_right / size, rest_up / size, normalize(rest_across)) * inverse(mat3(right / size, up / size, normalize(across)));
}
#endif

/* One way of laying a plane on a surface. A position may have several; their weights add up to 1. */
struct stroke_plane {
    vec2  at;      /* coordinates, x along strokes */
    vec2  right;   /* how they change from this pixel to the next one to the right, */
    vec2  up;      /* and to the one above */
    float weight;
    uint  key;     /* tells planes apart */
};

/* A position and its rates in a part's frame. */
struct rest_position {
    vec3 at, right, up;
    vec3 normal;
    vec3 upward; /* which way is up */
    float direction;   /* of strokes on the page, half turns 0 … 1; where coordinates ask for it */
};

/* Below this cosine between view and surface, rates are those of a surface that is seen at it: rims do not fill with detail. */
const float STEEPEST = 0.2;

/* The tangent plane's point moves by this much in eye space when the ray moves by a pixel in one direction (x or y of `pixel`). */
vec3 rate_of(vec3 eye, vec3 normal, vec3 pixel)
{
    vec3 ray = u_perspective > 0.5 ? eye / -eye.z : vec3(0.0, 0.0, -1.0);
    float facing = dot(normal, ray);
    float least = STEEPEST * length(ray);
    facing = facing > 0.0 ? max(facing, least) : min(facing, -least);
    vec3 moved = pixel * (u_perspective > 0.5 ? -eye.z : 1.0);
    return moved - ray * (dot(normal, moved) / facing);
}

#if (COORDINATES == 6 && defined(HAS_FIELD)) || (COORDINATES == 7 && defined(HAS_DIRECTION))
#define HAS_FORM
#include "surface/halftone/form.glsl"
vec2 direction_on_page(surface_point p, vec3 rest_normal)
{
#if COORDINATES == 7
    return textureLod(t_direction, ((gl_FragCoord.xy - float(DIRECTION_APART / 2) - 0.5) / float(DIRECTION_APART) + 0.5) / vec2(textureSize(t_direction, 0)), 0.0).xy;
#else
    mat3 field = mat3(v_field_diagonal.x, v_field_sides.x, v_field_sides.z, v_field_sides.x, v_field_diagonal.y, v_field_sides.y,
                      v_field_sides.z, v_field_sides.y, v_field_diagonal.z);
    mat3 frame = frame_around(p.normal);
    vec3 turned = field * frame[0];
    vec2 doubled = vec2(dot(frame[0], turned), dot(frame[1], turned));
    float sure = length(doubled);
    vec2 plain = on_page(p.eye, inverse(s_to_rest) * plain_tangent(rest_normal, u_upward, u_level));
    return sure > 0.0 ? on_page(p.eye, tangent_of(doubled / sure, frame)) * sure + plain * (0.03 * (1.0 - smoothstep(0.0, 0.08, sure))) : plain;
#endif
}

/* θ in units of π, 0 … 1, of a double angle; within 0.00001 (Abramowitz and Stegun 4.4.49). */
float half_turns(vec2 doubled)
{
    vec2 size = abs(doubled);
    float low = min(size.x, size.y) / max(max(size.x, size.y), 1e-20), square = low * low;
    float angle = low * (0.15913362 + square * (-0.05256880 + square * (0.02867033 + square * (-0.01354934 + square * 0.00331601))));
    angle = size.y > size.x ? 0.25 - angle : angle;
    angle = doubled.x < 0.0 ? 0.5 - angle : angle;
    return doubled.y < 0.0 ? 1.0 - angle : angle;
}

#endif

/* The directions of strokes on the page, where it matters. */
float direction_of(surface_point p, vec3 rest_normal)
{
#ifdef HAS_FORM
    return half_turns(direction_on_page(p, rest_normal));
#else
    return 0.0;
#endif
}

#ifdef HAS_REST
/* Sets the position and the map of directions to those of a deformed surface at rest; returns its normal there. */
vec3 deformed_at_rest(surface_point p, inout vec3 at, vec3 normal)
{
    at = v_rest;
    s_to_rest = map_of_steps(dFdx(p.eye), dFdy(p.eye), dFdx(v_rest), dFdy(v_rest), s_to_rest);
    return normalize(p.normal * inverse(s_to_rest));
}
#elif defined(HAS_REST_POSITION)
/* A step along the surface to the nearer of two pixels beside, where it is the same part's: eye, and at rest. */
void step_along(ivec2 pixel, ivec2 aside, float depth, uint part, vec3 eye, vec3 rest, out vec3 moved, out vec3 rest_moved)
{
    moved = rest_moved = vec3(0.0);
    float nearest = 1e30;
    for (int side = -1; side <= 1; side += 2) {
        ivec2 beside = clamp(pixel + side * aside, ivec2(0), textureSize(t_normal_depth, 0) - 1);
        float own = texelFetch(t_normal_depth, beside, 0).w, apart = abs(own - depth);
        if (texelFetch(t_id, beside, 0).r != part || apart >= nearest || beside == pixel)
            continue;
        nearest = apart;
        vec2 ndc = (2.0 * (vec2(beside) + 0.5) / u_size - 1.0) * u_unproject;
        moved = float(side) * (vec3(ndc * (u_perspective > 0.5 ? own : 1.0), -own) - eye);
        rest_moved = float(side) * (texelFetch(t_rest_position, beside, 0).xyz - rest);
    }
}

vec3 deformed_at_rest(surface_point p, inout vec3 at, vec3 normal)
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 rest = texelFetch(t_rest_position, pixel, 0);
    if (!(rest.w > 0.0))
        return normal;
    at = rest.xyz;
    vec3 right, up, rest_right, rest_up;
    step_along(pixel, ivec2(1, 0), -p.eye.z, p.part, p.eye, at, right, rest_right);
    step_along(pixel, ivec2(0, 1), -p.eye.z, p.part, p.eye, at, up, rest_up);
    s_to_rest = map_of_steps(right, up, rest_right, rest_up, s_to_rest);
    return normalize(p.normal * inverse(s_to_rest));
}
#endif

rest_position position_at_rest(surface_point p)
{
    vec2 pixel = 2.0 * u_unproject / u_size;
    vec3 right = rate_of(p.eye, p.normal, vec3(pixel.x, 0.0, 0.0)), up = rate_of(p.eye, p.normal, vec3(0.0, pixel.y, 0.0));
#ifdef SHADED_LATER
    part_frame part = frame_of_part(p.part);
    vec3 at = part.turn * (mat3(u_world_from_eye) * p.eye + u_world_from_eye[3].xyz) + part.shift, upward = part.upward;
    s_to_rest = part.turn * mat3(u_world_from_eye);
#else
    vec3 at = turn_to_rest() * p.eye + vec3(u_rest[0].w, u_rest[1].w, u_rest[2].w), upward = u_upward;
    s_to_rest = turn_to_rest();
#endif
    vec3 normal = s_to_rest * p.normal;
#ifdef DEFORMED
    normal = deformed_at_rest(p, at, normal);
#endif
    return rest_position(at, s_to_rest * right, s_to_rest * up, normal, upward, direction_of(p, normal));
}

stroke_plane plane_along(rest_position r, vec3 along, vec3 across, float weight, uint key)
{
    return stroke_plane(vec2(dot(r.at, along), dot(r.at, across)), vec2(dot(r.right, along), dot(r.right, across)),
                        vec2(dot(r.up, along), dot(r.up, across)), weight, key);
}

/* How dark strokes of one plane must be, so that those of all planes, which lie over each other, are as dark as wanted. */
float darkness_of_fraction(float darkness, float fraction)
{
    return fraction > 0.9999 ? darkness : 1.0 - pow(max(1.0 - darkness, 1e-4), fraction);
}

/* Both angles, as cosine and sine. */
vec2 turns_added(vec2 a, vec2 b)
{
    return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

/* Printers' angles: 0 degrees, 15, 75 and 45. None is another's, nor that turned by a right angle, since rows of dots would lie on each other. */
vec2 turn_of_ink(int ink)
{
    return ink == 0 ? vec2(1.0, 0.0) : ink == 1 ? vec2(0.9659258, 0.2588190) : ink == 2 ? vec2(0.2588190, 0.9659258) : vec2(0.7071068, 0.7071068);
}

/* Coordinates turned by an angle, as cosine and sine. */
stroke_plane turned_plane(stroke_plane s, vec2 angle)
{
    mat2 turn = mat2(angle.x, -angle.y, angle.y, angle.x);
    return stroke_plane(turn * s.at, turn * s.right, turn * s.up, s.weight, s.key);
}

/* Each of what follows lays planes on a position, PLANES at most and planes_at there; plane_of gives one of them, turned by an angle (cosine and sine). */
#if COORDINATES == 0 || (COORDINATES == 4 && !defined(HAS_FIELD))
/* Strokes are where planes through the model cut its surface: they run on over everything without seams. A turn turns these planes in space, about an axis of their
 * own, so that strokes turn by about as much. Around the two places where the surface is a plane's own, another set of planes takes over. */
#define PLANES 2
const mat3 ASKEW = mat3(0.8138, 0.2962, -0.5, 0.0443, 0.8252, 0.5630, 0.5794, -0.4803, 0.6582);

/* Fraction of the planes of this axis; the rest is left to the other ones. */
float fraction_of_axis(rest_position r, vec3 axis)
{
    float facing = dot(r.normal, axis);
    return smoothstep(0.06, 0.3, 1.0 - facing * facing);
}

vec3 turned_axis(vec2 turn)
{
    return ASKEW[0] * turn.x + ASKEW[1] * turn.y;
}

int planes_at(rest_position r, vec2 turn)
{
    return fraction_of_axis(r, turned_axis(turn)) < 1.0 ? 2 : 1;
}

stroke_plane plane_of(surface_point p, rest_position r, int i, vec2 turn)
{
    vec3 first = turned_axis(turn), aside = ASKEW[1] * turn.x - ASKEW[0] * turn.y;
    float own = fraction_of_axis(r, first);
    return i == 0 ? plane_along(r, abs(dot(aside, r.normal)) < abs(dot(ASKEW[2], r.normal)) ? aside : ASKEW[2], first, own, 0u)
                  : plane_along(r, first, ASKEW[2], 1.0 - own, 1u);
}
#elif COORDINATES == 1 || (COORDINATES == 3 && !defined(HAS_UV)) || (COORDINATES == 5 && !defined(HAS_PATCHES)) || (COORDINATES > 5 && !defined(HAS_FORM))
/* Walls have their second coordinate upwards. Of the three planes the one with the least fraction is always left out, and what it had is taken off the others, so that two
 * are enough everywhere. */
#define PLANES 2
vec3 fractions_of_axes(rest_position r, vec3 right, vec3 back)
{
    vec3 fraction = abs(vec3(dot(r.normal, right), dot(r.normal, back), dot(r.normal, r.upward)));
    fraction *= fraction;
    fraction *= fraction;
    fraction *= fraction;
    fraction -= min(fraction.x, min(fraction.y, fraction.z));
    return fraction / (fraction.x + fraction.y + fraction.z + 1e-20);
}

stroke_plane plane_of(surface_point p, rest_position r, int i, vec2 turn)
{
    vec3 right = abs(r.upward.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    right = normalize(right - r.upward * dot(right, r.upward));
    vec3 back = cross(r.upward, right), fraction = fractions_of_axes(r, right, back);
    int most = fraction.x >= fraction.y && fraction.x >= fraction.z ? 0 : fraction.y >= fraction.z ? 1 : 2;
    /* The other one that has any. */
    int next = most == 0 ? (fraction.y > 0.0 ? 1 : 2) : most == 1 ? (fraction.x > 0.0 ? 0 : 2) : fraction.x > 0.0 ? 0 : 1;
    int which = i == 0 ? most : next;
    return turned_plane(plane_along(r, which == 0 ? back : right, which == 2 ? back : r.upward, which == 0 ? fraction.x : which == 1 ? fraction.y : fraction.z, uint(which)), turn);
}

int planes_at(rest_position r, vec2 turn)
{
    return plane_of(surface_point(vec3(0.0), vec3(0.0), vec3(0.0), vec4(0.0), false, 0u), r, 0, turn).weight < 1.0 ? 2 : 1;
}
#elif COORDINATES == 3
#define PLANES 1
int planes_at(rest_position r, vec2 turn)
{
    return 1;
}

/* Models count downwards from the top of a picture, strokes upwards. */
stroke_plane plane_of(surface_point p, rest_position r, int i, vec2 turn)
{
    const vec2 UPWARDS = vec2(1.0, -1.0);
    return turned_plane(stroke_plane(vec2(s_uv.x, -s_uv.y), dFdx(s_uv) * UPWARDS, dFdy(s_uv) * UPWARDS, 1.0, 0u), turn);
}
#elif COORDINATES == 4
/* Planes through the model of a few fixed directions; each position takes those two whose lines come nearest to the direction in which its surface bends. So strokes lie in
 * patches of parallel ones, which overlap where the direction changes, as a draughtsman sets them. */
#define PLANES 2
const int DIRECTIONS = 13;
const vec3 DIRECTION[DIRECTIONS] = vec3[DIRECTIONS](vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0),
    vec3(0.7071, 0.7071, 0.0), vec3(0.7071, -0.7071, 0.0), vec3(0.0, 0.7071, 0.7071), vec3(0.0, 0.7071, -0.7071), vec3(0.7071, 0.0, 0.7071), vec3(-0.7071, 0.0, 0.7071),
    vec3(0.5774, 0.5774, 0.5774), vec3(0.5774, 0.5774, -0.5774), vec3(0.5774, -0.5774, 0.5774), vec3(-0.5774, 0.5774, 0.5774));

int planes_at(rest_position r, vec2 turn)
{
    return 2;
}

/* Coordinates along and across the lines of a direction. */
stroke_plane plane_of_direction(rest_position r, int direction, float weight)
{
    vec3 across = DIRECTION[direction], line = cross(r.normal, across);
    vec3 aside = normalize(abs(across.x) < 0.9 ? cross(across, vec3(1.0, 0.0, 0.0)) : cross(across, vec3(0.0, 1.0, 0.0))), other = cross(across, aside);
    return plane_along(r, abs(dot(aside, line)) > abs(dot(other, line)) ? aside : other, across, weight, uint(direction));
}

stroke_plane plane_of(surface_point p, rest_position r, int i, vec2 turn)
{
    mat3 field = mat3(v_field_diagonal.x, v_field_sides.x, v_field_sides.z, v_field_sides.x, v_field_diagonal.y, v_field_sides.y,
                      v_field_sides.z, v_field_sides.y, v_field_diagonal.z);
    mat3 rest = s_to_rest;
    field = rest * field * transpose(rest);
    float best = -1e9, next = -1e9;
    int direction = 0, second = 0;
    for (int k = 0; k < DIRECTIONS; k++) {
        vec3 line = cross(r.normal, DIRECTION[k]);
        float square = dot(line, line);
        /* Where nothing bends the way is the first one that is not too flat. */
        float fits = dot(line, field * line) / max(square, 1e-6) + 0.2 * min(square, 0.5) - 0.004 * float(k);
        bool first = fits > best, other = !first && fits > next;
        next = first ? best : other ? fits : next;
        second = first ? direction : other ? k : second;
        best = first ? fits : best;
        direction = first ? k : direction;
    }
    float own = 0.5 + 0.5 * smoothstep(0.0, 0.15, best - next);
    return turned_plane(plane_of_direction(r, i == 0 ? direction : second, i == 0 ? own : 1.0 - own), turn);
}
#elif COORDINATES == 5
#define PLANES 1
int planes_at(rest_position r, vec2 turn)
{
    return 1;
}

stroke_plane plane_of(surface_point p, rest_position r, int i, vec2 turn)
{
    return turned_plane(stroke_plane(v_patch.xy, dFdx(v_patch.xy), dFdy(v_patch.xy), 1.0, uint(v_patch.w + 0.5)), turn);
}
#elif defined(HAS_FORM)
/* Straight strokes on the page, in patches: a few directions on the page, each position has the two that come nearest to the direction in which its surface bends. They move with the middle of
 * the model. Müller, section 4.4 (after Kim 2008), whose weights are interchanged; rows P23, P24. */
#define PLANES 2
float s_between = 0.0; /* directions are turned by this fraction of the angle between two; repetitions differ in it */

int planes_at(rest_position r, vec2 turn)
{
    return 2;
}

stroke_plane plane_of(surface_point p, rest_position r, int i, vec2 turn)
{
    float position = r.direction * float(DIRECTIONS_ON_PAGE) - s_between, low = floor(position), fraction = smoothstep(0.3, 0.7, position - low);
    float direction = low + float(i);
    direction = direction < 0.0 ? direction + float(DIRECTIONS_ON_PAGE) : direction >= float(DIRECTIONS_ON_PAGE) ? direction - float(DIRECTIONS_ON_PAGE) : direction;
    float angle = (direction + s_between) * (3.14159265 / float(DIRECTIONS_ON_PAGE));
    float rate = 1.0 / page_unit();
    stroke_plane s = stroke_plane((gl_FragCoord.xy - u_anchor) * rate, vec2(rate, 0.0), vec2(0.0, rate), i == 0 ? 1.0 - fraction : fraction, uint(int(direction)));
    return turned_plane(s, turns_added(vec2(cos(angle), sin(angle)), turn));
}
#else
#define PLANES 1
int planes_at(rest_position r, vec2 turn)
{
    return 1;
}

stroke_plane plane_of(surface_point p, rest_position r, int i, vec2 turn)
{
    float rate = 1.0 / page_unit();
    return turned_plane(stroke_plane(gl_FragCoord.xy * rate, vec2(rate, 0.0), vec2(0.0, rate), 1.0, 0u), turn);
}
#endif
