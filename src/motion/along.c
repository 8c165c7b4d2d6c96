#include "motion/along.h"

const target_row along_targets[ALONG_TARGETS] = {
    {"t_nearest", TEXEL_RGBA32F, SCALE_APART, OWNER_TECHNIQUE},
    {"t_cells", TEXEL_RGBA32F, SCALE_APART, OWNER_TECHNIQUE},
};

int along_steps(const void *values)
{
    (void)values;
    return 1;
}
