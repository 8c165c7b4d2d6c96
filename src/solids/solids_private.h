/* What the ways of evaluation share. */
#ifndef LIMNER_SOLIDS_SOLIDS_PRIVATE_H
#define LIMNER_SOLIDS_SOLIDS_PRIVATE_H

#include "solids/solids.h"
#include "stage/view.h"

/* --- bind.c --- */
/* Uniforms of csg/operand.vert and csg/operand.glsl for one item. */
void solids_set_operands(const solid_view *v, const solid_layers *s, const draw_item *item);

/* --- sweep.c: any solids on any GL --- */
/* The nearest surfaces, among those of convex products where there are any, or all layers at once. `inside`: the
 * eye may be in an operand. False when the normal form is too large. */
bool solids_sweep(const solid_view *v, solid_layers *s, const bool *wanted, bool inside, int layers);

/* --- convex.c: products of convex operands --- */
/* Is there anything of that kind, and is it all? */
bool solids_have_convex(const solid_view *v, const bool *wanted, bool *all);
/* The nearest surfaces into the current picture; returns their depth, which the caller gives back. */
gpu_texture *solids_draw_convex(const solid_view *v, solid_layers *s, const bool *wanted);

#endif
