/* include/limner/behaviour.h, what tells of behaviours: checks arguments and forwards. */
#include <math.h>

#include "api/check_content.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "contact/contact.h"
#include "limner/behaviour.h"

struct lmn_dynamics {
    const lmn_scene *scene;
    schedule         s;
    moment           clips;
    bool             of_behaviour; /* do its activities have numbers? */
};

lmn_status lmn_dynamics_create(const lmn_scene *scene, const char *clips, lmn_dynamics **out, lmn_error *error)
{
    const char *caller = "lmn_dynamics_create";
    if (out)
        *out = NULL;
    lmn_status status = content_check_scene(scene, caller, error);
    if (status == LMN_OK && !out)
        status = error_set(error, LMN_USAGE, "%s: `out` is NULL", caller);
    if (status != LMN_OK)
        return status;
    lmn_dynamics *d = mem_calloc(1, sizeof *d);
    if (!d)
        return error_memory(error);
    work w;
    work_begin(&w, NULL, NULL);
    d->scene = scene;
    status = schedule_of_moment(&d->s, &d->clips, scene, clips, error);
    d->of_behaviour = !d->s.own && d->s.node_count > 0;
    if (status == LMN_FORMAT && error)
        error->status = LMN_USAGE;
    status = work_end(&w, status == LMN_FORMAT ? LMN_USAGE : status, error);
    if (status == LMN_OK)
        *out = d;
    else
        lmn_dynamics_destroy(&d);
    return status;
}

void lmn_dynamics_destroy(lmn_dynamics **dynamics)
{
    if (!dynamics || !*dynamics)
        return;
    schedule_release(&(*dynamics)->s);
    mem_free(*dynamics);
    *dynamics = NULL;
}

double lmn_dynamics_duration(const lmn_dynamics *d)
{
    return d ? d->s.duration : 0;
}

/* The node that has the camera or light; the first one. */
static uint32_t owner_of(const lmn_scene *s, animation_path path, int32_t target)
{
    if (animation_thing_of(path) == ANIMATED_NODE)
        return (uint32_t)target + 1;
    for (size_t i = 0; i < s->node_count; i++)
        if ((animation_thing_of(path) == ANIMATED_CAMERA ? s->nodes[i].camera : s->nodes[i].light) == target)
            return (uint32_t)i + 1;
    return 0;
}

bool lmn_dynamics_lifetime_at(const lmn_dynamics *d, size_t index, lmn_lifetime *out)
{
    if (!d || !out || index >= d->s.span_count)
        return false;
    const behaviour_span *span = &d->s.spans[index];
    const behaviour_node *n = &d->s.nodes[span->node];
    *out = (lmn_lifetime){.activity = d->of_behaviour ? (uint32_t)span->node + 1 : 0,
                          .is_event = span->property == NONE,
                          .from_s = span->from,
                          .to_s = span->to,
                          .open_from = span->open_from,
                          .open_to = span->open_to};
    if (span->property == NONE) {
        out->node = n->target == NONE ? 0 : (uint32_t)n->target + 1;
        return true;
    }
    const behaviour_property *p = &d->s.properties[span->property];
    out->property = (lmn_property)p->path;
    out->node = owner_of(d->scene, p->path, p->target);
    return true;
}

/* --- of one node -------------------------------------------------------------------------------------------- */

static lmn_status check_node(const lmn_dynamics *d, uint32_t node_number, const char *caller, lmn_error *error)
{
    if (!d)
        return error_set(error, LMN_USAGE, "%s: `dynamics` is NULL", caller);
    return content_check_node(d->scene, node_number, caller, error);
}

static lmn_status check_interval(double from, double to, bool finite, const char *caller, lmn_error *error)
{
    if (from <= to && (!finite || (fabs(from) <= 1e9 && fabs(to) <= 1e9)))
        return LMN_OK;
    return error_set(error, LMN_USAGE, "%s: the interval is from %g to %g seconds", caller, from, to);
}

static lmn_status check_point(const double *point, const char *caller, lmn_error *error)
{
    for (int k = 0; point && k < 3; k++)
        if (!(fabs(point[k]) <= 1e18))
            return error_set(error, LMN_USAGE, "%s: number %d of the point is %g", caller, k, point[k]);
    return LMN_OK;
}

static lmn_status check_array(const void *array, size_t capacity, const void *count, const char *caller,
                              lmn_error *error)
{
    if ((array || capacity == 0) && count)
        return LMN_OK;
    return error_set(error, LMN_USAGE, "%s: %s is NULL", caller, count ? "an array with a capacity" : "a count");
}

lmn_status lmn_dynamics_of_node(const lmn_dynamics *d, uint32_t node_number, double from, double to, uint32_t *path,
                                size_t path_capacity, size_t *path_count, size_t *lifetimes, size_t lifetime_capacity,
                                size_t *lifetime_count, lmn_error *error)
{
    const char *caller = "lmn_dynamics_of_node";
    dynamics    found;
    lmn_status  status = check_node(d, node_number, caller, error);
    if (status == LMN_OK)
        status = check_interval(from, to, false, caller, error);
    if (status == LMN_OK)
        status = check_array(path, path_capacity, path_count, caller, error);
    if (status == LMN_OK)
        status = check_array(lifetimes, lifetime_capacity, lifetime_count, caller, error);
    if (status != LMN_OK)
        return status;
    status = dynamics_create(&found, &d->s, content_index(node_number), from, to, error);
    if (status == LMN_OK) {
        *path_count = found.path_count;
        *lifetime_count = found.span_count;
        for (size_t i = 0; i < found.path_count && i < path_capacity; i++)
            path[i] = (uint32_t)found.path[i] + 1;
        for (size_t i = 0; i < found.span_count && i < lifetime_capacity; i++)
            lifetimes[i] = found.spans[i];
    }
    dynamics_release(&found);
    return status;
}

static lmn_point_state state_of(const trajectory_sample *s)
{
    lmn_point_state out = {.time_s = s->seconds};
    for (int k = 0; k < 3; k++) {
        out.position[k] = s->position[k];
        out.velocity[k] = s->velocity[k];
        out.acceleration[k] = s->acceleration[k];
    }
    return out;
}

static bool is_finite(const lmn_point_state *s)
{
    bool good = true;
    for (int k = 0; k < 3; k++)
        good = good && isfinite(s->position[k]) && isfinite(s->velocity[k]) && isfinite(s->acceleration[k]);
    return good;
}

static lmn_status refuse_place(const lmn_point_state *s, const char *caller, lmn_error *error)
{
    return error_set(error, LMN_USAGE, "%s: a callback puts it where nothing can be, at %g s", caller, s->time_s);
}

lmn_status lmn_dynamics_point(const lmn_dynamics *d, uint32_t node_number, const double point[3], double seconds,
                              lmn_point_state *out, lmn_error *error)
{
    const char       *caller = "lmn_dynamics_point";
    trajectory_sample at;
    lmn_status        status = check_node(d, node_number, caller, error);
    if (status == LMN_OK && !out)
        status = error_set(error, LMN_USAGE, "%s: `out` is NULL", caller);
    if (status == LMN_OK)
        status = check_point(point, caller, error);
    if (status == LMN_OK)
        status = check_interval(seconds, seconds, true, caller, error);
    if (status == LMN_OK)
        status = schedule_point_at(&at, &d->s, content_index(node_number), point, seconds, SIDE_AT, error);
    if (status != LMN_OK)
        return status;
    lmn_point_state state = state_of(&at);
    if (!is_finite(&state))
        return refuse_place(&state, caller, error);
    *out = state;
    return LMN_OK;
}

lmn_status lmn_dynamics_trajectory(const lmn_dynamics *d, uint32_t node_number, const double point[3], double from,
                                   double to, double tolerance, lmn_point_state *states, size_t capacity, size_t *count,
                                   lmn_error *error)
{
    const char *caller = "lmn_dynamics_trajectory";
    trajectory  t;
    work        w;
    lmn_status  status = check_node(d, node_number, caller, error);
    if (status == LMN_OK)
        status = check_interval(from, to, true, caller, error);
    if (status == LMN_OK)
        status = check_point(point, caller, error);
    if (status == LMN_OK)
        status = check_array(states, capacity, count, caller, error);
    if (status == LMN_OK && !(tolerance > 0))
        status = error_set(error, LMN_USAGE, "%s: the tolerance is %g, not above 0", caller, tolerance);
    if (status != LMN_OK)
        return status;
    work_begin(&w, NULL, NULL);
    status = schedule_trajectory(&t, &d->s, content_index(node_number), point, from, to, tolerance, error);
    for (size_t i = 0; i < t.count && status == LMN_OK; i++) {
        lmn_point_state state = state_of(&t.samples[i]);
        if (!is_finite(&state))
            status = refuse_place(&state, caller, error);
        if (i < capacity)
            states[i] = state;
    }
    if (status == LMN_OK)
        *count = t.count;
    trajectory_release(&t);
    return work_end(&w, status, error);
}

static lmn_contact contact_of(const contact *c)
{
    lmn_contact out = {.time_s = c->hit.seconds,
                       .impulse = c->hit.speed,
                       .other = c->other == NONE ? 0 : (uint32_t)c->other + 1,
                       .distance = c->distance};
    for (int k = 0; k < 3; k++) {
        out.place[k] = c->hit.place[k];
        out.normal[k] = c->hit.normal[k];
    }
    return out;
}

lmn_status lmn_dynamics_contacts(const lmn_dynamics *d, uint32_t node_number, double from, double to, double least,
                                 lmn_contact *contacts, size_t capacity, size_t *count, lmn_error *error)
{
    const char *caller = "lmn_dynamics_contacts";
    contact    *found = NULL;
    size_t      found_count = 0;
    work        w;
    lmn_status  status = check_node(d, node_number, caller, error);
    if (status == LMN_OK)
        status = check_interval(from, to, true, caller, error);
    if (status == LMN_OK)
        status = check_array(contacts, capacity, count, caller, error);
    if (status == LMN_OK)
        status = content_check_range(least, 0, 1e18, "`least`", caller, error);
    if (status != LMN_OK)
        return status;
    work_begin(&w, NULL, NULL);
    status = contacts_find(&found, &found_count, &d->s, &d->clips, content_index(node_number), from, to, least, error);
    for (size_t i = 0; i < found_count && i < capacity; i++)
        contacts[i] = contact_of(&found[i]);
    if (status == LMN_OK)
        *count = found_count;
    mem_free(found);
    return work_end(&w, status, error);
}
