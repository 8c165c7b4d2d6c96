/* How something turns on its own, apart from what it hangs on. */
#ifndef LIMNER_DEPICT_TURNING_H
#define LIMNER_DEPICT_TURNING_H

#include "depict/depict_private.h"

typedef struct turning {
    double axis[3], pivot[3]; /* world; the thumb of a right hand whose fingers show the sense */
    double angle;             /* from begin to end, whole turns too; not below 0 */
    double until;             /* the part of it up to `now` */
} turning;

/* What the last rotation on a way does between two times, as far as it does not turn back around `now`; angle 0:
 * nothing turns it. */
void turning_find(turning *out, const way *w, double from, double to, double now);

#endif
