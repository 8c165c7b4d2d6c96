/* wire: lines alone, by a threshold of the edge intensity: a wireframe of what matters, with the ground between.
 * Nienhaus 2005, section 5.2 and figure 5-4b; row B06. */
#include "compose/compose.h"

typedef struct wire {
    layer_style style;
    float       threshold, softness;
} wire;

static const param params[] = {
    LAYER_STYLE_ROWS,
    PARAM_FLOAT_ROW(wire, threshold, .def = 0.5, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Ink below this fraction is left out."),
    PARAM_FLOAT_ROW(wire, softness, .def = 1, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Width of a soft threshold: 1 leaves ink around 0.5 as it is, and so smooth rims; 0 leaves "
                           "lines fully inked or out, "
                           "as Nienhaus (2005) does."),
};

static const pass passes[] = {
    {.name = "wire",
     .shader = "compose/wire.frag",
     .reads = LAYER_READS,
     .writes = TARGET_LAYERS,
     .blend = BLEND_UNDER,
     .depth = true},
    LAYER_PASSES_BEHIND,
};

const technique compose_wire = {
    .name = "wire",
    .doc = "Lines of all layers alone, the ground between them.",
    .example = "{\"compose\": \"wire\", \"layers\": \"peel\", \"lines\": \"four-tap\", \"surface\": \"lit\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(wire),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    LAYER_TARGETS,
    .compose = &(const compose_row){.merges_when = "contrast=none",
                                    .map_when = "once",
                                    .layered = true,
                                    .perturbable = true,
                                    .lines_only = true},
};
