/* A scene as a look with scene.round draws it: coarse meshes are as curved as their normals say (scene/round.h). */
#ifndef LIMNER_PLAN_ROUND_SCENE_H
#define LIMNER_PLAN_ROUND_SCENE_H

#include "look/look.h"
#include "scene/scene.h"

/* Meshes that were made, kept from drawing to drawing. Zero-initialise; ends with round_scene_release. */
typedef struct round_scene {
    lmn_scene          scene; /* the last one, with round meshes instead of coarse ones; all else is borrowed */
    uint64_t           identity, revision;
    double             crease_angle;
    bool               forms;  /* alone */
    struct round_mesh *meshes; /* one for each of the scene */
    size_t             count, room;
} round_scene;

/* `out` is what is drawn of the scene with this look: the scene itself, or r->scene, valid until the next call and as
 * long as the scene is as it was. One thread at a time. Errors: LMN_MEMORY, LMN_CANCELLED, LMN_LIMIT. */
lmn_status round_scene_find(const lmn_scene **out, round_scene *r, const lmn_scene *scene, const lmn_look *look,
                            lmn_error *error);
void       round_scene_release(round_scene *r);

#endif
