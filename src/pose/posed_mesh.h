/* A mesh as it is drawn: split where the crease angle asks for it, and deformed. */
#ifndef LIMNER_POSE_POSED_MESH_H
#define LIMNER_POSE_POSED_MESH_H

#include "pose/pose.h"
#include "scene/mesh.h"

/* What is read of a mesh, vertex by vertex. NULL: it has none. */
typedef struct vertex_arrays {
    uint32_t        vertex_count, index_count;
    const float    *positions, *normals, *uvs[UV_SETS], *colours;
    const uint32_t *indices;
} vertex_arrays;

/* `data` points into the rest, into the primitive and into what the pose keeps. */
typedef struct posed_mesh {
    vertex_arrays   data;
    render_vertices split;
    vec3           *positions, *normals;
    vec2           *uvs[UV_SETS];
    vec4           *colours;
} posed_mesh;

/* `crease_angle` in radians. A mesh without normals has those that its triangles have in the pose, and creases there.
 * Errors: LMN_MEMORY, those of mesh_make_normals. */
lmn_status posed_make(posed_mesh *out, const primitive *p, double crease_angle, const part_pose *pose,
                      lmn_error *error);
/* The same. Which corners are in one position at rest is kept for the next pose (`kept`: zero-initialised at first,
 * ended with corner_groups_release; may be NULL). */
lmn_status posed_make_keeping(posed_mesh *out, const primitive *p, double crease_angle, const part_pose *pose,
                              corner_groups *kept, lmn_error *error);
void       posed_release(posed_mesh *m);

/* Where the vertices of a mesh that was made are in another pose; free with mem_free. NULL when memory is gone. */
vec3 *posed_positions(const primitive *p, const part_pose *pose, const render_vertices *split);

/* Elements of `size` bytes in the order of a map; NULL when there are none (a NULL source) or memory is gone. The
 * caller frees it. */
void *posed_gather(const void *source, const uint32_t *map, uint32_t count, size_t size);

#endif
