/* mirror: a flat part shows the scene behind its plane, with edges of its own. Nienhaus 2005, section 4.6; row E14. */
#include "surface/surface.h"

typedef struct mirror {
    colour tint;
    float  reflectivity;
} mirror;

static const param params[] = {
    PARAM_COLOUR_ROW(mirror, tint, .def_colour = {0.86f, 0.92f, 0.95f, 1},
                     .doc = "Colour of the mirror where it reflects nothing."),
    PARAM_FLOAT_ROW(mirror, reflectivity, .def = 0.85, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Fraction of the reflection."),
};

const technique surface_mirror = {
    .name = "mirror",
    .doc = "A planar mirror.",
    .example = "{\"surface\": \"mirror\", \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(mirror),
    .surface = &(const surface_row){.shader = "surface/mirror.glsl", .forward = true, .reflects = true},
};
