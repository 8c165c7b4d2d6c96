/* Meshes bent by a projection. */
#ifndef LIMNER_PLAN_PROJECT_MESH_H
#define LIMNER_PLAN_PROJECT_MESH_H

#include "plan/projection.h"
#include "scene/scene.h"

/* Appends what a primitive, posed so and taken to the world, becomes: the same faces, cut so finely that each piece
 * lies as near to the bent one as the map asks for. Pieces of faces that share an edge share its cuts. Errors:
 * LMN_MEMORY, LMN_LIMIT. */
typedef struct projected_primitive {
    primitive out;
    size_t    vertex_capacity, index_capacity, line_capacity, said_capacity;
    uint32_t *slots; /* open addressing: vertices by what they are */
    size_t    slot_count;
} projected_primitive;

lmn_status project_primitive(projected_primitive *to, const projection_map *m, const primitive *from,
                             const vec3 *positions, const vec3 *normals, const mat4 *world, lmn_error *error);
/* Takes over what was made. */
void project_finish(projected_primitive *p, primitive *out);
void project_release(projected_primitive *p);

#endif
