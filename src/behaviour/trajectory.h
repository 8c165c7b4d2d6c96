/* Where something goes: one way to sample it, for whatever can say where it is at a time. Nienhaus 2005, section
 * 7.4.3. */
#ifndef LIMNER_BEHAVIOUR_TRAJECTORY_H
#define LIMNER_BEHAVIOUR_TRAJECTORY_H

#include <stdbool.h>
#include <stddef.h>

#include "limner/error.h"

/* Which of two values that meet at an instant: the one before it, the one that owns it, the one behind it. */
typedef enum time_side { SIDE_BEFORE = -1, SIDE_AT, SIDE_BEHIND } time_side;

/* What is sampled. Between two breaks its place is smooth. */
typedef struct trajectory_source {
    void (*place)(const void *of, double seconds, time_side side, double out[3]);
    const void   *of;
    const double *breaks; /* not decreasing; the first and the last are the interval's ends */
    size_t        break_count;
} trajectory_source;

/* Velocity and acceleration are 0 where nobody has asked for them. */
typedef struct trajectory_sample {
    double seconds, position[3], velocity[3], acceleration[3];
    bool   forced; /* at a break */
} trajectory_sample;

typedef struct trajectory {
    trajectory_sample *samples; /* times do not decrease */
    size_t             count, capacity;
} trajectory;

typedef enum trajectory_detail {
    TRAJECTORY_PLACES, /* one sample at each break */
    TRAJECTORY_CORNERS /* two at each inner break, one of either side, all with their derivatives; from one sample to
                          the next it turns by at most a tenth of a full turn */
} trajectory_detail;

/* Samples so closely that straight lines between samples are nowhere farther than `tolerance` from what is sampled.
 * Errors: LMN_MEMORY, LMN_LIMIT (more than a million samples), LMN_CANCELLED. Release it also after one. */
lmn_status trajectory_create(trajectory *out, const trajectory_source *source, double tolerance,
                             trajectory_detail detail, lmn_error *error);
void       trajectory_release(trajectory *t);

/* Place, velocity and acceleration at one time within begin … end, between which there is no break. */
trajectory_sample trajectory_sample_at(const trajectory_source *source, double seconds, double begin, double end);

/* The length up to each sample; free with mem_free. NULL: out of memory. */
double *trajectory_lengths(const trajectory *t);

/* Sorts times and leaves each once. */
void trajectory_sort_times(double *times, size_t *count);

#endif
