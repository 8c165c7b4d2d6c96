/* A behaviour as an ordinary animation, so that whatever plays animations plays it. */
#ifndef LIMNER_BEHAVIOUR_CLIP_H
#define LIMNER_BEHAVIOUR_CLIP_H

#include "behaviour/schedule.h"

/* Puts the scene's behaviour into its animation `index`, in place of what that has: for each property a channel of
 * cubic keys, as many as keep it within 1e-6 of the exact values, relative to how far they reach, as far as the single
 * precision of keys allows; what jumps, jumps between neighbouring keys. What moves loses its matrix. Errors: those of
 * schedule_create, LMN_LIMIT (too many keys), LMN_CANCELLED; then the animation is as it was. */
lmn_status behaviour_write_clip(lmn_scene *scene, int32_t index, lmn_error *error);

#endif
