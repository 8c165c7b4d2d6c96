/* Dots: points, one vertex each, or where they are too large for that, quads: each record four times. Whether a dot is hidden is asked once, at its middle, so that its own surface cuts nothing off it (EX-14). */
#include "surface/marks.glsl"

layout(location = 0) in vec4 a_place;  /* priority */
layout(location = 1) in vec4 a_normal; /* brightness of the model there */

uniform float u_density; /* dots to a unit of area */

flat out vec4 v_dot;  /* radius in pixels, opacity, nearest and farthest depth of what it may lie on */
flat out vec2 v_at;   /* its middle, pixels */

/* Is the surface that is seen in the dot's pixel the dot's own? */
bool is_seen(mark_place m, vec2 at, float reach)
{
    vec4 seen = texelFetch(t_normal_depth, ivec2(clamp(at, vec2(0.0), u_size - 1.0)), 0);
    return abs(seen.w + m.eye.z) <= reach && dot(seen.xyz, m.normal) > 0.3;
}

void main()
{
    mark_place m = place_of_mark(a_place.xyz, a_normal.xyz);
    vec4 clip = u_projection * vec4(m.eye, 1.0);
    vec2 at = page_of(clip);
    float pixel = pixel_at(m.eye), steep = steepness(m);
    float there = u_density / max(page_area(m), 1e-20); /* dots to a pixel */
    float needed = ink_of_cover(darkness_at(m, a_normal.w)) / (0.78539816 * u_diameter * u_diameter);
    float ink = ink_of_rank(1.0 - a_place.w, needed / there, u_grow * u_grow);
    bool near = clip.w > 0.0 && all(greaterThan(at, vec2(-64.0))) && all(lessThan(at, u_size + 64.0));
    if (ink <= 0.0 || !near || !is_seen(m, at, pixel * (1.0 + 1.5 * steep))) {
        gl_Position = NOWHERE;
#ifdef AS_POINTS
        gl_PointSize = 1.0;
#endif
        return;
    }
    float radius = 0.5 * u_diameter * sqrt(ink), drawn = max(radius, 0.5);
    float reach = pixel * (drawn + 1.0) * (1.0 + 2.0 * steep);
    v_dot = vec4(drawn, min(1.0, 4.0 * radius * radius), -m.eye.z - reach, -m.eye.z + reach);
    v_at = at;
#ifdef AS_POINTS
    /* Points are left out when their middles are outside. What is seen of such a dot lies as near to the place on the rim that is nearest to its middle. */
    gl_PointSize = 2.0 * drawn + 2.0;
    at = clamp(at, vec2(0.01), u_size - 0.01);
#else
    vec2 corner = vec2(float(gl_VertexID & 1), float((gl_VertexID >> 1) & 1)) * 2.0 - 1.0;
    at += corner * (drawn + 0.5);
#endif
    gl_Position = vec4(at / u_size * 2.0 - 1.0, 0.0, 1.0);
}
