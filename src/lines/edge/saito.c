/* saito, saito-normalised: the reference operators of Saito and Takahashi on the depth buffer, as Nienhaus 2005
 * (4.1) and Müller (2.2, equation 3) quote them: profiles by a first-order, inner lines by a second-order
 * difference. Rows E24, E26, P4. */
#include "lines/lines.h"

typedef struct saito {
    lines_common common;
    int32_t      weights;
} saito;

static const char *const weight_names[] = {"sobel", "pencil", "pencil-shader", NULL};

static const param params[] = {
    PARAM_ENUM_ROW(saito, weights, .names = weight_names, .variant = true,
                   .doc = "Profile formula: sobel (Nienhaus 2005), pencil (Müller, equation 3), pencil-shader (its "
                          "printed weights)."),
};

static const pass plain_passes[] = {
    LINES_PASSES_BEFORE,
    {.name = "edges",
     .shader = "lines/edge/saito.glsl+lines/edge/detect.frag",
     .reads = {TARGET_NORMAL_DEPTH, TARGET_DEPTH, TARGET_MEETING},
     .writes = TARGET_EDGE},
    LINES_PASSES_BEHIND,
};

const technique lines_saito = {
    .name = "saito",
    .doc = "First-order profiles and second-order inner lines of the depth buffer.",
    .example = "{\"lines\": {\"operator\": \"saito\", \"gain\": 8}, \"surface\": \"flat\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(saito),
    .channels = CHANNEL_NORMAL_DEPTH,
    .passes = plain_passes,
    .pass_count = PARAM_COUNT(plain_passes),
    LINES_TARGETS,
    .lines = &(const lines_row){.detect = "lines/edge/saito.glsl"},
};

typedef struct saito_normalised {
    lines_common common;
    float        jump, floor;
} saito_normalised;

static const param normalised_params[] = {
    PARAM_FLOAT_ROW(saito_normalised, jump, .def = 0.02, .min = 0.0001, .max = 1, .soft_min = 0.001, .soft_max = 0.2,
                    .unit = UNIT_FRACTION, .logarithmic = true,
                    .doc = "Gradient, as a fraction of the depth range, above which a place is a discontinuity."),
    PARAM_FLOAT_ROW(saito_normalised, floor, .def = 0.0005, .min = 0, .max = 1, .soft_max = 0.01, .unit = UNIT_FRACTION,
                    .doc = "Gradient below which a neighbourhood counts as flat."),
};

static const pass normalised_passes[] = {
    LINES_PASSES_BEFORE,
    {.name = "gradient",
     .shader = "lines/edge/saito_gradient.frag",
     .reads = {TARGET_NORMAL_DEPTH},
     .writes = LINES_GRADIENT},
    {.name = "normalise",
     .shader = "lines/edge/saito_normalise.frag",
     .reads = {LINES_GRADIENT, TARGET_NORMAL_DEPTH, TARGET_DEPTH, TARGET_MEETING},
     .writes = TARGET_EDGE},
    LINES_PASSES_BEHIND,
};

const technique lines_saito_normalised = {
    .name = "saito-normalised",
    .doc = "Gradients normalised by their neighbourhood's extremes, against large jumps and double lines.",
    .example = "{\"lines\": {\"operator\": \"saito-normalised\"}, \"surface\": \"flat\"}",
    .params = normalised_params,
    .param_count = PARAM_COUNT(normalised_params),
    .params_size = sizeof(saito_normalised),
    .channels = CHANNEL_NORMAL_DEPTH,
    .passes = normalised_passes,
    .pass_count = PARAM_COUNT(normalised_passes),
    LINES_TARGETS,
    .lines = &(const lines_row){.detect = NULL},
};
