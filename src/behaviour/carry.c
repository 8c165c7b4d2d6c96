#include "behaviour/carry.h"

#include "base/vector3.h"

/* How much of vertex `i` follows a joint. */
static float weight_of(const primitive *p, uint32_t i, size_t joint)
{
    float sum = 0;
    for (uint32_t k = 0; k < p->influences; k++)
        if (p->joints[i * (size_t)p->influences + k] == joint)
            sum += p->weights[i * (size_t)p->influences + k];
    return sum;
}

/* Each vertex that a joint of a skin carries, until `seen` is content; true when it is. */
static bool walk_part(const lmn_scene *scene, const node *n, size_t joint, float least,
                      bool (*seen)(const vec3 *at, void *user), void *user)
{
    const mesh *m = n->mesh == NONE ? NULL : &scene->meshes[n->mesh];
    for (size_t i = 0; m && i < m->primitive_count; i++) {
        const primitive *p = &m->primitives[i];
        for (uint32_t v = 0; p->joints && p->weights && v < p->vertex_count; v++)
            if (weight_of(p, v, joint) > least && seen(&p->positions[v], user))
                return true;
    }
    return false;
}

static bool any_vertex(const vec3 *at, void *user)
{
    (void)at;
    (void)user;
    return true;
}

/* Which joint of a skin a node is; the count of joints: none. */
static size_t joint_of(const skin *s, int32_t node_index)
{
    size_t i = 0;
    while (i < s->joint_count && s->joints[i] != node_index)
        i++;
    return i;
}

/* Does a node go with another one as if they were one? */
static bool goes_along(const lmn_scene *scene, int32_t node_index, int32_t with, const bool *moved)
{
    while (node_index != with) {
        if (node_index == NONE || !moved || moved[node_index])
            return false;
        node_index = scene->nodes[node_index].parent;
    }
    return true;
}

bool node_carries(const lmn_scene *scene, int32_t node_index, const bool *moved)
{
    for (size_t i = 0; i < scene->part_count; i++) {
        const node *n = &scene->nodes[scene->parts[i].node];
        if (n->skin == NONE) {
            if (goes_along(scene, scene->parts[i].node, node_index, moved))
                return true;
            continue;
        }
        const skin  *s = &scene->skins[n->skin];
        const size_t joint = joint_of(s, node_index);
        if (joint < s->joint_count && walk_part(scene, n, joint, 0.05f, any_vertex, NULL))
            return true;
    }
    return false;
}

typedef struct tip {
    const mat4 *to_node;
    double      far, at[3];
} tip;

static bool take_farthest(const vec3 *at, void *user)
{
    tip         *t = user;
    const vec3   moved = t->to_node ? mat4_transform_point(t->to_node, *at) : *at;
    const double p[3] = {(double)moved.x, (double)moved.y, (double)moved.z}, far = vector3_length(p);
    if (far > t->far) {
        t->far = far;
        vector3_copy(t->at, p);
    }
    return false;
}

/* Of a part that goes with the node. */
static void take_part(tip *found, const lmn_scene *scene, int32_t part_node, int32_t node_index)
{
    const mesh *m = scene->nodes[part_node].mesh == NONE ? NULL : &scene->meshes[scene->nodes[part_node].mesh];
    mat4        to_node = mat4_identity();
    for (int32_t n = part_node; n != node_index; n = scene->nodes[n].parent) {
        const mat4 local = node_local_matrix(&scene->nodes[n]);
        to_node = mat4_multiply(&local, &to_node);
    }
    found->to_node = &to_node;
    for (size_t i = 0; m && i < m->primitive_count; i++)
        for (uint32_t v = 0; v < m->primitives[i].vertex_count; v++)
            take_farthest(&m->primitives[i].positions[v], found);
    found->to_node = NULL;
}

void node_tip(const lmn_scene *scene, int32_t node_index, const bool *moved, double out[3])
{
    tip found = {NULL, 0, {0, 0, 0}};
    for (size_t i = 0; i < scene->part_count; i++) {
        const node *n = &scene->nodes[scene->parts[i].node];
        const skin *s = n->skin == NONE ? NULL : &scene->skins[n->skin];
        if (!s && goes_along(scene, scene->parts[i].node, node_index, moved))
            take_part(&found, scene, scene->parts[i].node, node_index);
        const size_t joint = s ? joint_of(s, node_index) : 0;
        if (!s || joint == s->joint_count)
            continue;
        found.to_node = &s->inverse_binds[joint];
        walk_part(scene, n, joint, 0.5f, take_farthest, &found);
    }
    vector3_copy(out, found.at);
}
