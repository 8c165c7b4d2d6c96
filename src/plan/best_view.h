/* From where a scene shows most: a view for those who do not say one. */
#ifndef LIMNER_PLAN_BEST_VIEW_H
#define LIMNER_PLAN_BEST_VIEW_H

#include "limner/draw.h"
#include "scene/scene.h"

/* Points a description at where the scene shows most of the parts that it selects, at the time that it says: eye,
 * target and up, fitted by direction. Fills of parts are not looked at, so that all looks are drawn from one place.
 * Errors: LMN_USAGE (select, clip), LMN_MEMORY, LMN_CANCELLED. */
lmn_status best_view_find(lmn_draw_desc *desc, const lmn_scene *scene, lmn_error *error);

#endif
