#include "pose/pose.h"

#include <string.h>

#include "base/memory.h"

static const skin *skin_of(const lmn_scene *scene, size_t part_index)
{
    const node *n = &scene->nodes[scene->parts[part_index].node];
    return n->mesh != NONE && n->skin != NONE ? &scene->skins[n->skin] : NULL;
}

static size_t count_joints(const lmn_scene *scene)
{
    size_t count = 0;
    for (size_t i = 0; i < scene->part_count; i++)
        count += skin_of(scene, i) ? skin_of(scene, i)->joint_count : 0;
    return count;
}

/* World · inverse bind, one a joint. */
static void set_joints(mat4 *out, const mat4 *worlds, const skin *s)
{
    for (size_t i = 0; i < s->joint_count; i++)
        out[i] = s->inverse_binds ? mat4_multiply(&worlds[s->joints[i]], &s->inverse_binds[i]) : worlds[s->joints[i]];
}

static void pose_part(pose *p, size_t part_index, mat4 *joints)
{
    const node *n = &p->scene->nodes[p->scene->parts[part_index].node];
    const skin *s = skin_of(p->scene, part_index);
    if (n->mesh == NONE)
        return;
    const mesh *m = &p->scene->meshes[n->mesh];
    if (s)
        set_joints(joints, p->worlds, s);
    p->parts[part_index] =
        (part_pose){.joints = s ? joints : NULL,
                    .joint_count = s ? s->joint_count : 0,
                    .weights = n->morph_weights ? n->morph_weights : m->morph_weights,
                    .weight_count = n->morph_weights ? n->morph_weight_count : m->morph_weight_count};
}

lmn_status pose_create(pose *out, const lmn_scene *scene, lmn_error *error)
{
    size_t all = scene->part_count + scene->ghost_count, joint_count = count_joints(scene);
    *out = (pose){.scene = scene,
                  .revision = scene->revision,
                  .part_count = scene->part_count,
                  .ghost_count = scene->ghost_count,
                  .box = box3_empty()};
    out->worlds = scene_world_matrices(scene);
    out->parts = mem_calloc(scene->part_count, sizeof *out->parts);
    out->part_boxes = mem_calloc(all, sizeof *out->part_boxes);
    out->joints = mem_calloc(joint_count, sizeof *out->joints);
    if (!out->worlds || !out->parts || !out->part_boxes || !out->joints)
        return error_memory(error);
    mat4 *joints = out->joints;
    for (size_t i = 0; i < scene->part_count; i++) {
        pose_part(out, i, joints);
        joints += out->parts[i].joint_count;
        out->box = box3_union(out->box, scene->parts[i].bounds);
    }
    for (size_t i = 0; i < all; i++)
        out->part_boxes[i] = scene->parts[i].bounds; /* at rest the scene knows them */
    return LMN_OK;
}

void pose_release(pose *p)
{
    mem_free(p->worlds);
    mem_free(p->parts);
    mem_free(p->part_boxes);
    mem_free(p->joints);
    memset(p, 0, sizeof *p);
}

bool pose_deforms(const part_pose *pose, const primitive *p)
{
    return pose->joints || (pose->weights && p->morph_count);
}

mat4 pose_instance(const pose *p, size_t part_index, size_t instance)
{
    const node *n = &p->scene->nodes[p->scene->parts[part_index].node];
    mat4        world = part_index < p->part_count && p->parts[part_index].joints
                            ? mat4_identity()
                            : p->worlds[p->scene->parts[part_index].node];
    return n->instance_count ? mat4_multiply(&world, &n->instances[instance]) : world;
}
