/* A look whose lengths on paper have become pixels of one drawing. */
#ifndef LIMNER_PLAN_PAPER_LOOK_H
#define LIMNER_PLAN_PAPER_LOOK_H

#include "look/look.h"

/* Copies a rule's uses, with all lengths, points, in pixels; selector and names stay those of `from`. False when memory
 * is gone; end it with paper_rule_release either way. */
bool paper_rule_create(rule *out, const rule *from);
void paper_rule_release(rule *r);

/* The same for all of a look, whose selectors and names it borrows. NULL when memory is gone. */
lmn_look *paper_look_create(const lmn_look *look, double pixels_per_point);
void      paper_look_destroy(lmn_look **look);

#endif
