/* Copies of scenes, bent by a projection. */
#ifndef LIMNER_PLAN_PROJECT_SCENE_H
#define LIMNER_PLAN_PROJECT_SCENE_H

#include "base/error.h"
#include "limner/projection.h"

/* See limner/projection.h; what is given is complete. */
lmn_status project_scene(lmn_scene **out, const lmn_scene *scene, lmn_draw_desc *desc, const lmn_projection_desc *how,
                         lmn_error *error);

#endif
