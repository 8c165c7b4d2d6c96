/* Halftones that draw the shadow on the ground as they draw the model. */
#ifndef LIMNER_SURFACE_ON_GROUND_H
#define LIMNER_SURFACE_ON_GROUND_H

#include "technique/technique.h"

/* surface_row.on_ground of techniques whose values begin with halftone_values: their paper is the page's, so that
 * nothing but strokes is to be seen; and strokes stand for shade. */
bool draws_ground(const void *values, colour ground);

#endif
