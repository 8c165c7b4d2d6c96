#include "plan/deformation.h"

#include <string.h>

#include "base/memory.h"
#include "motion/motion.h"
#include "plan/time.h"

static part_deformation values_of(const rule *r)
{
    const double         RADIANS = 3.14159265358979323846 / 180;
    const motion_common *v = r && r->use_counts[KIND_MOTION] ? r->uses[KIND_MOTION][0].values : NULL;
    if (!v)
        return (part_deformation){.stretch = 0};
    return (part_deformation){.stretch = (double)v->stretch,
                              .squash = (double)v->squash,
                              .lean = (double)v->lean * RADIANS,
                              .inertia = (double)v->inertia * RADIANS,
                              .full_speed = (double)v->full_speed,
                              .full_acceleration = (double)v->full_acceleration,
                              .slit = (double)v->slit,
                              .pan = (double)v->pan,
                              .lag = (double)v->lag,
                              .drag = (double)v->drag,
                              .comb = (double)v->comb,
                              .teeth = v->comb_teeth};
}

static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ ((const unsigned char *)bytes)[i]) * 1099511628211u; /* FNV-1a */
    return hash;
}

/* Field by field: between them there may be anything. */
static uint64_t hash_of(const pose_deformation *d)
{
    uint64_t hash = hash_bytes(1469598103934665603u, &d->response, sizeof d->response);
    for (size_t i = 0; i < d->part_count; i++) {
        const part_deformation *p = &d->parts[i];
        const double values[] = {p->stretch, p->squash, p->lean, p->inertia, p->full_speed, p->full_acceleration,
                                 p->slit,    p->pan,    p->lag,  p->drag,    p->comb,       p->teeth};
        hash = hash_bytes(hash, values, sizeof values);
    }
    return hash;
}

static bool deforms(const lmn_look *look)
{
    for (size_t i = 0; i < look->rule_count; i++) {
        part_deformation own = values_of(&look->rules[i]);
        if (!part_deformation_is_none(&own))
            return true;
    }
    return false;
}

static double response_of(const lmn_look *look)
{
    for (size_t i = 0; i < look->rule_count; i++)
        if (look->rules[i].use_counts[KIND_MOTION])
            return (double)((const motion_common *)look->rules[i].uses[KIND_MOTION][0].values)->response;
    return 0;
}

/* Said once, however many rules there are. */
static void warn_of_idle(const lmn_look *look, warnings *warnings)
{
    bool idle = false;
    for (size_t i = 0; i < look->rule_count; i++) {
        const rule      *r = &look->rules[i];
        part_deformation own = values_of(r);
        idle = idle || (r->use_counts[KIND_MOTION] && r->uses[KIND_MOTION][0].technique == &motion_deform &&
                        part_deformation_is_none(&own));
    }
    if (idle)
        warnings_add(warnings, WARNING_UNUSED,
                     "motion 'deform' changes nothing: set motion.stretch, squash, lean, inertia, lag, drag or comb");
}

lmn_status deformation_find(pose_deformation *kept, moment *when, const lmn_scene *scene, const lmn_look *look,
                            warnings *warnings, lmn_error *error)
{
    if (when->clip_count && warnings)
        warn_of_idle(look, warnings);
    pose_deformation made = {.part_count = scene->part_count, .response = response_of(look)};
    when->deformation = NULL;
    when->deformation_hash = 0;
    if (!when->clip_count || !deforms(look))
        return LMN_OK;
    made.parts = mem_calloc(made.part_count, sizeof *made.parts);
    if (!made.parts)
        return error_memory(error);
    for (size_t i = 0; i < made.part_count; i++)
        made.parts[i] = values_of(time_rule(look, scene, i));
    made.hash = hash_of(&made);
    if (kept->parts && kept->hash == made.hash && kept->part_count == made.part_count) {
        pose_deformation_release(&made);
    } else {
        pose_deformation_release(kept);
        *kept = made;
    }
    when->deformation = kept;
    when->deformation_hash = kept->hash;
    return LMN_OK;
}
