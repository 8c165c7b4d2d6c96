/* Textures of streaks: how a stroke looks from its tail (u = 0) to its head (u = 1). Großmann 2011, section 6.6. */
#ifndef LIMNER_MOTION_STREAK_TEXTURE_H
#define LIMNER_MOTION_STREAK_TEXTURE_H

#include "base/mip_chain.h"

/* Is it the name of a texture, or a picture's path? Errors: LMN_USAGE. */
lmn_status streak_texture_check(const char *name, lmn_error *error);

/* Lightness and opacity of each texel: solid, clear, gradient, each with `-border` too, or a picture from left (tail)
 * to right (head). Errors: LMN_READ, LMN_FORMAT, LMN_LIMIT, LMN_MEMORY. */
lmn_status streak_texture_make(mip_chain *out, const char *name, lmn_error *error);

/* The same for a picture that says where strokes may begin: `checker`, or a path. */
lmn_status streak_mask_check(const char *name, lmn_error *error);
lmn_status streak_mask_make(mip_chain *out, const char *name, lmn_error *error);

#endif
