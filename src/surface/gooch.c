/* gooch: tone from cool to warm, so that shadow stays readable and lines stay the darkest, highlights the lightest
 * thing. Nienhaus 2005, section 4.6 and listings 3-1, 3-2; Großmann 2011, section 3.2.2; rows E10, Großmann 2. The
 * sources leave the colours open; these are far apart as in Gooch's paper (1998, section 4): a pure blue, a pure
 * yellow, and 0.25 and 0.6 of the model's own. */
#include "surface/surface.h"

typedef struct gooch {
    colour cool, warm;
    float  cool_fraction, warm_fraction, specular, shininess;
} gooch;

static const param params[] = {
    PARAM_COLOUR_ROW(gooch, cool, .def_colour = {0.05f, 0.15f, 0.78f, 1}, .as_light = true,
                     .doc = "Tone of places turned away from the light."),
    PARAM_COLOUR_ROW(gooch, warm, .def_colour = {0.66f, 0.56f, 0.16f, 1}, .as_light = true,
                     .doc = "Tone of places turned to the light."),
    PARAM_FLOAT_ROW(gooch, cool_fraction, .was = "cool_share", .def = 0.25, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much of the model's colour is added to the cool tone."),
    PARAM_FLOAT_ROW(gooch, warm_fraction, .was = "warm_share", .def = 0.6, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much of the model's colour is added to the warm tone."),
    PARAM_FLOAT_ROW(gooch, specular, .def = 0.6, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Strength of the highlight."),
    PARAM_FLOAT_ROW(gooch, shininess, .def = 32, .min = 1, .max = 1000, .soft_max = 200, .logarithmic = true,
                    .doc = "Sharpness of the highlight; Nienhaus (2005) has 32."),
};

const technique surface_gooch = {
    .name = "gooch",
    .doc = "Cool-to-warm tones for technical illustration.",
    .example = "{\"surface\": \"gooch\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(gooch),
    .surface = &(const surface_row){.shader = "surface/gooch.glsl", .direct = true},
};
