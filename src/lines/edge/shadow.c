/* shadow: lines around the shadows that the first light throws. Müller, section 2.2 (normals turned around in
 * shadow, Mitchell 2002); row P15. */
#include "lines/lines.h"

typedef struct shadow_edges {
    lines_common common;
} shadow_edges;

static const pass passes[] = {
    {.name = "edges",
     .shader = "lines/edge/shadow.glsl+lines/edge/detect.frag",
     .reads = {TARGET_NORMAL_DEPTH, TARGET_SHADOW},
     .writes = TARGET_EDGE},
    LINES_PASSES_BEHIND,
};

const technique lines_shadow = {
    .name = "shadow",
    .doc = "Lines where a shadow ends on a surface that faces the light, whether or not shadows are drawn; the light "
           "must shine from one direction.",
    .example = "{\"lines\": {\"operator\": \"shadow\"}, \"surface\": \"flat\"}",
    .params_size = sizeof(shadow_edges),
    .channels = CHANNEL_NORMAL_DEPTH,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    LINES_TARGETS,
    .lines = &(const lines_row){.detect = "lines/edge/shadow.glsl"},
};
