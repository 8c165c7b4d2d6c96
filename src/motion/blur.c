/* blur: what moves is smeared along its way, by a line integral over the mover alone. Großmann 2011, section 4.5; rows
 * 44, 45, 47, 48 and 50. */
#include "motion/along.h"
#include "motion/motion.h"

typedef struct blur_values {
    motion_common common;
    int32_t       samples;
    float         glints;
} blur_values;

static const param params[] = {
    PARAM_INT_ROW(
        blur_values, samples, .def = 32, .min = 2, .max = 64, .soft_min = 8, .soft_max = 64, .unit = UNIT_COUNT,
        .doc = "How many samples along the way a pixel takes at most; fewer show steps where motion is fast."),
    PARAM_FLOAT_ROW(blur_values, glints, .toggles = true, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc =
                        "How much of their brightness highlights keep along their way; 0: they are averaged away, as "
                        "in photographs."),
};

static const pass passes[] = {
    ALONG_NEAREST_PASS,
    {.name = "blur",
     .shader = "motion/blur.frag",
     .reads = {ALONG_READS},
     .writes = TARGET_PAGE,
     .blend = BLEND_OVER,
     .depth = true},
};

const technique motion_blur = {
    .name = "blur",
    .doc = "What moves is smeared along its way, as in photographs.",
    .example = "{\"motion\": {\"technique\": \"blur\"}, \"surface\": \"lit\", \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(blur_values),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .targets = along_targets,
    .target_count = ALONG_TARGETS,
    .motion = &(const motion_row){.steps = along_steps, .stretched = true},
};
