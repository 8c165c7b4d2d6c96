/* Creases that are weak by their angle and sure by their shape: the rims of chamfers, of bolts for example. */
#ifndef LIMNER_STROKE_CREASE_RINGS_H
#define LIMNER_STROKE_CREASE_RINGS_H

#include "stroke/edges.h"

/* What is known of an edge so far. */
typedef enum ring_state { RING_NONE, RING_LINE, RING_MAY } ring_state;

/* Edges that may be creases, RING_MAY, become RING_LINE where they go on as one another until they are back or end on
 * lines at both ends, and turn alike all the way. `starts` and `edges`: per vertex, those of the mesh's edges that are
 * not RING_NONE; borders need not be among them. False when memory is gone. */
bool crease_rings_close(const edge_mesh *m, const uint32_t *starts, const uint32_t *edges, uint8_t *states);

#endif
