/* Where two things meet: the nearest place of the partner's surface. */
#include "depict/meeting.h"

#include "base/error.h"
#include "base/memory.h"
#include "contact/contact.h"
#include "contact/surface.h"
#include "contact/touch.h"
#include "scene/content.h"

/* How near a surface is to be that is met without having been named, in radii: what is seen to hit may stop a bit short
 * of it. */
static const double REACH = 0.1;

/* How fast a node's surface is at a place, before a time and after it. */
static lmn_status velocities_of(double before[3], double after[3], const depict_job *j, int32_t node,
                                const double place[3], double seconds, lmn_error *error)
{
    way          w;
    const double span = 1e-4;
    lmn_status   status = way_open(&w, j->scene, node, &j->when, error);
    if (status == LMN_OK) {
        const mat4 world = way_world(&w, seconds), inverse = mat4_inverse(&world);
        double     local[3];
        for (int k = 0; k < 3; k++)
            local[k] =
                inverse.m[k] * place[0] + inverse.m[4 + k] * place[1] + inverse.m[8 + k] * place[2] + inverse.m[12 + k];
        way_velocity(&w, local, seconds - span, span, before);
        way_velocity(&w, local, seconds + span, span, after);
    }
    way_release(&w);
    return status;
}

/* Where a target meets others at an impact. */
typedef struct encounter {
    const depict_job    *j;
    const depict_impact *impact;
} encounter;

static lmn_status approach(double out[3], void *user, size_t part, const double place[3], lmn_error *error)
{
    const encounter *m = user;
    double           before[3], after[3];
    lmn_status       status =
        velocities_of(before, after, m->j, m->j->scene->parts[part].node, place, m->impact->time, error);
    if (status == LMN_OK)
        vector3_add(out, m->impact->before, -1, before);
    return status;
}

static lmn_status accepts(bool *out, void *user, const touch *found, lmn_error *error)
{
    const encounter *m = user;
    double           before[3], after[3], own[3];
    lmn_status       status =
        velocities_of(before, after, m->j, m->j->scene->parts[found->part].node, found->place, m->impact->time, error);
    if (status != LMN_OK)
        return status;
    vector3_add(own, m->impact->before, 1, m->impact->change);
    vector3_add(after, own, -1, after);
    vector3_add(before, m->impact->before, -1, before);
    *out = contact_is_hit(before, after, found->normal);
    return LMN_OK;
}

/* What it hits there of the parts that have a flag: contact/contact.h, from what is known of a target's middle. */
static lmn_status find_touch(touch *out, bool *found, const depict_job *j, const depict_target *t, const bool *others,
                             double reach, const depict_impact *impact, lmn_error *error)
{
    const pose        *posed = NULL;
    encounter          m = {j, impact};
    const touch_motion motion = {approach, accepts, &m,
                                 contact_reach(reach, impact->before, impact->since, impact->until)};
    lmn_status         status = depict_pose(&posed, j, impact->time, error);
    *found = false;
    return status == LMN_OK ? touch_find(out, found, posed, t->parts, others, &motion, error) : status;
}

/* The same of all that is shown but the target itself. */
static lmn_status touch_any(touch *out, bool *found, const depict_job *j, const depict_target *t,
                            const depict_impact *impact, lmn_error *error)
{
    bool *others = mem_alloc((t->part_count + 1) * sizeof *others);
    if (!others)
        return error_memory(error);
    for (size_t i = 0; i < t->part_count; i++)
        others[i] = !t->parts[i] && !scene_is_hidden(j->scene, j->scene->parts[i].node);
    lmn_status status = find_touch(out, found, j, t, others, REACH * t->radius, impact, error);
    mem_free(others);
    return status;
}

lmn_status meeting_touches(bool *out, int32_t *other, const depict_job *j, const depict_target *t,
                           const depict_impact *impact, lmn_error *error)
{
    touch      there;
    lmn_status status = touch_any(&there, out, j, t, impact, error);
    if (*out)
        *other = j->scene->parts[there.part].node;
    return status;
}

/* A partner that is near where the target ends, though it is not hit. */
static lmn_status find_beside(double out[3], bool *near, const depict_job *j, const depict_target *t,
                              const depict_target *partner, const depict_impact *impact, lmn_error *error)
{
    const pose   *posed = NULL;
    surface_place there;
    lmn_status    status = depict_pose(&posed, j, impact->time, error);
    if (status == LMN_OK)
        status = surface_nearest(&there, near, posed, partner->parts, out, 0.5 * t->radius, error);
    if (status == LMN_OK && *near)
        vector3_mix(out, out, there.place, 0.5);
    return status;
}

lmn_status meeting_place(double out[3], bool *met, const depict_job *j, const depict_target *t, int32_t partner,
                         const depict_impact *impact, lmn_error *error)
{
    depict_target other = {0};
    touch         there;
    bool          found = false;
    lmn_status    status = impact_contact(out, j, t, impact, error);
    *met = true;
    if (status == LMN_OK && partner == NONE) {
        status = touch_any(&there, &found, j, t, impact, error);
    } else if (status == LMN_OK) {
        status = target_open(&other, j, partner, error);
        if (status == LMN_OK)
            status = find_touch(&there, &found, j, t, other.parts, 0.5 * t->radius, impact, error);
        *met = found;
        if (status == LMN_OK && !found)
            status = find_beside(out, met, j, t, &other, impact, error);
        target_release(&other);
    }
    if (status == LMN_OK && found)
        vector3_add(out, there.place, -there.gap / 2, there.normal);
    return status;
}
