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

/* A place of the world at a time, in a way's axes. */
static void place_on(const way *w, const double place[3], double seconds, double out[3])
{
    const mat4 world = way_world(w, seconds), inverse = mat4_inverse(&world);
    for (int k = 0; k < 3; k++)
        out[k] =
            inverse.m[k] * place[0] + inverse.m[4 + k] * place[1] + inverse.m[8 + k] * place[2] + inverse.m[12 + k];
}

/* How fast a place on a way is, before a time and after it. */
static void velocities_on(double before[3], double after[3], const way *w, const double place[3], double seconds)
{
    const double span = 1e-4;
    double       local[3];
    place_on(w, place, seconds, local);
    way_velocity(w, local, seconds - span, span, before);
    way_velocity(w, local, seconds + span, span, after);
}

/* The same of a node's surface. */
static lmn_status velocities_of(double before[3], double after[3], const depict_job *j, int32_t node,
                                const double place[3], double seconds, lmn_error *error)
{
    way        w;
    lmn_status status = way_open(&w, j->scene, node, &j->when, error);
    if (status == LMN_OK)
        velocities_on(before, after, &w, place, seconds);
    way_release(&w);
    return status;
}

/* Where a target meets others at an impact. */
typedef struct encounter {
    const depict_job    *j;
    const depict_target *t;
    const depict_impact *impact;
} encounter;

/* How fast it is itself: all of it as its middle, unless it turns on the spot. */
static void own_velocities(double before[3], double after[3], const encounter *m, const double place[3])
{
    vector3_copy(before, m->impact->before);
    vector3_add(after, before, 1, m->impact->change);
    if (m->impact->turns)
        velocities_on(before, after, &m->t->way, place, m->impact->time);
}

static lmn_status approach(double out[3], void *user, size_t part, const double place[3], lmn_error *error)
{
    const encounter *m = user;
    double           before[3], after[3], own[3];
    lmn_status       status =
        velocities_of(before, after, m->j, m->j->scene->parts[part].node, place, m->impact->time, error);
    own_velocities(own, after, m, place);
    if (status == LMN_OK)
        vector3_add(out, own, -1, before);
    return status;
}

/* What turns on the spot touches its hinge all the time; it hits what the place was away from before, by three of its
 * reaches. */
static lmn_status were_apart(bool *out, const encounter *m, const touch *found, double speed, lmn_error *error)
{
    const depict_job *j = m->j;
    const double      reach = REACH * m->t->radius, then = fmax(m->impact->time - 3 * reach / speed, 0);
    bool             *theirs = mem_calloc(j->scene->part_count + 1, sizeof *theirs), near = false;
    moment            when = j->when;
    pose              posed; /* those of the job may change places */
    double            local[3], at[3];
    surface_place     there;
    if (!theirs)
        return error_memory(error);
    theirs[found->part] = true;
    place_on(&m->t->way, found->place, m->impact->time, local);
    way_point(&m->t->way, local, then, at);
    when.seconds = then;
    lmn_status status = pose_create(&posed, j->scene, &when, error);
    if (status == LMN_OK) {
        status = surface_nearest(&there, &near, &posed, theirs, at, reach, error);
        pose_release(&posed);
    }
    *out = !near;
    mem_free(theirs);
    return status;
}

static lmn_status accepts(bool *out, void *user, const touch *found, lmn_error *error)
{
    const encounter *m = user;
    double           before[3], after[3], own[3], behind[3];
    lmn_status       status =
        velocities_of(before, after, m->j, m->j->scene->parts[found->part].node, found->place, m->impact->time, error);
    if (status != LMN_OK)
        return status;
    own_velocities(own, behind, m, found->place);
    vector3_add(after, behind, -1, after);
    vector3_add(before, own, -1, before);
    *out = contact_is_hit(before, after, found->normal) &&
           (!m->impact->turns || contact_is_off_hinge(own, m->impact->before));
    return *out && m->impact->turns ? were_apart(out, m, found, vector3_length(before), error) : LMN_OK;
}

/* What it hits there of the parts that have a flag: contact/contact.h, from what is known of a target's middle. */
static lmn_status find_touch(touch *out, bool *found, const depict_job *j, const depict_target *t, const bool *others,
                             double reach, const depict_impact *impact, lmn_error *error)
{
    const pose        *posed = NULL;
    encounter          m = {j, t, impact};
    const touch_motion motion = {approach, accepts, &m,
                                 contact_reach(reach, impact->before, impact->since, impact->until), impact->turns};
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
