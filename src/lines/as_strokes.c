/* Lines that are found in pictures, as strokes of the mesh. */
#include <math.h>

#include "lines/lines.h"
#include "stroke/ribbon.h"

static const float inner_fraction = 0.75f; /* width of creases beside outlines, as draughtsmen have it */

static bool is_class_inner(int kind)
{
    return kind != STROKE_CONTOUR && kind != STROKE_BORDER;
}

void lines_as_strokes(stroke_options *options, stroke_style *style, const void *values)
{
    const lines_common *lines = values;
    colour              inner = isnan(lines->inner_colour.r) ? lines->colour : lines->inner_colour;
    for (int i = 0; i < STROKE_CLASS_COUNT; i++)
        style->colours[i] = is_class_inner(i) ? inner : lines->colour;
    style->width = lines->width;
    style->crease_width = inner_fraction;
    style->dash = lines->dash;
    style->gap = lines->gap;
    style->overshoot = lines->overshoot;
    style->halo = lines->halo;
    bool outlines = lines->colour.a > 0 && lines->profile_weight > 0, inside = inner.a > 0 && lines->inner_weight > 0;
    options->contours = outlines ? CONTOURS_EDGES : CONTOURS_NONE;
    options->borders = outlines;
    options->creases = options->intersections = options->drawn = inside;
    options->materials = 0;
}
