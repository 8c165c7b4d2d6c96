/* colour: lines in the unlit surface colour, for details that are painted and not modelled. Müller, section 2.2;
 * row P13. */
#include "lines/lines.h"

typedef struct colour_edges {
    lines_common common;
    float        contour_contrast;
} colour_edges;

static const param params[] = {
    PARAM_FLOAT_ROW(colour_edges, contour_contrast, .def = 1, .min = 0.01, .max = 20, .soft_min = 0.2, .soft_max = 5,
                    .logarithmic = true,
                    .doc = "Colour difference, in sRGB units, that gives full ink is one over this."),
};

static const pass passes[] = {
    {.name = "edges",
     .shader = "lines/edge/colour.glsl+lines/edge/detect.frag",
     .reads = {TARGET_ALBEDO},
     .writes = TARGET_EDGE},
    LINES_PASSES_BEHIND,
};

const technique lines_colour = {
    .name = "colour",
    .doc = "Sobel gradient of the unlit colour.",
    .example = "{\"lines\": {\"operator\": \"colour\"}, \"surface\": \"textured\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(colour_edges),
    .channels = CHANNEL_ALBEDO,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    LINES_TARGETS,
    .lines = &(const lines_row){.detect = "lines/edge/colour.glsl"},
};
