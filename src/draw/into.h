/* Drawing into a framebuffer of the host's. */
#ifndef LIMNER_DRAW_INTO_H
#define LIMNER_DRAW_INTO_H

#include "draw/session.h"
#include "limner/host.h"

/* See lmn_draw_into; arguments are checked but for what they say, and the description has the target's size. */
lmn_status renderer_draw_into(lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc,
                              const lmn_target *target, lmn_error *error);

#endif
