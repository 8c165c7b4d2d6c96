/* What techniques share that look at a mover along its way. */
#ifndef LIMNER_MOTION_ALONG_H
#define LIMNER_MOTION_ALONG_H

#include "technique/technique.h"

enum { ALONG_TARGETS = 2 };
#define TARGET_NEAREST TARGET_OWN(0) /* the nearest pixel of a mover: nearest.frag */
#define TARGET_CELLS   TARGET_OWN(1) /* the mean motion around each texel: cells.frag */
extern const target_row along_targets[ALONG_TARGETS];

/* Of the past they read where things were when the shutter opened. */
int along_steps(const void *values);

/* One seeding and jumps of 32, 16, … 1 texels. */
#define ALONG_NEAREST_PASS                                                                                             \
    {                                                                                                                  \
        .name = "nearest", .shader = "motion/nearest.frag", .reads = {TARGET_NEAREST, TARGET_VELOCITY},                \
        .writes = TARGET_NEAREST, .repeat = 7                                                                          \
    }

/* What along.glsl reads. */
#define ALONG_READS                                                                                                    \
    TARGET_MOVER, TARGET_MOVER_DEPTH, TARGET_DEPTH, TARGET_VELOCITY, TARGET_STRETCHED, TARGET_NEAREST,                 \
        TARGET_SCENE_DEPTH

#endif
