/* tones: the sum of the lights picks one of a few colours, with hard borders. Nienhaus 2005, section 4.8 (n-tone
 * shading); Großmann 2011, section 3.2.1 (a look-up table with any number of steps); row Großmann 1. */
#include "surface/surface.h"

typedef struct tones {
    palette palette;
    float   tint, bias;
} tones;

static const param params[] = {
    PARAM_PALETTE_ROW(
        tones, palette,
        .def_palette = {3, {{0.42f, 0.45f, 0.52f, 1}, {0.74f, 0.75f, 0.76f, 1}, {0.97f, 0.96f, 0.92f, 1}}},
        .as_light = true, .doc = "The tones, darkest first; light is split evenly between them."),
    PARAM_FLOAT_ROW(tones, tint, .def = 1, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How far the model's own colour tints the tones."),
    PARAM_FLOAT_ROW(tones, bias, .def = 0, .min = -1, .max = 1,
                    .doc = "Moves the borders: positive widens the lit tones."),
};

const technique surface_tones = {
    .name = "tones",
    .doc = "A few flat colours chosen by the light.",
    .example = "{\"surface\": {\"technique\": \"tones\", \"palette\": [\"#203040\", \"#8090a0\", \"#f0f0e8\"]}}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(tones),
    .surface = &(const surface_row){.shader = "surface/tones.glsl", .direct = true},
};
