/* Where positions were: what is on a body goes with the node that the body moves with, also where parts of it turn by
 * themselves, as wheels do; of bodies whose vertices move by themselves, both vertices of an origin say where it was.
 */
#include "trace/trace_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* A position halfway between two steps lies off their chord by about four times as much as one halfway between two
 * steps that are half as long: so far off, units, that straight pieces are off by a quarter of a unit. */
#define HALFWAY_MOST 1.0
enum { STEPS_FIRST = 8, STEPS_MOST = 64 };

lmn_status pose_before(pose *out, const pose *now, double seconds, lmn_error *error)
{
    moment when = now->when;
    when.seconds = when.seconds > seconds ? when.seconds - seconds : 0; /* clips begin at 0 */
    when.held = 0;
    when.held_seconds = 0;
    return pose_create(out, now->scene, &when, error);
}

lmn_status pose_ago(pose *out, const traces_options *o, double fraction, lmn_error *error)
{
    double exposure = (double)o->values->common.exposure, now = o->pose->when.seconds;
    return pose_before(out, o->pose, (now < exposure ? now : exposure) * fraction, error);
}

static vec3 place(const pose *p, const trace_bodies *bodies, const trace_origin *origin)
{
    const trace_mesh *m = &bodies->meshes[origin->mesh];
    const part_pose  *own = &p->parts[m->part];
    vec3              at[2];
    if (origin->beside)
        return origin->at;
    if (pose_deforms(own, m->primitive))
        pose_vertices(own, m->primitive, NULL, origin->vertex, 2, at, NULL);
    else
        for (int k = 0; k < 2; k++)
            at[k] = m->primitive->positions[origin->vertex[k]];
    mat4 world = pose_instance(p, m->part, m->instance);
    for (int k = 0; k < 2; k++)
        at[k] = mat4_transform_point(&world, at[k]);
    float f = (float)origin->fraction;
    return (vec3){at[0].x + f * (at[1].x - at[0].x), at[0].y + f * (at[1].y - at[0].y),
                  at[0].z + f * (at[1].z - at[0].z)};
}

static vec3 place_earlier(const traces_options *o, const pose *earlier, const trace_bodies *bodies,
                          const trace_origin *origin)
{
    int32_t node = bodies->bodies[origin->body].node;
    if (node == NONE)
        return place(earlier, bodies, origin);
    /* Lines go the way of what moves, whatever shape it had there. */
    mat4 back = mat4_inverse(&pose_rigid_worlds(o->pose)[node]),
         moved = mat4_multiply(&pose_rigid_worlds(earlier)[node], &back);
    return mat4_transform_point(&moved, place(o->pose, bodies, origin));
}

/* Positions at one step; what is behind the viewer stays where it was one step later. */
static lmn_status put_step(trace_ways *w, const traces_options *o, const trace_bodies *bodies,
                           const trace_origin *origins, size_t count, uint32_t k, lmn_error *error)
{
    pose       earlier = {.scene = NULL};
    lmn_status status = k ? pose_ago(&earlier, o, (double)k / w->steps, error) : LMN_OK;
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        double *at = w->at[i * (w->steps + 1) + k];
        vec3    world = k ? place_earlier(o, &earlier, bodies, &origins[i]) : place(o->pose, bodies, &origins[i]);
        if (!page_project(&o->camera, world, at))
            memcpy(at, k ? at - 3 : (double[3]){NAN, NAN, NAN}, 3 * sizeof *at);
    }
    if (k)
        pose_release(&earlier);
    return status;
}

static double farthest_halfway(const trace_ways *w, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++)
        for (uint32_t k = 1; k < w->steps; k += 2) {
            const double *p = w->at[i * (w->steps + 1) + k];
            most = fmax(most, hypot(p[0] - 0.5 * (p[-3] + p[3]), p[1] - 0.5 * (p[-2] + p[4])));
        }
    return most;
}

lmn_status ways_follow(trace_ways *out, const traces_options *o, const trace_bodies *bodies,
                       const trace_origin *origins, size_t count, lmn_error *error)
{
    lmn_status status = LMN_OK;
    memset(out, 0, sizeof *out);
    for (uint32_t steps = STEPS_FIRST; steps <= STEPS_MOST && status == LMN_OK; steps *= 2) {
        ways_release(out);
        out->steps = steps;
        out->at = mem_alloc((count * (steps + 1) + 1) * sizeof *out->at);
        status = out->at ? LMN_OK : error_memory(error);
        for (uint32_t k = 0; k <= steps && status == LMN_OK; k++)
            status = put_step(out, o, bodies, origins, count, k, error);
        if (status == LMN_OK && farthest_halfway(out, count) <= HALFWAY_MOST)
            break;
    }
    if (status != LMN_OK)
        ways_release(out);
    return status;
}

void ways_release(trace_ways *w)
{
    mem_free(w->at);
    w->at = NULL;
}
