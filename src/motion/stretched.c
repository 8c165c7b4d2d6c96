/* stretched: what moves stays whole and draws a trail of itself behind it that fades. Großmann 2011, section 4.4, after
 * the motion blur of DirectX's samples; row 40. */
#include "motion/along.h"
#include "motion/motion.h"

typedef struct stretched_values {
    motion_common common;
    int32_t       samples, blend;
    float         opacity, fade, smear;
} stretched_values;

static const char *const blend_names[] = {"blended", "coverage", NULL};

static const param params[] = {
    PARAM_INT_ROW(stretched_values, samples, .def = 32, .min = 2, .max = 64, .soft_min = 8, .soft_max = 64,
                  .unit = UNIT_COUNT,
                  .doc = "How many samples along the way a pixel takes at most; with fewer, trails fade in steps."),
    PARAM_ENUM_ROW(stretched_values, blend, .names = blend_names, .def = 0, .variant = true,
                   .doc = "blended: what is behind trails shows through; coverage: trails are there at some pixels and "
                          "not at others, which more samples a pixel make smooth."),
    PARAM_FLOAT_ROW(stretched_values, opacity, .def = 0.7, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How opaque trails are where they begin."),
    PARAM_FLOAT_ROW(stretched_values, fade, .def = 1, .min = 0.1, .max = 8, .soft_max = 4,
                    .doc = "How fast trails fade: 1, evenly; above, soon; below, late."),
    PARAM_FLOAT_ROW(stretched_values, smear, .def = 0.3, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How far colours are smeared along trails, fraction of the way."),
};

static const pass passes[] = {
    ALONG_NEAREST_PASS,
    {.name = "trail",
     .shader = "motion/trail.frag",
     .reads = {ALONG_READS},
     .writes = TARGET_PAGE,
     .blend = BLEND_OVER,
     .depth = true},
};

const technique motion_stretched = {
    .name = "stretched",
    .doc = "What moves stays whole and is drawn out into a trail that fades.",
    .example = "{\"motion\": {\"technique\": \"stretched\"}, \"surface\": \"lit\", \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(stretched_values),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .targets = along_targets,
    .target_count = ALONG_TARGETS,
    .motion = &(const motion_row){.steps = along_steps, .stretched = true},
};
