/* The ground that a model stands on: a plane through its lowest point, upright to the axis that points up. It is there
 * for shadows alone, and hides nothing. */
#ifndef LIMNER_PLAN_GROUND_H
#define LIMNER_PLAN_GROUND_H

#include "plan/camera.h"
#include "plan/plan.h"

typedef struct ground_plane {
    bool   there;
    int    up;    /* axis of the world: 1 or 2 */
    double level; /* along it */
    double size;  /* diagonal of what is drawn */
    double reach; /* height in which a shadow fades to 1/e */
    box3   box;   /* of what is drawn */
} ground_plane;

/* Finds what the drawn stands on, before any camera is placed: pictures are fitted to its shadow, too. Sets
 * `p->fit.ground`. */
void ground_settle(plan *p);

/* After that. Not there where the look wants none, where the viewer looks from below or along it, and in sections; for
 * a light's shadow not either where things stand at different heights. What is drawn stands on it by its lowest vertex;
 * what is fitted to all times, by where that comes lowest. */
ground_plane ground_find(const plan *p, const view_camera *camera);

#endif
