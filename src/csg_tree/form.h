/* A solid's tree brought into the form that drawing evaluates: unions and intersections in turn, with operands of
 * an intersection possibly taken away (negated); nothing empty, nothing with one operand, and without what cannot
 * matter because boxes do not touch (geometric pruning). Goldfeather et al. 1989; Nienhaus et al. 2006, section 2;
 * rows K01, C2. */
#ifndef LIMNER_CSG_TREE_FORM_H
#define LIMNER_CSG_TREE_FORM_H

#include "scene/solid.h"

typedef enum term_kind { TERM_OPERAND, TERM_OR, TERM_AND } term_kind;

/* One term. Only operands of an AND are negated, and the first never is. */
typedef struct term {
    term_kind kind;
    bool      negated;
    int32_t   operand;           /* of TERM_OPERAND: in `operands` */
    int32_t   first, last, next; /* children and siblings; NONE */
    size_t    count;             /* of children */
    box3      box;               /* where it can be, solid's space */
} term;

typedef struct solid_form {
    solid_operand *operands; /* all that have triangles, in the order of the tree; pruned ones too */
    size_t         operand_count;
    term          *terms;
    size_t         term_count, term_capacity;
    int32_t        root; /* NONE: the solid is empty */
} solid_form;

/* Errors: LMN_MEMORY. Without `prune` only what is empty by itself is left out. */
lmn_status solid_form_create(solid_form *out, const solid *s, bool prune, lmn_error *error);
/* Takes the common part of `count` more operands away from the whole. They are numbered on from operand_count.
 * Errors: LMN_MEMORY. */
lmn_status solid_form_take_away(solid_form *f, const solid_operand *operands, size_t count, lmn_error *error);
/* Leaves out what boxes say cannot matter. */
void solid_form_prune(solid_form *f);
void solid_form_release(solid_form *f);
/* The operands that are left, in order; `out` has room for operand_count. Returns how many. */
size_t solid_form_used(const solid_form *f, int32_t *out);

#endif
