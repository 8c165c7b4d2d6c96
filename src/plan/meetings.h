/* Where a figure's parts may run through those of others. */
#ifndef LIMNER_PLAN_MEETINGS_H
#define LIMNER_PLAN_MEETINGS_H

#include "plan/plan.h"

/* Sets in `parts`, one flag a part, all false before: the opaque parts of other rules whose boxes overlap that of a
 * part of the figure. `any`: there are some. Ghosts count for neither. False: out of memory. */
bool plan_find_meetings(const plan *p, const figure *f, bool *parts, bool *any);

#endif
