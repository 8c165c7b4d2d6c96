/* sobel: gradient magnitudes of depth and normal from few bilinear samples. Freudenberg 2003, section 8.3 (four
 * samples a direction) and Großmann 2011, section 3.2.4.2 (four samples on the texel corners for both directions);
 * rows OI-04, OI-05, Großmann 12, 13. */
#include "lines/lines.h"

typedef struct sobel {
    lines_common common;
    int32_t      taps;
} sobel;

static const char *const tap_names[] = {"five", "eight", NULL};

static const param params[] = {
    PARAM_ENUM_ROW(
        sobel, taps, .names = tap_names, .variant = true,
        .doc = "five: samples on the four corners give both directions; eight: four samples for each direction."),
};

static const pass passes[] = {
    LINES_PASSES_BEFORE,
    {.name = "filterable",
     .shader = "lines/edge/filterable.frag",
     .reads = {TARGET_NORMAL_DEPTH},
     .writes = LINES_FILTERED},
    {.name = "edges",
     .shader = "lines/edge/sobel.frag",
     .reads = {LINES_FILTERED, TARGET_DEPTH, TARGET_MEETING},
     .writes = TARGET_EDGE},
    LINES_PASSES_BEHIND,
};

const technique lines_sobel = {
    .name = "sobel",
    .doc = "Sobel gradient of depth and normals from bilinear samples.",
    .example = "{\"lines\": {\"operator\": \"sobel\"}, \"surface\": \"flat\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(sobel),
    .channels = CHANNEL_NORMAL_DEPTH,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    LINES_TARGETS,
    .lines = &(const lines_row){.detect = NULL},
};
