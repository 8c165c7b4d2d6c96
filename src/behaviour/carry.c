#include "behaviour/carry.h"

#include "base/vector3.h"

/* Less of a vertex cannot be seen to follow a joint. */
static const float WEIGHT_SEEN = 0.05f;

static bool skin_follows(const lmn_scene *scene, const node *n, size_t joint)
{
    const mesh *m = n->mesh == NONE ? NULL : &scene->meshes[n->mesh];
    for (size_t i = 0; m && i < m->primitive_count; i++) {
        const primitive *p = &m->primitives[i];
        for (size_t k = 0; p->joints && p->weights && k < (size_t)p->vertex_count * p->influences; k++)
            if (p->joints[k] == joint && p->weights[k] > WEIGHT_SEEN)
                return true;
    }
    return false;
}

/* Which joint of a skin a node is; the count of joints: none. */
static size_t joint_of(const skin *s, int32_t node_index)
{
    size_t i = 0;
    while (i < s->joint_count && s->joints[i] != node_index)
        i++;
    return i;
}

bool node_carries(const lmn_scene *scene, int32_t node_index)
{
    for (size_t i = 0; i < scene->part_count; i++) {
        const node *n = &scene->nodes[scene->parts[i].node];
        const skin *s = n->skin == NONE ? NULL : &scene->skins[n->skin];
        if (!s && scene->parts[i].node == node_index)
            return true;
        const size_t joint = s ? joint_of(s, node_index) : 0;
        if (s && joint < s->joint_count && skin_follows(scene, n, joint))
            return true;
    }
    return false;
}

static void take_farthest(double out[3], const vec3 *at)
{
    const double p[3] = {(double)at->x, (double)at->y, (double)at->z};
    if (vector3_dot(p, p) > vector3_dot(out, out))
        vector3_copy(out, p);
}

/* A part goes with the first node on its way up that moves by itself. */
static void take_part(double (*tips)[3], bool *carried, const lmn_scene *scene, int32_t part_node, const bool *moved)
{
    const mesh *m = scene->nodes[part_node].mesh == NONE ? NULL : &scene->meshes[scene->nodes[part_node].mesh];
    mat4        to_node = mat4_identity();
    int32_t     with = part_node;
    for (; with != NONE && !moved[with]; with = scene->nodes[with].parent) {
        const mat4 local = node_local_matrix(&scene->nodes[with]);
        to_node = mat4_multiply(&local, &to_node);
    }
    if (with == NONE)
        return;
    carried[with] = true;
    for (size_t i = 0; m && i < m->primitive_count; i++)
        for (uint32_t v = 0; v < m->primitives[i].vertex_count; v++) {
            const vec3 at = mat4_transform_point(&to_node, m->primitives[i].positions[v]);
            take_farthest(tips[with], &at);
        }
}

static void take_skin(double (*tips)[3], bool *carried, const skin *s, const primitive *p)
{
    for (size_t i = 0; p->joints && p->weights && i < (size_t)p->vertex_count * p->influences; i++) {
        if (p->weights[i] <= WEIGHT_SEEN || p->joints[i] >= s->joint_count)
            continue;
        const int32_t joint = s->joints[p->joints[i]];
        carried[joint] = true;
        if (p->weights[i] > 0.5f) {
            const vec3 at = mat4_transform_point(&s->inverse_binds[p->joints[i]], p->positions[i / p->influences]);
            take_farthest(tips[joint], &at);
        }
    }
}

void node_tips(double (*tips)[3], bool *carried, const lmn_scene *scene, const bool *moved)
{
    for (size_t i = 0; i < scene->part_count; i++) {
        const node *n = &scene->nodes[scene->parts[i].node];
        const mesh *m = n->mesh == NONE ? NULL : &scene->meshes[n->mesh];
        if (n->skin == NONE)
            take_part(tips, carried, scene, scene->parts[i].node, moved);
        for (size_t k = 0; n->skin != NONE && m && k < m->primitive_count; k++)
            take_skin(tips, carried, &scene->skins[n->skin], &m->primitives[k]);
    }
}
