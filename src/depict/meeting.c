/* Where two things meet: the nearest place of the partner's surface. */
#include "depict/meeting.h"

#include "base/error.h"
#include "base/memory.h"
#include "contact/contact.h"
#include "contact/surface.h"
#include "scene/content.h"

/* How near a surface is to be that is met without having been named, in radii: as contact/contact.h has it. */
static const double REACH = 0.1;

/* All parts but the target's own. */
static lmn_status near_any(surface_place *out, bool *met, const depict_job *j, const depict_target *t,
                           const pose *posed, const depict_impact *impact, const double at[3], lmn_error *error)
{
    double normal[3];
    bool  *others = mem_alloc((t->part_count + 1) * sizeof *others);
    vector3_copy(normal, impact->change);
    if (!others)
        return error_memory(error);
    for (size_t i = 0; i < t->part_count; i++)
        others[i] = !t->parts[i] && !scene_is_hidden(j->scene, j->scene->parts[i].node);
    const bool   pushed = vector3_normalise(normal);
    const double reach = contact_reach(REACH * t->radius, impact->before, normal, impact->since, impact->until);
    lmn_status   status = surface_nearest(out, met, posed, others, at, reach, pushed ? normal : NULL, error);
    mem_free(others);
    return status;
}

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

lmn_status meeting_touches(bool *out, int32_t *other, const depict_job *j, const depict_target *t,
                           const depict_impact *impact, lmn_error *error)
{
    const pose   *posed = NULL;
    surface_place there;
    double        at[3], before[3], after[3], normal[3], theirs[2][3];
    bool          near = false;
    *out = false;
    lmn_status status = impact_contact(at, j, t, impact, error);
    if (status == LMN_OK)
        status = depict_pose(&posed, j, impact->time, error);
    if (status == LMN_OK)
        status = near_any(&there, &near, j, t, posed, impact, at, error);
    if (status != LMN_OK || !near)
        return status;
    *other = j->scene->parts[there.part].node;
    vector3_copy(normal, impact->change);
    vector3_normalise(normal);
    status = velocities_of(theirs[0], theirs[1], j, *other, at, impact->time, error);
    if (status == LMN_OK) {
        vector3_add(before, impact->before, -1, theirs[0]);
        vector3_add(after, impact->before, 1, impact->change);
        vector3_add(after, after, -1, theirs[1]);
        *out = contact_is_hit(before, after, normal, there.facing);
    }
    return status;
}

lmn_status meeting_place(double out[3], bool *met, const depict_job *j, const depict_target *t, int32_t partner,
                         const depict_impact *impact, lmn_error *error)
{
    const pose   *posed = NULL;
    surface_place there;
    bool          near = false;
    lmn_status    status = impact_contact(out, j, t, impact, error);
    *met = true;
    if (status == LMN_OK)
        status = depict_pose(&posed, j, impact->time, error);
    if (status == LMN_OK && partner == NONE) {
        status = near_any(&there, &near, j, t, posed, impact, out, error);
    } else if (status == LMN_OK) {
        depict_target other;
        status = target_open(&other, j, partner, error);
        if (status == LMN_OK)
            status = surface_nearest(&there, &near, posed, other.parts, out, 0.5 * t->radius, NULL, error);
        target_release(&other);
        *met = near;
    }
    if (status == LMN_OK && near)
        vector3_mix(out, out, there.place, 0.5);
    return status;
}
