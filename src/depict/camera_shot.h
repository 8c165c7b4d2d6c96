/* A camera on its way, and what it sees at any time. */
#ifndef LIMNER_DEPICT_CAMERA_SHOT_H
#define LIMNER_DEPICT_CAMERA_SHOT_H

#include "depict/depict_private.h"

typedef struct camera_shot {
    way                      way;
    int32_t                  node;   /* that has the camera */
    const camera            *camera; /* as it is at rest */
    const animation_channel *zoom;   /* what moves its field of view; NULL: nothing does */
    double                   aspect, focus;
} camera_shot;

/* The first camera at the expression's target or below it. What it sees is told of at the distance `focus`; 0: at a
 * fifth of the way to the middle of the scene. Errors: LMN_USAGE (there is none), LMN_MEMORY. Release it also after
 * one. */
lmn_status camera_shot_open(camera_shot *out, const depict_job *j, const expression *e, double focus, lmn_error *error);
void       camera_shot_release(camera_shot *s);

/* A place of the plane that is in focus; (±1, ±1) are the corners of what is seen. */
void   camera_shot_point(const camera_shot *s, double seconds, double x, double y, double out[3]);
double camera_shot_height(const camera_shot *s);

#endif
