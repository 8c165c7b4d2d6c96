/* Pitch circles: bores, or pins, that are spaced evenly around a circle. */
#ifndef LIMNER_DRAFT_PITCH_H
#define LIMNER_DRAFT_PITCH_H

#include "draft/cylinders.h"

typedef struct draft_pitch {
    double   axis[3], centre[3]; /* unit; in the middle between the ends of its cylinders */
    double   radius;             /* of the circle through their axes */
    double   across[2][3];       /* unit, at right angles to the axis and each other */
    double   from, sweep;  /* where its cylinders are, angles from across[0] to across[1]; sweep 2π: all around */
    size_t   count, steps; /* how many cylinders; each is a whole number of 2π / steps from the next */
    uint32_t part;         /* id */
} draft_pitch;

typedef struct draft_pitches {
    draft_pitch *items;
    size_t       count, capacity;
    int32_t     *of_cylinder; /* per cylinder: the circle that it lies on; −1: none */
} draft_pitches;

/* Circles of three and four, and such as are not full, need something round in their middle: four holes in the corners
 * of a square are no circle. Errors: LMN_MEMORY. */
lmn_status draft_pitches_find(draft_pitches *out, const draft_cylinders *cylinders, lmn_error *error);
void       draft_pitches_release(draft_pitches *p);

#endif
