/* Outlines in the plane to triangles. */
#ifndef LIMNER_CONSTRUCT_TRIANGULATE_H
#define LIMNER_CONSTRUCT_TRIANGULATE_H

#include "construct/construct.h"

/* Triangulates outlines in the plane by their winding (GLU): anticlockwise ones enclose, clockwise ones leave out.
 * The triangles' corners are the numbers of the points, counted through all contours. No corner is added: *exact is
 * false where edges cross or touch and the triangles' border is not the contours; of numbers that are not finite there
 * is none. Three corners a triangle in *corners, which the caller frees. */
lmn_status contours_triangulate(const contour *contours, size_t count, uint32_t **corners, size_t *corner_count,
                                bool *exact, lmn_error *error);

#endif
