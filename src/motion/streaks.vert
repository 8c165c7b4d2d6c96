/* A stroke: a strip along the way that the surface at the seed has come, built on the page. Großmann 2011, sections 6.2 to 6.4, without its dead directions and its widths
 * that drift with depth: lengths and widths are pixels, whatever the projection. */

#ifdef INTO_SHADOW
uniform mat4 u_shadow_from_eye;
#endif
layout(location = 0) in vec4 a_seed; /* position on the page, pixels; a third coordinate; number */
out vec2 v_stroke;           /* pixels from the head on, and from the axis */
out vec2 v_direction;        /* on the page, towards the head */
flat out vec3 v_shape;       /* length, half the width at the head, opacity */
flat out vec4 v_colour;      /* straight alpha */

#if PATH == 0
const int STEPS = 1, SEGMENTS = 1;
#elif PATH == 1
const int STEPS = 2, SEGMENTS = 5;
#else
const int STEPS = 4, SEGMENTS = 16;
#endif

vec3 places[STEPS + 1]; /* page position and window depth, now and at the steps of the past */

/* Beyond the border a seed reads the border's pixel and stands where it is: so strokes are as dense there as inside, with any frustum. */
void find_places(ivec2 pixel)
{
    vec4 past = texelFetch(t_velocity, pixel, 0);
    places[0] = vec3(a_seed.xy, texelFetch(t_depth, pixel, 0).r);
    places[STEPS] = vec3(a_seed.xy - past.xy, past.z);
#if PATH == 1
    past = texelFetch(t_past_1, pixel, 0);
    places[1] = vec3(a_seed.xy - past.xy, past.z);
#elif PATH == 2
    past = texelFetch(t_past_1, pixel, 0);
    places[1] = vec3(a_seed.xy - past.xy, past.z);
    past = texelFetch(t_past_2, pixel, 0);
    places[2] = vec3(a_seed.xy - past.xy, past.z);
    past = texelFetch(t_past_3, pixel, 0);
    places[3] = vec3(a_seed.xy - past.xy, past.z);
#endif
}

/* Where it was, t from 0 (now) to 1. Three positions make a parabola; five a curve after Catmull and Rom (1974), whose ends go on as parabolas. */
vec3 place_at(float t)
{
#if PATH == 0
    return mix(places[0], places[1], t);
#elif PATH == 1
    return places[0] * ((2.0 * t - 1.0) * (t - 1.0)) + places[1] * (4.0 * t * (1.0 - t)) + places[2] * (t * (2.0 * t - 1.0));
#else
    float x = t * 4.0;
    int i = clamp(int(x), 0, 3);
    x -= float(i);
    vec3 p1 = places[i], p2 = places[i + 1];
    vec3 p0 = i > 0 ? places[max(i - 1, 0)] : 3.0 * p1 - 3.0 * p2 + places[2];
    vec3 p3 = i < 3 ? places[min(i + 2, 4)] : 3.0 * p2 - 3.0 * p1 + places[2];
    return 0.5 * (2.0 * p1 + x * (p2 - p0 + x * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3 + x * (3.0 * (p1 - p2) + p3 - p0))));
#endif
}

float length_of_path()
{
    float sum = 0.0;
    vec2 last = places[0].xy;
    for (int i = 1; i <= 2 * STEPS; i++) {
        vec2 next = place_at(float(i) / float(2 * STEPS)).xy;
        sum += distance(last, next);
        last = next;
    }
    return sum;
}

/* The object's colour around the seed, so that hatching does not make striped strokes. */
vec4 colour_around(ivec2 pixel, float radius)
{
#if INK == 1
    return u_colour;
#else
#ifdef INTO_SHADOW
    return vec4(1.0); /* the object is not drawn yet */
#else
    vec4 sum = texelFetch(t_mover, pixel, 0);
#ifdef DEPTH_ALONE
    return sum;
#endif
    for (int i = 0; i < 4; i++) {
        vec2 beside = vec2(float(i & 1) - 0.5, float(i >> 1) - 0.5) * radius;
        sum += texelFetch(t_mover, clamp(pixel + ivec2(round(beside)), ivec2(u_around.xy), ivec2(u_around.zw) - 1), 0);
    }
    return sum.a > 0.0 ? vec4(sum.rgb / sum.a, sum.a / 5.0) : vec4(0.0);
#endif
#endif
}

/* Is the seed left out, so that what is farther has as many more strokes as they are smaller? */
bool left_out(float smaller)
{
    float least = u_perspective > 0.5 ? u_depths.x / u_depths.y : 1.0;
    return u_scaled && a_seed.z * smaller * smaller > least * least;
}

float smaller_at(float window)
{
    return u_scaled && u_perspective > 0.5 ? min(u_depths.x / eye_depth_at_window(window), 1.0) : 1.0;
}

/* May a stroke begin here? Großmann 2011, sections 6.4.2 and 9.2.2: validity. */
bool valid_at(ivec2 pixel)
{
    bool valid = true;
#if WHERE != 0
    float ahead = dot(texelFetch(t_normal_depth, pixel, 0).xy, places[0].xy - places[STEPS].xy);
    valid = WHERE == 1 ? ahead < 0.0 : ahead > 0.0;
#endif
#ifdef HAS_MASK
    vec2 mask = textureLod(t_mask, vec3((vec2(pixel) + 0.5) / u_size, 0.0), 0.0).rg;
    valid = valid && mask.x * mask.y > 0.5;
#endif
    return valid;
}

float fading_of(float whole)
{
    return u_full > u_begin ? clamp((whole - u_begin) / (u_full - u_begin), 0.0, 1.0) : float(whole >= u_begin);
}

void main()
{
    ivec2 pixel = clamp(ivec2(floor(a_seed.xy)), ivec2(u_around.xy), ivec2(u_around.zw) - 1);
    bool there = texelFetch(t_velocity, pixel, 0).w > 0.0;
    find_places(pixel);
    float smaller = smaller_at(places[0].z), half_width = 0.5 * u_width * smaller;
    int segment = gl_VertexID >> 1;
    float whole = max(length_of_path(), 1e-3);
    vec4 colour = colour_around(pixel, half_width);
    float opacity = fading_of(whole) * u_opacity * min(colour.a, 1.0);
    float shift = min(max(u_shift_width * half_width, u_shift_length * whole) / whole, 1.0);
    float end = max(1.0 - u_uneven * fract(a_seed.w * 0.61803399), shift);
    /* Where it was between is taken for evenly spaced along the stroke: its ends are exact. */
    float part = float(segment) / float(SEGMENTS), t = mix(shift, end, part), length_left = whole * (end - shift);
    vec2 lengths = length_left * vec2(1.0, part);
    vec3 here = place_at(t);
    vec2 tangent = place_at(max(t - 0.01, 0.0)).xy - place_at(min(t + 0.01, 1.0)).xy;
    tangent = length(tangent) > 1e-5 ? normalize(tangent) : normalize(places[0].xy - places[STEPS].xy + vec2(1e-6, 0.0));
    /* As long as it is wide at least: its caps fill it. */
    float missing = max(2.0 * half_width - lengths.x, 0.0);
    here.xy -= tangent * (missing * part);
    lengths += missing * vec2(1.0, part);
    float side = (gl_VertexID & 1) == 0 ? 1.0 : -1.0;
    float across = side * (half_width * (1.0 - u_taper * lengths.y / max(lengths.x, 1e-6)) + 0.5);
    here.xy += across * vec2(-tangent.y, tangent.x);
    /* A little nearer: along flat sides strokes lie in the very surface. */
    float nearer = window_depth_at_eye(max(eye_depth_at_window(clamp(here.z, 0.0, 1.0)) - 0.002 * (u_far - u_near), 1e-6));
#ifdef INTO_SHADOW
    float eye_depth = eye_depth_at_window(clamp(here.z, 0.0, 1.0));
    vec2 across_page = (2.0 * here.xy / u_size - 1.0) * u_unproject;
    vec3 in_shadow = (u_shadow_from_eye * vec4(across_page * (u_perspective > 0.5 ? eye_depth : 1.0), -eye_depth, 1.0)).xyz;
    /* A little behind: strokes throw none on the surface that they lie on. */
    vec4 position = vec4(2.0 * in_shadow + vec3(-1.0, -1.0, -0.98), 1.0);
#else
    vec4 position = vec4(2.0 * here.xy / u_size - 1.0, 2.0 * clamp(nearer, 0.0, 1.0) - 1.0, 1.0);
#endif
    bool drawn = there && valid_at(pixel) && opacity >= 0.001 && whole > 0.01 && !left_out(smaller);
    gl_Position = drawn ? position : vec4(2.0, 2.0, 2.0, 1.0);
    v_stroke = vec2(lengths.y, across);
    v_direction = tangent;
    v_shape = vec3(lengths.x, half_width, opacity);
    v_colour = vec4(colour.rgb, 1.0);
}
