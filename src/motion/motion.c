/* The table of techniques that tell of motion. */
#include "motion/motion.h"

static const technique *const techniques[] = {&motion_accumulate, &motion_blur,      &motion_streak_map,
                                              &motion_streaks,    &motion_stretched, &motion_stochastic,
                                              &motion_traces};

static const param common[] = {
    PARAM_FLOAT_ROW(motion_common, exposure, .def = 0.04, .min = 0.0001, .max = 3600, .soft_min = 0.005, .soft_max = 1,
                    .cpu_only = true,
                    .doc = "How long the shutter is open, seconds: motion is told of this long before the time that is "
                           "drawn. The same for all rules of a look."),
};

const kind kind_motion = {
    .id = KIND_MOTION,
    .name = "motion",
    .doc = "How models that move tell so. Needs a time (--time, --frames).",
    .techniques = techniques,
    .technique_count = PARAM_COUNT(techniques),
    .standard = NULL,
    .selector_key = "technique",
    .common = common,
    .common_count = PARAM_COUNT(common),
};
