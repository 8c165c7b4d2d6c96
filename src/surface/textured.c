/* textured: the model's own colours and textures, unlit or lightly lit. */
#include "surface/surface.h"

typedef struct textured {
    float light;
} textured;

static const param params[] = {
    PARAM_FLOAT_ROW(textured, light, .def = 0.5, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Fraction of the light; 0 shows the colours as they are painted."),
};

const technique surface_textured = {
    .name = "textured",
    .doc = "The model's own colours and textures.",
    .example = "{\"surface\": {\"technique\": \"textured\", \"light\": 0}}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(textured),
    .surface = &(const surface_row){.shader = "surface/textured.glsl", .direct = true},
};
