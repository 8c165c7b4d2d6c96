/* What a scene's unit of length is. */
#ifndef LIMNER_PLAN_UNIT_H
#define LIMNER_PLAN_UNIT_H

#include "base/error.h"
#include "scene/scene.h"

/* Millimetres of a unit; NULL text: what the scene's first file means. `*name` gets the unit's, `*stated` whether
 * anybody says so. Errors: LMN_USAGE. */
lmn_status unit_find(const char *text, const lmn_scene *scene, double *mm, const char **name, bool *stated,
                     lmn_error *error);

#endif
