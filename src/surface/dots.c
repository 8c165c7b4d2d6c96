/* dots: points on the surface that are worked out where they are needed, at any zoom as dense and as large on the
 * page. Tone comes by their number or by their size. Requirement R-L3 of Freudenberg 2003; for any model, since no
 * texture is laid on it. */
#include "surface/halftone/halftone.h"
#include "surface/on_ground.h"
#include "surface/surface.h"

typedef struct dots {
    halftone_values common;
    int32_t         tone_by;
    float           scale, diameter, wobble, uneven, change;
} dots;

static const char *const tone_names[] = {"number", "size", NULL};

static const param params[] = {
    HALFTONE_ROWS(COORDINATES_TRIPLANAR),
    HALFTONE_INK_ROWS,
    PARAM_ENUM_ROW(dots, tone_by, .names = tone_names, .variant = true,
                   .doc =
                       "Darker places have more dots (number), as in stippling, or larger ones (size), as in print."),
    PARAM_FLOAT_ROW(dots, diameter, .def = 1.65, .min = 0.225, .max = 48, .soft_min = 0.75, .soft_max = 7.5,
                    .unit = UNIT_PT, .only_if = "tone_by=number", .doc = "Diameter of the dots."),
    PARAM_FLOAT_ROW(dots, scale, .def = 4.5, .min = 0.75, .max = 150, .soft_min = 2.25, .soft_max = 22.5,
                    .unit = UNIT_PT, .only_if = "tone_by=size", .doc = "Distance between dots, about."),
    PARAM_FLOAT_ROW(dots, wobble, .toggles = true, .def = 0.5, .min = 0, .max = 2, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "How far dots stray from their rows, fraction of their distance."),
    PARAM_FLOAT_ROW(dots, uneven, .toggles = true, .def = 0.05, .min = 0, .max = 1, .soft_max = 0.5,
                    .unit = UNIT_FRACTION, .doc = "Unevenness of the tone."),
    PARAM_FLOAT_ROW(dots, change, .a_second = true, .toggles = true, .def = 0, .min = 0, .max = 60, .soft_max = 12,
                    .doc = "How often a second the places and the unevenness change; 0 never."),
};

static const pass passes[] = {HALFTONE_PASSES};

const technique surface_dots = {
    .name = "dots",
    .doc = "Dots that stay as dense and as large at any zoom, by their number or their size.",
    .example = "{\"surface\": {\"technique\": \"dots\"}, \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(dots),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .surface = &(const surface_row){.shader = "surface/dots.glsl",
                                    .direct = true,
                                    .forward_when = HALFTONE_FORWARD_WHEN,
                                    .deferred_when = HALFTONE_DEFERRED_WHEN,
                                    .on_ground = draws_ground,
                                    .needs = halftone_needs},
};
