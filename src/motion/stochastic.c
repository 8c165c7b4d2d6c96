/* stochastic: each pixel sees the object at moments of its own, so that blur shows as grain and never as ghosts.
 * Großmann 2011, section 4.3, after Akenine-Möller, Munkberg and Hasselgren 2007; row 39. */
#include "motion/motion.h"

typedef struct stochastic_values {
    motion_common common;
    int32_t       samples;
} stochastic_values;

static const param params[] = {
    PARAM_INT_ROW(stochastic_values, samples, .def = 4, .min = 1, .max = 64, .soft_max = 16, .unit = UNIT_COUNT,
                  .cpu_only = true,
                  .doc = "At how many moments each pixel sees the object; with more the grain is finer."),
};

enum { SCATTERED = TARGET_COUNT, SCATTERED_DEPTH };

static const target_row targets[] = {
    {"t_scattered", TEXEL_RGBA32F},
    {"t_scattered_depth", TEXEL_DEPTH32F},
};

static int one_step(const void *values)
{
    (void)values;
    return 1;
}

static const pass passes[] = {
    {.name = "scattered",
     .shader = "motion/scattered.frag",
     .reads = {TARGET_MOVER},
     .writes = (target)SCATTERED,
     .scattered = "samples"},
    {.name = "stochastic",
     .shader = "motion/stochastic.frag",
     .reads = {(target)SCATTERED, (target)SCATTERED_DEPTH, TARGET_SCENE_DEPTH},
     .writes = TARGET_PAGE,
     .blend = BLEND_OVER,
     .depth = true},
};

const technique motion_stochastic = {
    .name = "stochastic",
    .doc = "Each pixel sees the object at moments of its own: blur as grain, without ghosts.",
    .example = "{\"motion\": {\"technique\": \"stochastic\"}, \"surface\": \"lit\", \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(stochastic_values),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .targets = targets,
    .target_count = PARAM_COUNT(targets),
    .motion = &(const motion_row){.steps = one_step, .of_meshes = true},
};
