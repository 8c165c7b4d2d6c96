/* lambert: one diffuse term, the yardstick for speed. */
#include "surface/surface.h"

typedef struct lambert {
    float ambient;
} lambert;

static const param params[] = {
    PARAM_FLOAT_ROW(lambert, ambient, .def = 0.18, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Light that reaches every place."),
};

const technique surface_lambert = {
    .name = "lambert",
    .doc = "One diffuse term of all lights.",
    .example = "{\"surface\": \"lambert\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(lambert),
    .surface = &(const surface_row){.shader = "surface/lambert.glsl", .direct = true},
};
