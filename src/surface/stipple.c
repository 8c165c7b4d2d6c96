/* stipple: dots that lie on the surface itself, evenly spread, of which light and distance choose. Freudenberg
 * 2003, sections 5.1.5 and 5.4.7; rows EX-10, EX-31, EX-32. The room `dots` works its dots out for each pixel
 * instead, on planes laid on the model. */
#include <math.h>

#include "base/text.h"
#include "surface/halftone/halftone.h"
#include "surface/marks.h"
#include "surface/on_ground.h"
#include "surface/surface.h"

static const param params[] = {
    MARK_ROWS(200000, "Dots"),
    PARAM_FLOAT_ROW(stipple_values, diameter, .def = 1.65, .min = 0.225, .max = 48, .soft_min = 0.75, .soft_max = 7.5,
                    .unit = UNIT_PT, .doc = "Diameter of the dots."),
    PARAM_FLOAT_ROW(stipple_values, grow, .def = 1.5, .min = 1, .max = 16, .soft_max = 4, .unit = UNIT_NONE,
                    .doc =
                        "Dots become up to this many times as wide where there are not enough of them for the tone."),
};

static void describe(text *out, const void *values)
{
    const mark_values *v = values;
    text_append(out, "stipple %d %d", v->count, v->pattern_seed);
}

static lmn_status make(marks *out, const mark_surface *surface, double extent, const void *values, lmn_error *error)
{
    (void)extent;
    const mark_values *v = values;
    return marks_stipple_kept(out, surface, (size_t)v->count, (uint32_t)v->pattern_seed, error);
}

static float largest(const void *values)
{
    const stipple_values *v = values;
    return v->diameter * v->grow + 3;
}

static const mark_source source = {.point = largest,
                                   .describe = describe,
                                   .make = make,
                                   .vertex = "surface/stipple.vert",
                                   .fragment = "surface/stipple.frag"};

static void stipple_by_pen(void *values)
{
    stipple_values *v = values;
    v->grow = 1;
}

static bool stipple_on_ground(const void *values, colour ground)
{
    const stipple_values *v = values;
    return draws_ground(&(halftone_values){.ink = v->common.ink, .paper = v->common.paper}, ground);
}

const technique surface_stipple = {
    .name = "stipple",
    .doc = "Dots on the surface itself, evenly spread, whose number makes the tone.",
    .example = "{\"surface\": {\"technique\": \"stipple\", \"count\": 2000}, \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(stipple_values),
    .channels = CHANNEL_NORMAL_DEPTH,
    .surface = &(const surface_row){.as_marks = stipple_by_pen,
                                    .on_ground = stipple_on_ground,
                                    .shader = "surface/stipple.glsl",
                                    .marks = &source},
};
