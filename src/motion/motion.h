/* The kind "motion": how a figure tells that it moves. */
#ifndef LIMNER_MOTION_MOTION_H
#define LIMNER_MOTION_MOTION_H

#include "technique/technique.h"

extern const kind kind_motion;

extern const technique motion_accumulate;
extern const technique motion_streaks;

/* What all techniques of the kind have first. */
typedef struct motion_common {
    float exposure; /* seconds */
} motion_common;

#endif
