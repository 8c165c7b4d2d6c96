/* Edge meshes refined when they are made, and the outlines of refined meshes. Freudenberg 2003, section 7.3. */
#ifndef LIMNER_STROKE_BUTTERFLY_MESH_H
#define LIMNER_STROKE_BUTTERFLY_MESH_H

#include "stroke/butterfly.h"
#include "stroke/edges.h"
#include "stroke/propagate.h"

/* How an edge mesh came from a coarser one. The mesh has the vertices of the last level, by the same numbers. */
typedef struct edge_refinement {
    butterfly surface;
    uint32_t
        *faces; /* per face of the last level: its number in the mesh; EDGE_NO_FACE: it has no area and is not there */
    uint32_t *
        edges; /* per half-edge of the last level: its number in the mesh's edges; BUTTERFLY_NONE: it is none of them */
} edge_refinement;
void edge_refinement_destroy(edge_refinement **r);

/* Refines a mesh that is not refined yet `steps` times. Creases, borders and edges that the file
 * says are hard stay sharp; what was hidden stays hidden; materials stay. Errors: LMN_MEMORY, LMN_LIMIT; the mesh is
 * then as it was. */
lmn_status edge_mesh_refine(edge_mesh *m, int steps, lmn_error *error);

/* Marks (1 per edge of the mesh) those that the silhouette runs along, found by propagation. `is_front` as for
 * silhouette_propagate; `tested` (may be NULL) gets how many faces were asked for, all levels together. Errors:
 * LMN_MEMORY. */
lmn_status edge_mesh_silhouette(const edge_mesh *m, propagate_front is_front, void *user, uint8_t *marks,
                                uint64_t *tested, lmn_error *error);

#endif
