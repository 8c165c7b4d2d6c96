/* id: lines between parts, from unfiltered ids. Nienhaus 2005, sections 4.7 and 4.8; Müller, section 2.2; rows E22,
 * E23, P12. */
#include "lines/lines.h"

typedef struct id_edges {
    lines_common common;
    int32_t      of;
} id_edges;

static const char *const of_names[] = {"part", "surface", NULL};

static const param params[] = {
    PARAM_ENUM_ROW(id_edges, of, .names = of_names, .variant = true,
                   .doc = "What has a border: the part, or the surface (a part's pieces of one material)."),
};

static const pass passes[] = {
    {.name = "edges",
     .shader = "lines/edge/id.glsl+lines/edge/detect.frag",
     .reads = {TARGET_ID, TARGET_DEPTH, TARGET_MEETING},
     .writes = TARGET_EDGE},
    LINES_PASSES_BEHIND,
};

const technique lines_id = {
    .name = "id",
    .doc = "Lines wherever the part changes, whatever its depth.",
    .example = "{\"lines\": {\"operator\": \"id\"}, \"surface\": \"flat\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(id_edges),
    .channels = CHANNEL_ID,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    LINES_TARGETS,
    .lines = &(const lines_row){.detect = "lines/edge/id.glsl"},
};
