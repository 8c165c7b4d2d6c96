/* What lies between marks: paper. The marks are drawn over it: stipple.vert, marks_strokes.vert. */
#include "surface/halftone/paper_of.glsl"

vec4 surface_colour(surface_point p)
{
    return paper_of(p);
}
