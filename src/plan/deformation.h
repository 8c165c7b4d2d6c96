/* How a look deforms what moves, part by part. */
#ifndef LIMNER_PLAN_DEFORMATION_H
#define LIMNER_PLAN_DEFORMATION_H

#include "look/look.h"
#include "pose/moment.h"
#include "pose/pose.h"

/* Replaces `kept` (zero-initialised at first) unless it is the same, and makes the moment ask for it, or for none.
 * Errors: LMN_MEMORY. */
lmn_status deformation_find(pose_deformation *kept, moment *when, const lmn_scene *scene, const lmn_look *look,
                            lmn_error *error);

#endif
