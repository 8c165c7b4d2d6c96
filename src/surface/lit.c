/* lit: Phong with a small highlight, brightened so that lines stay the darkest thing in the picture. */
#include "surface/surface.h"

typedef struct lit {
    float ambient, specular, lightness, shininess;
    float model_colour;
} lit;

static const param params[] = {
    PARAM_FLOAT_ROW(lit, ambient, .def = 0.35, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Light that reaches every place."),
    PARAM_FLOAT_ROW(lit, specular, .def = 0.12, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Strength of the highlight."),
    PARAM_FLOAT_ROW(lit, shininess, .def = 40, .min = 1, .max = 1000, .soft_max = 200, .logarithmic = true,
                    .doc = "Sharpness of the highlight: the exponent of Phong's model."),
    PARAM_FLOAT_ROW(lit, lightness, .def = 0.25, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Mixes the colour towards white, so that lines stand out."),
    PARAM_FLOAT_ROW(lit, model_colour, .def = 1, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Fraction of the model's own colour; the rest is white."),
};

const technique surface_lit = {
    .name = "lit",
    .doc = "Phong shading with a small highlight.",
    .example = "{\"surface\": {\"technique\": \"lit\", \"specular\": 0.5}}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(lit),
    .surface = &(const surface_row){.shader = "surface/lit.glsl", .direct = true},
};
