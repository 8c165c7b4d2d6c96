/* four-tap: edge intensities from four samples on the diagonals. Nienhaus 2005, section 4.3; rows E06, E07, E21. */
#include "lines/lines.h"

typedef struct four_tap {
    lines_common common;
    bool         squared;
} four_tap;

static const param params[] = {
    PARAM_BOOL_ROW(four_tap, squared, .def = 1, .variant = true,
                   .doc = "Depth factors are squared, as the text of Nienhaus (2005, section 4.3) has them; its "
                          "listing leaves the square out."),
};

static const pass passes[] = {
    LINES_PASSES_BEFORE,
    {.name = "edges",
     .shader = "lines/edge/four_tap.glsl+lines/edge/detect.frag",
     .reads = {TARGET_NORMAL_DEPTH, TARGET_DEPTH, TARGET_MEETING},
     .writes = TARGET_EDGE},
    LINES_PASSES_BEHIND,
};

const technique lines_four_tap = {
    .name = "four-tap",
    .doc = "Depth and normal differences of two diagonal sample pairs.",
    .example = "{\"lines\": {\"operator\": \"four-tap\"}, \"surface\": \"flat\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(four_tap),
    .channels = CHANNEL_NORMAL_DEPTH,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    LINES_TARGETS,
    .lines = &(const lines_row){.detect = "lines/edge/four_tap.glsl"},
};
