/* Behaviours that a program makes and changes: what cannot be laid out is refused, and all stays as it was. */
#ifndef LIMNER_BEHAVIOUR_CHANGE_H
#define LIMNER_BEHAVIOUR_CHANGE_H

#include "scene/behaviour.h"

/* Appends an activity (`index` NONE), or exchanges one, and takes it over; *out (may be NULL) gets its index. Where
 * something plays already it is laid out and written anew. Errors: as of behaviour_check and behaviour_write_clip; then
 * it is the caller's. */
lmn_status behaviour_put(lmn_scene *scene, int32_t index, const behaviour_node *wanted, int32_t *out, lmn_error *error);

/* Exchanges the roots, of which there is one at least, and writes the animation "behaviour", which is made where there
 * is none. Errors: as above. */
lmn_status behaviour_play(lmn_scene *scene, const int32_t *roots, size_t count, lmn_error *error);

/* Nothing is a root any longer, and the animation that was written is taken out of the scene. */
void behaviour_stop(lmn_scene *scene);

#endif
