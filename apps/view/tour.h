/* A presentation that runs by itself until somebody takes over, and goes on when nobody has done anything for a while:
 * the model turns, and look follows look. Freudenberg 2003, section 9.1.3. */
#ifndef LIMNER_VIEW_TOUR_H
#define LIMNER_VIEW_TOUR_H

#include "document.h"

typedef struct tour tour;

tour *tour_make(document *d);
void  tour_free(tour *t); /* NULL is accepted */

/* Begins or ends it. */
void tour_run(tour *t, bool runs);

/* Somebody did something: it stands still at once. */
void tour_interrupt(tour *t);

#endif
