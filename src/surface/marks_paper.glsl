/* What lies between marks: paper. The marks are drawn over it: stipple.vert, marks_strokes.vert. */
#include "surface/halftone/paper_of.glsl"
#ifdef WITH_SOLID
#include "surface/halftone/tone.glsl"
#endif

vec4 surface_colour(surface_point p)
{
#ifdef WITH_SOLID
    float darkness = focused(p, clamp(darkness_of(tone_of_light(p, light_of(p))), 0.0, 1.0));
    return mix(paper_of(p), vec4(u_ink.rgb * u_ink.a, u_ink.a), smoothstep(u_solid - 0.06, u_solid, darkness));
#else
    return paper_of(p);
#endif
}
