/* The kind "motion": how a figure tells that it moves. */
#ifndef LIMNER_MOTION_MOTION_H
#define LIMNER_MOTION_MOTION_H

#include "technique/technique.h"

extern const kind kind_motion;

extern const technique motion_stochastic, motion_accumulate, motion_blur, motion_streak_map, motion_stretched;
extern const technique motion_streaks, motion_traces, motion_deform;

/* What all techniques of the kind have first. */
typedef struct motion_common {
    float exposure; /* seconds */
    float stretch, squash, lean, inertia, full_speed, full_acceleration, response, slit, pan, lag, drag,
        comb; /* pose/deform.h */
    int32_t comb_teeth;
} motion_common;

#endif
