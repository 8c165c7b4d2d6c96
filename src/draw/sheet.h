/* Sheets: vector drawings with the renderer's pictures below their lines. */
#ifndef LIMNER_DRAW_SHEET_H
#define LIMNER_DRAW_SHEET_H

#include "draw/drawing.h"
#include "vector/vector.h"

/* See lmn_draw_sheet; arguments are checked but for what they say. */
lmn_status sheet_draw(lmn_sheet **out, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                      const lmn_draw_desc *desc, const lmn_sheet_desc *wanted, lmn_error *error);

#endif
