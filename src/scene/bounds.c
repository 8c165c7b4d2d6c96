/* World matrices and bounds. */
#include "base/limits.h"
#include "base/memory.h"
#include "scene/mesh.h"
#include "scene/solid.h"

/* Bounds of turned and posed meshes are exact as long as all of a scene's nodes take about this many points;
 * beyond, boxes around boxes do. Otherwise a small file that draws one large mesh a million times would take hours. */
enum { EXACT_POINTS = 1 << 26, EXACT_LEAST = 64 };

static bool is_affordable(const lmn_scene *s, size_t points, size_t draws)
{
    size_t fraction = EXACT_POINTS / s->node_count;
    return points <= (fraction > EXACT_LEAST ? fraction : EXACT_LEAST) / draws;
}

int32_t scene_next_node(const lmn_scene *s, int32_t root, int32_t current)
{
    if (s->nodes[current].first_child != NONE)
        return s->nodes[current].first_child;
    while (current != root && s->nodes[current].next_sibling == NONE)
        current = s->nodes[current].parent;
    return current == root ? NONE : s->nodes[current].next_sibling;
}

static mat4 local_matrix(const lmn_scene *s, const mat4 *locals, size_t index)
{
    return locals ? locals[index] : node_local_matrix(&s->nodes[index]);
}

mat4 *scene_world_matrices(const lmn_scene *s, const mat4 *locals)
{
    size_t bytes;
    mat4  *worlds = size_mul(s->node_count, sizeof *worlds, &bytes) ? mem_alloc(bytes) : NULL;
    if (!worlds)
        return NULL;
    for (size_t i = 0; i < s->node_count; i++) {
        if (s->nodes[i].parent != NONE)
            continue;
        worlds[i] = local_matrix(s, locals, i);
        int32_t root = (int32_t)i;
        for (int32_t n = scene_next_node(s, root, root); n != NONE; n = scene_next_node(s, root, n)) {
            mat4 local = local_matrix(s, locals, (size_t)n);
            worlds[n] = mat4_multiply(&worlds[s->nodes[n].parent], &local);
        }
    }
    return worlds;
}

/* Multiplied from the root on, as above: the same numbers, bit by bit. */
mat4 scene_world_matrix(const lmn_scene *s, int32_t node_index)
{
    int32_t above[LIMIT_NODE_DEPTH + 1];
    size_t  depth = 0;
    for (int32_t i = node_index; i != NONE && depth <= LIMIT_NODE_DEPTH; i = s->nodes[i].parent)
        above[depth++] = i;
    mat4 world = node_local_matrix(&s->nodes[above[--depth]]);
    while (depth-- > 0) {
        mat4 local = node_local_matrix(&s->nodes[above[depth]]);
        world = mat4_multiply(&world, &local);
    }
    return world;
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
    for (size_t i = 0; i < count && m; i++)
        box = box3_with_point(box, mat4_transform_point(m, points[i]));
    for (size_t i = 0; i < count && !m; i++) { /* as box3_with_point, which would be called for each */
        vec3 p = points[i];
        box.min = (vec3){box.min.x < p.x ? box.min.x : p.x, box.min.y < p.y ? box.min.y : p.y,
                         box.min.z < p.z ? box.min.z : p.z};
        box.max = (vec3){box.max.x > p.x ? box.max.x : p.x, box.max.y > p.y ? box.max.y : p.y,
                         box.max.z > p.z ? box.max.z : p.z};
    }
    return box;
}

/* Room for a primitive's vertices, that is there already from pose to pose. */
static bool open_vertices(posed_vertices *v, const primitive *p)
{
    if (!v->positions)
        v->positions = mem_alloc(p->vertex_count * sizeof *v->positions);
    if (!v->normals && p->normals)
        v->normals = mem_alloc(p->vertex_count * sizeof *v->normals);
    return v->positions && (v->normals || !p->normals);
}

/* Poses one primitive in its mesh's space; false when nothing moves it or memory is gone. Normals are turned when the
 * vertices are kept: they cost less along with the positions than later. */
static bool pose_primitive(posed_vertices *out, const primitive *p, const node *n, const mesh *m, const mat4 *joints,
                           size_t joint_count, const float *weights, bool kept)
{
    weights = weights ? weights : n->morph_weights ? n->morph_weights : m->morph_weights;
    size_t weight_count = n->morph_weights ? n->morph_weight_count : m->morph_weight_count;
    if (!joints && (p->morph_count == 0 || weight_count == 0))
        return false;
    if (!kept)
        out->positions = mem_alloc(p->vertex_count * sizeof *out->positions);
    if (kept ? !open_vertices(out, p) : !out->positions)
        return false;
    mesh_pose(p, weights, weight_count, joints, joint_count, kept ? p->normals : NULL, NULL, p->vertex_count,
              out->positions, out->normals);
    out->made = true;
    return true;
}

static mat4 *skin_matrices(const lmn_scene *s, const mat4 *worlds, int32_t skin_index)
{
    /* Without them the part counts as where its node is, which is far off: they may cost more than points. */
    if (skin_index == NONE || !is_affordable(s, s->skins[skin_index].joint_count / 4, 1))
        return NULL;
    const skin *k = &s->skins[skin_index];
    mat4       *joints = mem_alloc(k->joint_count * sizeof *joints);
    for (size_t i = 0; joints && i < k->joint_count; i++)
        joints[i] = mat4_multiply(&worlds[k->joints[i]], &k->inverse_binds[i]);
    return joints;
}

/* A skinned vertex lies between where its joints put it, so the boxes of all joints hold it. */
static box3 joint_boxes(box3 box, const mat4 *joints, size_t joint_count)
{
    box3 out = box3_empty();
    for (size_t i = 0; i < joint_count; i++)
        out = box3_union(out, box3_transform(box, &joints[i]));
    return out;
}

static box3 placed_bounds(const vec3 *points, size_t count, box3 local, const node *n, const mat4 *world, bool exact)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < node_draw_count(n); i++) {
        mat4 placed = n->instance_count ? mat4_multiply(world, &n->instances[i]) : *world;
        if (!exact || keeps_boxes(&placed))
            box = box3_union(box, box3_transform(local, &placed));
        else
            box = box3_union(box, points_bounds(points, count, &placed));
    }
    return box;
}

static box3 primitive_bounds(const lmn_scene *s, const node *n, const primitive *p, const mat4 *world,
                             const mat4 *joints, const float *weights, posed_vertices *keep)
{
    bool   skinned = joints && p->joints && p->weights;
    bool   exact = is_affordable(s, p->vertex_count, node_draw_count(n));
    size_t joint_count = skinned ? s->skins[n->skin].joint_count : 0;
    if (skinned && !exact)
        return joint_boxes(p->bounds, joints, joint_count);
    posed_vertices own = {NULL}, *v = keep ? keep : &own;
    const mesh    *m = &s->meshes[n->mesh];
    bool  moved = exact && pose_primitive(v, p, n, m, skinned ? joints : NULL, joint_count, weights, keep != NULL);
    vec3 *posed = moved ? v->positions : NULL;
    box3  local = posed ? points_bounds(posed, p->vertex_count, NULL) : p->bounds;
    /* Skinned vertices are already in the world: the node's own position does not move them. */
    if (!skinned || !posed)
        local = placed_bounds(posed ? posed : p->positions, p->vertex_count, local, n, world, exact);
    mem_free(own.positions);
    return local;
}

static box3 bounds_at(const lmn_scene *s, const mat4 *worlds, const mat4 *world, int32_t node_index,
                      const float *weights, posed_vertices *keep)
{
    const node *n = &s->nodes[node_index];
    box3        box = box3_empty();
    if (n->solid != NONE)
        return box3_transform(solid_bounds(&s->solids[n->solid]), world);
    if (n->mesh == NONE)
        return box;
    const mesh *m = &s->meshes[n->mesh];
    mat4       *joints = skin_matrices(s, worlds, n->skin);
    for (size_t i = 0; i < m->primitive_count; i++)
        box =
            box3_union(box, primitive_bounds(s, n, &m->primitives[i], world, joints, weights, keep ? &keep[i] : NULL));
    mem_free(joints);
    return box;
}

box3 node_bounds(const lmn_scene *s, const mat4 *worlds, int32_t node_index, const float *weights, posed_vertices *keep)
{
    return bounds_at(s, worlds, &worlds[node_index], node_index, weights, keep);
}

box3 node_bounds_unskinned(const lmn_scene *s, const mat4 *world, int32_t node_index)
{
    return bounds_at(s, NULL, world, node_index, NULL, NULL);
}

box3 part_bounds(const lmn_scene *s, const mat4 *worlds, size_t part_index)
{
    return node_bounds(s, worlds, s->parts[part_index].node, NULL, NULL);
}

box3 scene_bounds(const lmn_scene *s, const mat4 *worlds)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < s->part_count; i++)
        box = box3_union(box, part_bounds(s, worlds, i));
    return box;
}
