/* A camera on its way, and what it sees at any time. */
#ifndef LIMNER_DEPICT_SHOT_H
#define LIMNER_DEPICT_SHOT_H

#include "depict/depict_private.h"

typedef struct shot {
    way           way;
    int32_t       node;   /* that has the camera */
    const camera *camera; /* as it is at rest */
    double        aspect, focus;
} shot;

/* The first camera at the expression's target or below it. What it sees is told of at the distance `focus`; 0: at a
 * fifth of the way to the middle of the scene. Errors: LMN_USAGE (there is none), LMN_MEMORY. Release it also after
 * one. */
lmn_status shot_open(shot *out, const depict_job *j, const expression *e, double focus, lmn_error *error);
void       shot_release(shot *s);

/* A place of the plane that is in focus; (±1, ±1) are the corners of what is seen. */
void   shot_point(const shot *s, double seconds, double x, double y, double out[3]);
double shot_height(const shot *s);

#endif
