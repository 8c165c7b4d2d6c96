/* What jumps from one place to another moves by no way: it has no speed that others could be measured by. A jump is
 * where nearly all of a way is passed within a small part of its time, however small a part is looked at. */
#include "trace/trace_private.h"

#include <math.h>

/* The time is halved so often, each time where most of the way is; a jump passes this fraction of the whole in what is
 * left. What starts or stops at once passes it by steps as small as the time that is left. */
enum { HALVINGS = 8, VERTICES = 256 };
#define MOST 0.5

/* Where a position of the world goes with a node. */
static vec3 go(const pose *now, const pose *then, int32_t node, vec3 at)
{
    mat4 back = mat4_inverse(&pose_rigid_worlds(now)[node]),
         moved = mat4_multiply(&pose_rigid_worlds(then)[node], &back);
    return mat4_transform_point(&moved, at);
}

static double apart(vec3 a, vec3 b)
{
    return hypot(hypot((double)(a.x - b.x), (double)(a.y - b.y)), (double)(a.z - b.z));
}

/* Of about so many vertices of a body that which went farthest, now, in the world. */
static vec3 farthest_vertex(const trace_bodies *t, const trace_body *b, const traces_options *o, const pose *before)
{
    double most = -1;
    vec3   out = {0, 0, 0};
    for (uint32_t i = 3 * b->first; i < 3 * (b->first + b->count); i += 1 + 3 * b->count / VERTICES) {
        double world[3];
        page_unproject(&o->camera, t->now[t->triangles[i / 3][i % 3]], world);
        vec3   at = {(float)world[0], (float)world[1], (float)world[2]};
        double way = apart(at, go(o->pose, before, b->node, at));
        if (way > most) {
            most = way;
            out = at;
        }
    }
    return out;
}

static lmn_status jumps(bool *out, const traces_options *o, const trace_body *b, vec3 now, double fraction,
                        lmn_error *error)
{
    double     from = 0, to = fraction, whole = 0;
    vec3       ends[2] = {now, now};
    lmn_status status = LMN_OK;
    for (int n = -1; n < HALVINGS && status == LMN_OK; n++) {
        double middle = n < 0 ? fraction : 0.5 * (from + to);
        pose   then = {.scene = NULL};
        status = pose_ago(&then, o, middle, error);
        vec3 at = status == LMN_OK ? go(o->pose, &then, b->node, now) : now;
        pose_release(&then);
        if (n < 0) {
            ends[1] = at;
            whole = apart(at, now);
        } else if (apart(ends[0], at) > apart(at, ends[1])) {
            to = middle;
            ends[1] = at;
        } else {
            from = middle;
            ends[0] = at;
        }
    }
    *out = whole > 0 && apart(ends[0], ends[1]) > MOST * whole;
    return status;
}

lmn_status jumps_find(bool *jumping, size_t *count, const trace_bodies *bodies, const traces_options *o,
                      const pose *before, double fraction, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < bodies->body_count && status == LMN_OK; i++) {
        const trace_body *b = &bodies->bodies[i];
        if (b->node == NONE || b->count == 0)
            continue;
        status = jumps(&jumping[b->node], o, b, farthest_vertex(bodies, b, o, before), fraction, error);
        *count += jumping[b->node];
    }
    return status;
}
