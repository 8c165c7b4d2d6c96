/* denormal: the mean of differing unit normals is shorter than one. Freudenberg 2003, section 8.4; rows OI-06,
 * OI-07, OI-08. */
#include "lines/lines.h"

typedef struct denormal {
    lines_common common;
    float        tolerance;
    bool         depth;
} denormal;

static const param params[] = {
    PARAM_FLOAT_ROW(denormal, tolerance, .def = 0, .min = 0, .max = 0.5, .soft_max = 0.1,
                    .doc = "Shortening that is still smooth; added to the squared length."),
    PARAM_BOOL_ROW(denormal, depth, .def = 0, .variant = true,
                   .doc = "Maps depth to unit vectors too, so that a depth step between equal normals gets a line."),
};

static const pass passes[] = {
    LINES_PASSES_BEFORE,
    {.name = "filterable",
     .shader = "lines/edge/filterable.frag",
     .reads = {TARGET_NORMAL_DEPTH},
     .writes = LINES_FILTERED},
    {.name = "edges",
     .shader = "lines/edge/denormal.frag",
     .reads = {LINES_FILTERED, TARGET_DEPTH, TARGET_MEETING},
     .writes = TARGET_EDGE},
    LINES_PASSES_BEHIND,
};

const technique lines_denormal = {
    .name = "denormal",
    .doc = "One filtered sample of the normals: where it is short, normals differ.",
    .example = "{\"lines\": {\"operator\": \"denormal\"}, \"surface\": \"flat\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(denormal),
    .channels = CHANNEL_NORMAL_DEPTH,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    LINES_TARGETS,
    .lines = &(const lines_row){.detect = NULL},
};
