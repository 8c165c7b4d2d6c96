/* Dots: points, one vertex each, or where they are too large for that, quads: each record four times. Whether a dot is hidden is asked once, at its middle, so that its own surface cuts nothing off it (EX-14). */
#include "surface/marks.glsl"

layout(location = 0) in vec4 a_position;  /* priority */
layout(location = 1) in vec4 a_normal; /* brightness of the model there */

uniform float u_density; /* dots to a unit of area */

flat out vec4 v_dot;  /* radius in pixels, opacity, nearest and farthest depth of what it may lie on */
flat out vec2 v_at;   /* its middle, pixels */

/* Is the surface that is seen in the dot's pixel the dot's own? */
bool is_seen(mark_position m, vec2 at, float reach)
{
    vec4 seen = texelFetch(t_normal_depth, ivec2(clamp(at, vec2(0.0), u_size - 1.0)), 0);
    return abs(seen.w + m.eye.z) <= reach && dot(seen.xyz, m.normal) > 0.3;
}

/* What a dot needs before light is asked for. */
struct dot_position {
    mark_position mark;
    vec2       at;
    float      there; /* dots to a pixel, all of them */
};

void put_dot(dot_position d)
{
    mark_position m = d.mark;
    float pixel = pixel_at(m.eye), steep = steepness(m);
    float needed = ink_of_cover(darkness_at(m, a_normal.w), u_diameter) / (0.78539816 * u_diameter * u_diameter);
    float ink = ink_of_rank(1.0 - a_position.w, needed / d.there, u_grow * u_grow, u_fade);
    if (ink <= 0.0 || !is_seen(m, d.at, pixel * (1.0 + 1.5 * steep)))
        return;
    /* A disc whose rim is a pixel wide has the area of one whose square of the radius is a twelfth larger. What is smaller than a pixel is paler instead. */
    float square = 0.25 * u_diameter * u_diameter * ink, drawn = sqrt(max(square - 1.0 / 12.0, 0.25));
    float reach = pixel * (drawn + 1.0) * (1.0 + 2.0 * steep);
    v_dot = vec4(drawn, min(1.0, 3.0 * square), -m.eye.z - reach, -m.eye.z + reach);
    v_at = d.at;
    vec2 at = d.at;
#ifdef AS_POINTS
    /* Points are left out when their middles are outside. What is seen of such a dot lies as near to the position on the rim that is nearest to its middle. */
    gl_PointSize = 2.0 * drawn + 2.0;
    at = clamp(at, vec2(0.01), u_size - 0.01);
#else
    vec2 corner = vec2(float(gl_VertexID & 1), float((gl_VertexID >> 1) & 1)) * 2.0 - 1.0;
    at += corner * (drawn + 0.5);
#endif
    gl_Position = vec4(at / u_size * 2.0 - 1.0, 0.0, 1.0);
}

void main()
{
    gl_Position = NOWHERE;
#ifdef AS_POINTS
    gl_PointSize = 1.0;
#endif
    dot_position d;
    d.mark = position_of_mark(a_position.xyz, a_normal.xyz);
    vec4 clip = u_projection * vec4(d.mark.eye, 1.0);
    d.at = page_of(clip);
    d.there = u_density / max(page_area(d.mark), 1e-20);
    float margin = 0.5 * u_diameter * u_grow + 1.0;
    bool near = clip.w > 0.0 && all(greaterThan(d.at, vec2(-margin))) && all(lessThan(d.at, u_size + margin));
    /* Those of high rank are too many even where it is darkest. Software drivers skip loops that nobody enters, but not branches. */
    float most = ink_of_cover(1.0, u_diameter) / (0.78539816 * u_diameter * u_diameter) * (1.0 + u_fade);
    int wanted = near && !d.mark.far && (1.0 - a_position.w) * d.there <= most ? 1 : 0;
    for (int once = 0; once < wanted; once++)
        put_dot(d);
}
