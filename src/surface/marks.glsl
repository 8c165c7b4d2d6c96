/* What decides on the GPU which marks are drawn: marks/marks_law.c and marks/marks_page.c in the vertex stage. Every vertex of a mark comes to the same decision, since all of them have the
 * same numbers. Freudenberg 2003, sections 5.1 and 5.4, with what is printed wrong there mended; rows EX-01 to EX-08. */
#include "surface/halftone/tone.glsl"
#include "surface/marks_law.glsl"

uniform float u_focal;  /* of the projection, pixels at depth 1, or to a unit */

uniform float u_closed;  /* 1: the surface is closed, all of it is there, and the viewer is outside */

const float BRIGHTEST = 1.15; /* tone: what is nearly white is paper where it is lit */

const vec4 NOWHERE = vec4(0.0, 0.0, 2.0, 1.0); /* outside of what is drawn: the cheapest way to leave a mark out (EX-13) */

/* Where a mark's tone is decided. */
struct mark_position {
    vec3  eye, normal; /* normal: unit, as the surface has it */
    float facing;      /* cosine between normal and view */
    bool  far;         /* its face turns away, and something else hides it */
};

/* `normal` is longer than 1 by the least cosine with which a normal that leans off its face's can turn away while the face does not (EX-30). */
mark_position position_of_mark(vec3 position, vec3 normal)
{
    mark_position m;
    m.eye = (u_model_view * vec4(position, 1.0)).xyz;
    m.normal = normalize(u_normal_matrix * normal);
    m.facing = dot(m.normal, towards_viewer(m.eye));
    m.far = u_closed > 0.5 && m.facing < 1.0 - length(normal);
    return m;
}

/* Page area of a unit of area there. */
float page_area(mark_position m)
{
    float depth = max(-m.eye.z, 1e-20);
    return u_focal * u_focal * (u_perspective > 0.5 ? abs(dot(m.eye, m.normal)) / (depth * depth * depth) : abs(m.normal.z));
}

/* How dark it shall be; `bright`: of the model's own colour there, linear. */
float darkness_at(mark_position m, float bright)
{
    vec3 normal = m.facing < 0.0 ? -m.normal : m.normal;
#if defined(WITH_TEXTURE) && !defined(RANGED)
    /* More light than paper has is no reason to lose what is dark by itself. */
    surface_point p = surface_point(m.eye, normal, normal, vec4(1.0), false, 0u);
    float tone = min(tone_of_light(p, light_of(p)), BRIGHTEST) * mix(1.0, seen_brightness(vec3(bright)), u_texture);
#else
    surface_point p = surface_point(m.eye, normal, normal, vec4(vec3(bright), 1.0), false, 0u);
    float tone = tone_of_light(p, light_of(p));
#endif
    return focused(p, clamp(darkness_of(tone), 0.0, 1.0));
}

vec2 page_of(vec4 clip)
{
    return (clip.xy / clip.w * 0.5 + 0.5) * u_size;
}

/* Length of a pixel there, in depth and across. */
float pixel_at(vec3 eye)
{
    return (u_perspective > 0.5 ? -eye.z : 1.0) / u_focal;
}

/* How much the surface gets deeper from one pixel to the next. */
float steepness(mark_position m)
{
    float c = min(abs(m.facing), 1.0);
    return min(sqrt(1.0 - c * c) / max(c, 0.05), 8.0);
}
