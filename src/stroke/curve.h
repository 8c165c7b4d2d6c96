/* Four-point subdivision of curves (Dyn, Levin, Gregory 1987): finer chains through the points of coarse ones.
 * Freudenberg 2003, section 7.3.3; rows OE-12, OE-13. */
#ifndef LIMNER_STROKE_CURVE_H
#define LIMNER_STROKE_CURVE_H

#include <stdbool.h>
#include <stddef.h>

/* Points after one step: twice as many when closed, one less when open. */
static inline size_t curve_count(size_t count, bool closed)
{
    return closed || count == 0 ? 2 * count : 2 * count - 1;
}

/* One step. A point has `width` numbers, whatever they are: positions in space, positions on the page, with depth or
 * without. Old points stay, between two of them lies 9/16 of each less 1/16 of their outer neighbours; the end of
 * an open chain is its own neighbour. `out` has room for curve_count points. */
void curve_refine(double *out, const double *points, size_t count, size_t width, bool closed);

#endif
