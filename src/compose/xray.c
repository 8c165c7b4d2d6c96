/* xray: every layer's own colour, transparent, with its lines: order-independent transparency with outlines. Equal
 * to sorted 'over' of the surfaces, whatever the order of drawing. Nienhaus 2005, section 5.3; rows B07, B08. */
#include "compose/compose.h"

typedef struct xray {
    layer_style style;
    float       opacity, rim;
} xray;

static const param params[] = {
    LAYER_STYLE_ROWS,
    PARAM_FLOAT_ROW(xray, opacity, .def = 0.3, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Opacity of one layer, multiplied with the material's own."),
    PARAM_FLOAT_ROW(xray, rim, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc =
                        "How much more opaque surfaces are that are seen at a slant, as glass and X-rays show them."),
};

static const pass passes[] = {
    {.name = "xray",
     .shader = "compose/xray.frag",
     .reads = LAYER_READS,
     .writes = TARGET_LAYERS,
     .blend = BLEND_UNDER,
     .depth = true},
    LAYER_PASSES_BEHIND,
};

const technique compose_xray = {
    .name = "xray",
    .doc = "Transparent layers with lines, in exact order.",
    .example = "{\"compose\": \"xray\", \"layers\": \"peel\", \"lines\": \"discontinuity\", \"surface\": \"lit\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(xray),
    .channels = CHANNEL_NORMAL_DEPTH | CHANNEL_SHADE,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    LAYER_TARGETS,
    .compose =
        &(const compose_row){.merges_when = "contrast=none", .map_when = "once", .layered = true, .perturbable = true},
};
