/* World matrices and bounds. */
#include <math.h>

#include "base/memory.h"
#include "scene/mesh.h"
#include "scene/scene.h"

/* Up to this many vertices times instances the bounds of turned meshes are exact; beyond, boxes of boxes do. */
enum { EXACT_POINTS_MAX = 1 << 23 };

int32_t scene_next_node(const lmn_scene *s, int32_t root, int32_t current)
{
    if (s->nodes[current].first_child != NONE)
        return s->nodes[current].first_child;
    while (current != root && s->nodes[current].next_sibling == NONE)
        current = s->nodes[current].parent;
    return current == root ? NONE : s->nodes[current].next_sibling;
}

mat4 *scene_world_matrices(const lmn_scene *s)
{
    size_t bytes;
    mat4 *worlds = size_mul(s->node_count, sizeof *worlds, &bytes) ? mem_alloc(bytes) : NULL;
    if (!worlds)
        return NULL;
    for (size_t i = 0; i < s->node_count; i++) {
        if (s->nodes[i].parent != NONE)
            continue;
        worlds[i] = node_local_matrix(&s->nodes[i]);
        int32_t root = (int32_t)i;
        for (int32_t n = scene_next_node(s, root, root); n != NONE; n = scene_next_node(s, root, n)) {
            mat4 local = node_local_matrix(&s->nodes[n]);
            worlds[n] = mat4_multiply(&worlds[s->nodes[n].parent], &local);
        }
    }
    return worlds;
}

/* Does the matrix send boxes to boxes: one entry at most in each row? */
static bool keeps_boxes(const mat4 *m)
{
    for (int row = 0; row < 3; row++)
        if ((m->m[row] != 0) + (m->m[4 + row] != 0) + (m->m[8 + row] != 0) > 1)
            return false;
    return true;
}

static box3 points_bounds(const vec3 *points, size_t count, const mat4 *m)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < count; i++)
        box = box3_with_point(box, m ? mat4_transform_point(m, points[i]) : points[i]);
    return box;
}

/* The pose of one primitive in its mesh's space; NULL when nothing moves it or memory is gone. */
static vec3 *posed_positions(const primitive *p, const node *n, const mesh *m, const mat4 *joints, size_t joint_count)
{
    const float *weights = n->morph_weights ? n->morph_weights : m->morph_weights;
    size_t weight_count = n->morph_weights ? n->morph_weight_count : m->morph_weight_count;
    if (!joints && (p->morph_count == 0 || weight_count == 0))
        return NULL;
    vec3 *posed = mem_alloc(p->vertex_count * sizeof *posed);
    if (posed)
        mesh_pose(p, weights, weight_count, joints, joint_count, NULL, NULL, p->vertex_count, posed, NULL);
    return posed;
}

static mat4 *skin_matrices(const lmn_scene *s, const mat4 *worlds, int32_t skin_index)
{
    if (skin_index == NONE)
        return NULL;
    const skin *k = &s->skins[skin_index];
    mat4 *joints = mem_alloc(k->joint_count * sizeof *joints);
    for (size_t i = 0; joints && i < k->joint_count; i++)
        joints[i] = mat4_multiply(&worlds[k->joints[i]], &k->inverse_binds[i]);
    return joints;
}

static box3 placed_bounds(const primitive *p, const vec3 *posed, const node *n, const mat4 *world)
{
    const vec3 *points = posed ? posed : p->positions;
    box3 local = posed ? points_bounds(posed, p->vertex_count, NULL) : p->bounds;
    size_t draws = node_draw_count(n);
    bool affordable = p->vertex_count <= EXACT_POINTS_MAX / draws;
    box3 box = box3_empty();
    for (size_t i = 0; i < draws; i++) {
        mat4 placed = n->instance_count ? mat4_multiply(world, &n->instances[i]) : *world;
        if (!affordable || keeps_boxes(&placed))
            box = box3_union(box, box3_transform(local, &placed));
        else
            box = box3_union(box, points_bounds(points, p->vertex_count, &placed));
    }
    return box;
}

box3 node_bounds(const lmn_scene *s, const mat4 *worlds, int32_t node_index)
{
    const node *n = &s->nodes[node_index];
    box3 box = box3_empty();
    if (n->mesh == NONE)
        return box;
    const mesh *m = &s->meshes[n->mesh];
    mat4 *joints = skin_matrices(s, worlds, n->skin);
    mat4 none = mat4_identity();
    for (size_t i = 0; i < m->primitive_count; i++) {
        const primitive *p = &m->primitives[i];
        const mat4 *own_joints = p->joints && p->weights ? joints : NULL;
        size_t joint_count = own_joints ? s->skins[n->skin].joint_count : 0;
        vec3 *posed = posed_positions(p, n, m, own_joints, joint_count);
        /* Skinned vertices are already in the world: the node's own place does not move them. */
        box = box3_union(box, placed_bounds(p, posed, n, own_joints && posed ? &none : &worlds[node_index]));
        mem_free(posed);
    }
    mem_free(joints);
    return box;
}

box3 part_bounds(const lmn_scene *s, const mat4 *worlds, size_t part_index)
{
    return node_bounds(s, worlds, s->parts[part_index].node);
}

box3 scene_bounds(const lmn_scene *s, const mat4 *worlds)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < s->part_count; i++)
        box = box3_union(box, part_bounds(s, worlds, i));
    return box;
}
