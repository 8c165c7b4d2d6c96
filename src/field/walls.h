/* Walls: upright faces of a mesh, unrolled, so that facades can be laid out on buildings that have neither texture
 * coordinates nor pictures. Nienhaus 2005, section 4.8 (sets of texture coordinates for each building, made before
 * it is drawn); row C07. */
#ifndef LIMNER_FIELD_WALLS_H
#define LIMNER_FIELD_WALLS_H

#include "base/error.h"
#include "scene/mesh.h"

/* The same triangles in the same order, with vertices of their own for each wall. A wall is a run of upright triangles
 * that share edges and turn no more than WALL_TURN from one to the next, so that a round tower is one wall. Per
 * vertex, where it lies on its wall: `at` from the left end (0) to the right one (1), seen from outside, and from the
 * base (0) to the eaves (1), above 1 in gables; `extent` the wall's length and the height of its eaves over the base
 * in the world's unit, both 0 where there is no wall. Eaves are the lowest place of the wall's upper rim. */
typedef struct wall_mesh {
    uint32_t  vertex_count, index_count, wall_count;
    uint32_t *source; /* per vertex: the primitive's vertex */
    float (*at)[2], (*extent)[2];
    uint32_t *indices;
} wall_mesh;

#define WALL_TURN 0.6 /* radians */

/* `world` takes the primitive into the world, in which axis `up` (1 or 2) points up; `base`: height there from which
 * storeys are counted. Errors: LMN_MEMORY. Release it also after one. */
lmn_status wall_mesh_make(wall_mesh *out, const primitive *p, const mat4 *world, int up, double base, lmn_error *error);
void       wall_mesh_release(wall_mesh *m);

#endif
