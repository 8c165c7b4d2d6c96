/* Changing a look: all or nothing, and what of a drawing a change concerns. */
#ifndef LIMNER_LOOK_LOOK_CHANGE_H
#define LIMNER_LOOK_LOOK_CHANGE_H

#include "look/look.h"

/* Gives the look a new revision with these changes, lmn_look_change or-ed; 0: none. */
void     look_mark_changed(lmn_look *look, unsigned changes);
unsigned look_changes(const lmn_look *look, uint64_t since);

/* Keeps what the look is now. Errors: LMN_MEMORY. */
lmn_status look_edit_begin(lmn_look **before, const lmn_look *look, lmn_error *error);
/* After a failure the look is again what it was; else its revision follows from what has changed. Ends *before and
 * returns the status. */
lmn_status look_edit_end(lmn_look *look, lmn_look **before, lmn_status status);

/* What another set of values asks of the next drawing; 0: they are the same. */
unsigned use_changes(const kind *k, const technique_use *before, const technique_use *after);

/* Can some change of this parameter make other programs, whatever the values? */
bool param_compiles(const param *p);

#endif
