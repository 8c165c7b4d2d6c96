/* blueprint: every layer's lines, and a tint that adds up, so that depth complexity shows. Nienhaus takes the edge
 * intensity for alpha; literally that makes all areas opaque and hides every layer but one, so areas get a small
 * alpha and lines a full one. Nienhaus 2005, section 5.2; rows B02, B04, B12, B13. */
#include "compose/compose.h"

typedef struct blueprint {
    layer_style style;
    colour      tint;
    float       tint_opacity;
} blueprint;

static const param params[] = {
    LAYER_STYLE_ROWS,
    PARAM_COLOUR_ROW(blueprint, tint, .def_colour = {0.36f, 0.54f, 0.80f, 1},
                     .doc = "Colour that each layer adds; none adds none."),
    PARAM_FLOAT_ROW(blueprint, tint_opacity, .def = 0.14, .min = 0, .max = 1, .soft_max = 0.5, .unit = UNIT_FRACTION,
                    .doc = "Opacity of one layer's tint: how quickly depth complexity darkens or lightens the ground."),
};

static const pass passes[] = {
    {.name = "blueprint",
     .shader = "compose/blueprint.frag",
     .reads = LAYER_READS,
     .writes = TARGET_LAYERS,
     .blend = BLEND_UNDER,
     .depth = true},
    LAYER_PASSES_BEHIND,
};

const technique compose_blueprint = {
    .name = "blueprint",
    .doc = "Lines of all layers over a tint that grows with depth complexity.",
    .example = "{\"compose\": \"blueprint\", \"layers\": \"peel\", \"lines\": \"discontinuity\", \"surface\": \"lit\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(blueprint),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    LAYER_TARGETS,
    .compose =
        &(const compose_row){.merges_when = "contrast=none", .map_when = "once", .layered = true, .perturbable = true},
};
