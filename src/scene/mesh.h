/* What is derived from a primitive: welded vertices, adjacency, normals by crease angle, skinned positions. */
#ifndef LIMNER_SCENE_MESH_H
#define LIMNER_SCENE_MESH_H

#include "scene/scene.h"

/* Merges vertices whose positions are equal (−0 = +0) and rewrites indices; for files without sharing, such as STL.
 * Only positions may be present. Indices may be NULL: each three vertices are a triangle. Order of first appearance is
 * kept. Errors: LMN_MEMORY. */
lmn_status mesh_weld_positions(primitive *p, lmn_error *error);

/* For each vertex the first vertex at the same position: vertex_count entries, free with mem_free; NULL = memory
 * gone. */
uint32_t *mesh_position_ids(const primitive *p);
/* How near vertices lie that were one before they were rounded: a fraction of their box. */
double mesh_near(const vec3 *positions, size_t count);
/* Makes vertices one that lie so near each other, where ids[v] is the first vertex at v's position: it is the first one
 * near it then. False when memory is gone. */
bool mesh_weld_near(const vec3 *positions, uint32_t *ids, size_t count, double tolerance);

/* Adjacency by position: for each of the index_count half-edges (corner k of a triangle to its next corner) the
 * half-edge on the other side, or UINT32_MAX at a border; edges of more than two triangles pair the first with the
 * second and so on. Free with mem_free; NULL when memory is gone. */
uint32_t *mesh_adjacency(const primitive *p);

/* Is the mesh closed, in one piece, and every point on or behind every face? Large meshes (4 million pairs of
 * points and faces) count as not convex. */
bool mesh_is_convex(const mesh *m);

/* Vertices ready to be drawn: those of the primitive, split where neighbouring faces meet at more than the crease
 * angle. `source` maps each vertex to the primitive's vertex. Owned by the caller, end with
 * render_vertices_release. */
typedef struct render_vertices {
    uint32_t  vertex_count, index_count;
    uint32_t *source;  /* NULL: identity */
    vec3     *normals; /* unit, outward by winding */
    uint32_t *indices; /* NULL: the primitive's own */
} render_vertices;

/* Corners of triangles by position. Zero-initialised: not made yet. */
typedef struct corner_groups {
    uint32_t *ids;              /* per vertex: the first one at its position, which is its group's number */
    uint32_t *starts, *corners; /* group g is corners[starts[g]] … corners[starts[g + 1] − 1] */
} corner_groups;
lmn_status corner_groups_make(corner_groups *out, const primitive *p, lmn_error *error);
void       corner_groups_release(corner_groups *g);
/* Are vertices that were in one position still? */
bool corner_groups_hold(const corner_groups *g, const primitive *p);

/* Makes normals: at each corner the area-weighted mean of the faces around the position whose normals are within
 * crease_angle (radians) of the corner's own face. Errors: LMN_MEMORY. */
lmn_status mesh_make_normals(render_vertices *out, const primitive *p, double crease_angle, lmn_error *error);
/* The same with groups that are known. */
lmn_status mesh_make_normals_in(render_vertices *out, const primitive *p, const corner_groups *groups,
                                double crease_angle, lmn_error *error);
void       render_vertices_release(render_vertices *v);

/* Positions (and normals, may be NULL in and out) of a primitive in its node's pose: morphs with `weights`, then
 * the skin's joint matrices (already world · inverse bind); joint_matrices NULL = no skin. Arrays hold vertex_count
 * elements. */
void mesh_pose(const primitive *p, const float *weights, size_t weight_count, const mat4 *joint_matrices,
               size_t joint_count, const vec3 *normals, const uint32_t *source, uint32_t count, vec3 *out_positions,
               vec3 *out_normals);

#endif
