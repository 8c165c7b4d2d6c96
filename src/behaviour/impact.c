#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "behaviour/inspect.h"

/* The vertex of the node, and of all below it, that lies outermost against a normal, as meshes are at rest. */
static void outermost(const schedule *s, int32_t root, double t, const double normal[3], double place[3])
{
    double least = INFINITY;
    for (int32_t at = root; at != NONE; at = scene_next_node(s->scene, root, at)) {
        const node *n = &s->scene->nodes[at];
        if (n->mesh == NONE)
            continue;
        const mesh *m = &s->scene->meshes[n->mesh];
        mat4        world = schedule_world(s, at, t, SIDE_AT);
        for (size_t i = 0; i < m->primitive_count; i++)
            for (uint32_t k = 0; k < m->primitives[i].vertex_count; k++) {
                vec3         v = m->primitives[i].positions[k];
                const double p[3] = {(double)v.x, (double)v.y, (double)v.z};
                double       q[3];
                for (int c = 0; c < 3; c++)
                    q[c] = world.m[c] * p[0] + world.m[4 + c] * p[1] + world.m[8 + c] * p[2] + world.m[12 + c];
                if (vector3_dot(q, normal) < least) {
                    least = vector3_dot(q, normal);
                    memcpy(place, q, sizeof q);
                }
            }
    }
}

/* Two samples of one instant on either side of a corner; false when the place jumps, or hardly anything does. */
static bool is_impact(const trajectory_sample *a, const trajectory_sample *b, double least, impact *out)
{
    double change[3], moved = 0, fast = vector3_length(a->velocity) + vector3_length(b->velocity);
    if (a->seconds != b->seconds)
        return false;
    for (int k = 0; k < 3; k++) {
        change[k] = b->velocity[k] - a->velocity[k];
        moved = fmax(moved, fabs(b->position[k] - a->position[k]));
    }
    out->seconds = a->seconds;
    out->speed = vector3_length(change);
    for (int k = 0; k < 3; k++)
        out->normal[k] = out->speed > 0 ? change[k] / out->speed : 0;
    memcpy(out->place, a->position, sizeof out->place);
    return moved <= 1e-6 * (1 + fast) && out->speed >= least && out->speed > 1e-4 * fast;
}

lmn_status impacts_find(impact **out, size_t *count, const schedule *s, int32_t node_index, double from, double to,
                        double least, lmn_error *error)
{
    trajectory t;
    size_t     capacity = 0;
    *out = NULL;
    *count = 0;
    lmn_status status = schedule_trajectory(&t, s, node_index, NULL, from, to, INFINITY, error);
    for (size_t i = 0; i + 1 < t.count && status == LMN_OK; i++) {
        impact found;
        if (!is_impact(&t.samples[i], &t.samples[i + 1], least, &found))
            continue;
        outermost(s, node_index, found.seconds, found.normal, found.place);
        if (mem_grow((void **)out, &capacity, *count + 1, sizeof **out))
            (*out)[(*count)++] = found;
        else
            status = error_memory(error);
    }
    trajectory_release(&t);
    return status;
}
