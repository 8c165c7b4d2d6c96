/* Where two things meet: the nearest place of the partner's surface. */
#include "depict/meeting.h"

#include "base/error.h"
#include "base/memory.h"
#include "contact/surface.h"
#include "scene/content.h"

/* How near a surface is to be that is met without having been named, in radii: as contact/contact.h has it. */
static const double REACH = 0.1;

/* All parts but the target's own. */
static lmn_status near_any(surface_place *out, bool *met, const depict_job *j, const depict_target *t,
                           const pose *posed, const double at[3], lmn_error *error)
{
    bool *others = mem_alloc((t->part_count + 1) * sizeof *others);
    if (!others)
        return error_memory(error);
    for (size_t i = 0; i < t->part_count; i++)
        others[i] = !t->parts[i] && !scene_is_hidden(j->scene, j->scene->parts[i].node);
    lmn_status status = surface_nearest(out, met, posed, others, at, REACH * t->radius, error);
    mem_free(others);
    return status;
}

lmn_status meeting_touches(bool *out, const depict_job *j, const depict_target *t, const depict_impact *impact,
                           lmn_error *error)
{
    const pose   *posed = NULL;
    surface_place there;
    double        at[3];
    *out = false;
    lmn_status status = impact_contact(at, j, t, impact, error);
    if (status == LMN_OK)
        status = depict_pose(&posed, j, impact->time, error);
    return status == LMN_OK ? near_any(&there, out, j, t, posed, at, error) : status;
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
        status = near_any(&there, &near, j, t, posed, out, error);
    } else if (status == LMN_OK) {
        depict_target other;
        status = target_open(&other, j, partner, error);
        if (status == LMN_OK)
            status = surface_nearest(&there, &near, posed, other.parts, out, 0.5 * t->radius, error);
        target_release(&other);
        *met = near;
    }
    if (status == LMN_OK && near)
        vector3_mix(out, out, there.place, 0.5);
    return status;
}
