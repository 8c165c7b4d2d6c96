/* relief: terrain as maps show it: tints by height, hills shaded by the light, contour lines. Contours lie where the
 * surface passes whole multiples of the interval, in the heights of the file. */
#include "surface/surface.h"

typedef struct relief {
    palette palette;
    float   tint, shade, interval, contour;
    colour  contour_colour, sea;
} relief;

static const param params[] = {
    PARAM_PALETTE_ROW(relief, palette,
                      .def_palette = {5,
                                      {{0.80f, 0.87f, 0.73f, 1},
                                       {0.91f, 0.92f, 0.78f, 1},
                                       {0.95f, 0.89f, 0.72f, 1},
                                       {0.88f, 0.77f, 0.62f, 1},
                                       {0.97f, 0.95f, 0.93f, 1}}},
                      .doc = "Tints from the lowest to the highest; between them they run into each other."),
    PARAM_FLOAT_ROW(relief, tint, .def = 1, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How far tints take the place of the model's own colour."),
    PARAM_FLOAT_ROW(relief, shade, .def = 0.6, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much darker slopes are that look away from the light, and lighter those that look "
                           "towards it; 0: not at all."),
    PARAM_FLOAT_ROW(relief, interval, .def = 0, .min = 0, .max = 1e6, .soft_max = 100,
                    .doc = "Height between contour lines, in the model's unit; 0: a round number of which ten to "
                           "twenty-five fit. Each fifth line is bolder."),
    PARAM_FLOAT_ROW(relief, contour, .def = 0.4, .min = 0, .max = 12, .soft_max = 1.5, .unit = UNIT_PT,
                    .doc = "Width of the contour lines, 0: none; where they crowd on a slope the bolder ones stay."),
    PARAM_COLOUR_ROW(relief, sea, .def_colour = {0.81f, 0.89f, 0.92f, 1},
                     .doc = "Colour of level ground at height 0, as rasters of heights have the sea; no alpha: it is "
                            "land."),
    PARAM_COLOUR_ROW(relief, contour_colour, .def_colour = {0.55f, 0.42f, 0.30f, 1}, .only_if = "contour",
                     .doc = "Their colour."),
};

const technique surface_relief = {
    .name = "relief",
    .doc = "Terrain as maps show it: tints by height, shaded hills, contour lines.",
    .example = "{\"surface\": {\"technique\": \"relief\", \"palette\": [\"#cfdfbb\", \"#efe3b8\", \"#fff8f0\"]}}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(relief),
    .surface = &(const surface_row){.shader = "surface/relief.glsl", .direct = true},
};
