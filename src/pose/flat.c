/* Parts of which a pose leaves nothing to see. */
#include "pose/pose.h"

#include <stdio.h>

/* Does a vertex follow some joint that has an extent? */
static bool is_held(const pose *p, const skin *s, const primitive *q, uint32_t vertex)
{
    bool held = false;
    for (uint32_t k = 0; k < q->influences && !held; k++) {
        size_t at = (size_t)vertex * q->influences + k;
        held = q->weights[at] != 0 && q->joints[at] < s->joint_count &&
               !mat4_is_flat(&p->worlds[s->joints[q->joints[at]]]);
    }
    return held;
}

static bool primitive_is_held(const pose *p, const skin *s, const primitive *q)
{
    bool held = !q->joints || !q->weights;
    for (uint32_t i = 0; i < q->vertex_count && !held; i++)
        held = is_held(p, s, q, i);
    return held;
}

/* The first joint of no extent that some vertex follows; NONE. Few skins have any, and their vertices are not asked. */
static int32_t flat_joint(const pose *p, const skin *s)
{
    for (size_t i = 0; i < s->joint_count; i++)
        if (mat4_is_flat(&p->worlds[s->joints[i]]))
            return s->joints[i];
    return NONE;
}

static void warn_of_part(const pose *p, size_t part_index, warnings *warnings)
{
    const lmn_scene *scene = p->scene;
    const node      *n = &scene->nodes[scene->parts[part_index].node];
    if (n->mesh == NONE || n->skin == NONE)
        return;
    const skin *s = &scene->skins[n->skin];
    const mesh *m = &scene->meshes[n->mesh];
    int32_t     joint = flat_joint(p, s);
    bool        held = joint == NONE || m->primitive_count == 0;
    for (size_t i = 0; i < m->primitive_count && !held; i++)
        held = primitive_is_held(p, s, &m->primitives[i]);
    if (held)
        return;
    const char *name = scene->nodes[joint].name;
    char        number[32];
    snprintf(number, sizeof number, "%d", n->skin + 1);
    warnings_add(warnings, WARNING_BAD_GEOMETRY,
                 "part '%.100s' is flat: the joints of skin '%.100s' that it follows, as '%.100s', have a scale of 0",
                 scene->parts[part_index].name, s->name ? s->name : number, name ? name : "");
}

void pose_warn_of_flat(const pose *p, warnings *warnings)
{
    for (size_t i = 0; i < p->part_count; i++)
        warn_of_part(p, i, warnings);
}
