/* Inside the construct folder: work of the geometry libraries that may take very long runs behind the fence, where
 * it can be stopped at any moment. What is small runs here: starting the child would take longer. */
#ifndef LIMNER_CONSTRUCT_FENCED_H
#define LIMNER_CONSTRUCT_FENCED_H

#include "construct/construct.h"
#include "fence/fence.h"

/* Points in the plane from which on everything may cross everything, often enough to be felt; points of a hull. */
enum { FENCED_PLANE_POINTS = 500, FENCED_HULL_POINTS = 20000 };

/* Contours as they are; false from region_take: the bytes end, or memory is gone. Release also after a failure. */
void region_put(fence_bytes *to, const contour *contours, size_t count);
bool region_take(region *out, fence_reader *r);

#endif
