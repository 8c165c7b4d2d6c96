/* Channels of animations at a time: glTF 2.0, section 3.11 and appendix C. */
#ifndef LIMNER_POSE_ANIMATE_H
#define LIMNER_POSE_ANIMATE_H

#include "pose/moment.h"
#include "scene/scene.h"

/* What clips have moved. */
typedef struct animated_state {
    mat4   *locals;      /* per node; NULL: none moves */
    float **weights;     /* per node: its morph weights where they move, else NULL; NULL: none moves */
    float  *weight_data; /* what these point into */
    camera *cameras;     /* as the scene's */
    light  *lights;
} animated_state;

/* Names in cameras and lights are the scene's. Errors: LMN_MEMORY. Release it also after one. */
lmn_status animate(animated_state *out, const lmn_scene *scene, const moment *when, lmn_error *error);
void       animated_state_release(animated_state *s);

#endif
