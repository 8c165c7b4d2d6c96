/* The lights of a view: the studio's or the file's own. Light reaches surfaces alike whether they are drawn as
 * pixels or as vectors. */
#ifndef LIMNER_PLAN_LIGHTS_H
#define LIMNER_PLAN_LIGHTS_H

#include "light/light.h"
#include "look/look.h"
#include "pose/pose.h"

typedef struct light_list {
    float positions[LIGHTS_MAX][4]; /* eye space: a position, 1; or the direction towards the light, 0 */
    float colours[LIGHTS_MAX][4];   /* linear */
    int   count;                    /* at least 1 */
    int   rim;                      /* which of them is the rim light; -1: none */
} light_list;

typedef struct light_conditions {
    const lmn_look *look;
    const pose     *pose;
    const mat4     *view;   /* to eye space */
    const float    *mirror; /* the plane in eye space of the mirror whose view this is; NULL: none */
} light_conditions;

light_list lights_list(const light_conditions *c);

#endif
