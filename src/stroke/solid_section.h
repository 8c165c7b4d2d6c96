/* What a section takes away from solids: as many operands more as it has planes. */
#ifndef LIMNER_STROKE_SOLID_SECTION_H
#define LIMNER_STROKE_SOLID_SECTION_H

#include "csg_tree/form.h"
#include "cut/cut.h"

/* What an operand of a form cuts by. */
typedef struct solid_cutter {
    int32_t plane; /* of the cut; NONE: it is one of the solid's own */
    bool    positive;
} solid_cutter;

/* A mesh from which half-spaces are made; its arrays are constant and not owned. */
void solid_half_space(mesh *out, primitive *p);

/* Takes from a solid at a position what the cut takes away, unless it is spared; what lies in that goes all the same.
 * `half_space_mesh`: the number of that mesh. `cutters`: one an operand of the form, those that were added included;
 * free with mem_free. Errors: LMN_MEMORY. */
lmn_status solid_form_cut(solid_form *form, const cut *c, bool spared, const mat4 *world, int32_t half_space_mesh,
                          solid_cutter **cutters, lmn_error *error);

#endif
