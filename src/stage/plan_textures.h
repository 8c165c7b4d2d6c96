/* The made textures of a plan: of its figures' surfaces and perturbations, and of its sheet. */
#ifndef LIMNER_STAGE_PLAN_TEXTURES_H
#define LIMNER_STAGE_PLAN_TEXTURES_H

#include "plan/plan.h"
#include "stage/made_textures.h"

/* figure.textures of the plan points at these. */
struct figure_textures {
    used_textures  surface, perturb, motion;
    used_textures *by_material; /* those of the surface, one a material of the scene, where these differ; else NULL */
};

typedef struct plan_textures {
    struct figure_textures *figures; /* one a figure */
    size_t                  count;
    used_textures           sheet; /* none unless it is asked for */
} plan_textures;

/* Finds or makes them and gives the plan's figures theirs. `with_sheet`: pages are drawn, not maps. Errors: those
 * of the techniques, and the GPU's. Release it also after one, and after the plan. */
lmn_status plan_textures_make(plan_textures *out, made_textures *all, gpu *g, plan *p, bool with_sheet,
                              warnings *warnings, lmn_error *error);
void       plan_textures_release(plan_textures *t);

#endif
