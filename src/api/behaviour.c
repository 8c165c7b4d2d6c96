/* include/limner/behaviour.h, what makes behaviours: checks arguments and forwards. */
#include "limner/behaviour.h"

#include <assert.h>
#include <string.h>

#include "api/check_content.h"
#include "api/complete.h"
#include "base/colour.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/vector3.h"
#include "base/work.h"
#include "behaviour/change.h"
#include "behaviour/evaluate.h"
#include "behaviour/map.h"
#include "pose/moment.h"

static_assert((int)LMN_ACTIVITY_EVENT == (int)BEHAVIOUR_EVENT && (int)LMN_ACTIVITY_CREEP == (int)BEHAVIOUR_CREEP,
              "activities count in one order");
static_assert((int)LMN_TIME_MAP_CALLBACK == (int)MAP_CALLBACK && (int)LMN_TIME_MAP_FALL == (int)MAP_FALL,
              "maps count in one order");
static_assert((int)LMN_PROPERTY_LIGHT_INTENSITY == (int)PATH_LIGHT_INTENSITY &&
                  (int)LMN_PROPERTY_CAMERA_FOV == (int)PATH_CAMERA_FOV,
              "properties count in one order");

static const double DEGREE = 0.017453292519943295;
enum { VALUES_MAX = 16000000 };

/* What is made cannot be of a wrong format: the caller has asked for it. */
static lmn_status as_usage(lmn_status status, lmn_error *error)
{
    if (status != LMN_FORMAT)
        return status;
    if (error)
        error->status = LMN_USAGE;
    return LMN_USAGE;
}

static lmn_status check_activity(const lmn_scene *scene, uint32_t activity, const char *caller, lmn_error *error)
{
    size_t count = scene->behaviour ? scene->behaviour->node_count : 0;
    if (activity > 0 && activity <= count)
        return LMN_OK;
    return error_set(error, LMN_USAGE, "%s: the scene has no activity %u", caller, (unsigned)activity);
}

/* 0 stands for what it needs; a negative one is no such thing inside. */
static lmn_status take_seconds(double *out, double given, const char *caller, lmn_error *error)
{
    const char *fault = given == 0 ? NULL : behaviour_duration_fault(given);
    *out = given == 0 ? -1 : given;
    return fault ? error_set(error, LMN_USAGE, "%s: %s, and this is %g", caller, fault, given) : LMN_OK;
}

static lmn_status take_name(behaviour_node *n, const char *name, lmn_error *error)
{
    return content_copy_name(&n->name, name) ? LMN_OK : error_memory(error);
}

/* Takes the node over, or ends it. */
static lmn_status put(lmn_scene *scene, int32_t index, behaviour_node *n, lmn_status status, uint32_t *out,
                      lmn_error *error)
{
    int32_t made = NONE;
    work    w;
    work_begin(&w, NULL, NULL);
    if (status == LMN_OK)
        status = as_usage(behaviour_put(scene, index, n, &made, error), error);
    status = status == LMN_OK ? work_end_done(&w) : work_end(&w, status, error);
    if (status != LMN_OK)
        behaviour_node_release(n);
    else if (out)
        *out = (uint32_t)made + 1;
    return status;
}

/* --- groups, modifiers, clips and events -------------------------------------------------------------------- */

static lmn_status take_children(behaviour_node *n, const lmn_scene *scene, const lmn_activity_desc *d,
                                const char *caller, lmn_error *error)
{
    if (d->child_count && !d->children)
        return error_set(error, LMN_USAGE, "%s: `children` is NULL", caller);
    n->children = d->child_count ? mem_calloc(d->child_count, sizeof *n->children) : NULL;
    if (d->child_count && !n->children)
        return error_memory(error);
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < d->child_count && status == LMN_OK; i++) {
        const lmn_activity_child *c = &d->children[i];
        behaviour_child          *to = &n->children[n->child_count++];
        *to = (behaviour_child){(int32_t)c->activity - 1, 0, -1};
        status = check_activity(scene, c->activity, caller, error);
        if (status != LMN_OK || d->kind != LMN_ACTIVITY_TABLE)
            continue;
        const char *fault = behaviour_start_fault(c->start_s);
        to->start = c->start_s;
        status = fault ? error_set(error, LMN_USAGE, "%s: %s, and this is %g", caller, fault, c->start_s)
                       : take_seconds(&to->duration, c->duration_s, caller, error);
    }
    return status;
}

static lmn_status take_clip(behaviour_node *n, const lmn_scene *scene, const char *clip, const char *caller,
                            lmn_error *error)
{
    moment when;
    if (!clip)
        return error_set(error, LMN_USAGE, "%s: `clip` is NULL", caller);
    lmn_status status = moment_find(&when, scene, clip, 0, NULL, error);
    if (status == LMN_OK)
        n->clip = (int32_t)when.clips[0];
    return status;
}

static lmn_status make_activity(behaviour_node *out, const lmn_scene *scene, const lmn_activity_desc *d,
                                const char *caller, lmn_error *error)
{
    static const behaviour_fit fits[] = {FIT_START, FIT_CENTRE, FIT_END, FIT_STRETCH, FIT_SHRINK};
    *out = behaviour_blank((behaviour_kind)d->kind);
    lmn_status status = content_check_range((double)d->kind, 0, LMN_ACTIVITY_EVENT, "the kind", caller, error);
    if (status == LMN_OK && d->kind == LMN_ACTIVITY_CONSTRAINT)
        status = error_set(error, LMN_USAGE, "%s: constraints are made by lmn_behaviour_add_constraint", caller);
    if (status == LMN_OK)
        status = content_check_range((double)d->fit, 0, LMN_FIT_SHRINK, "the fit", caller, error);
    if (status == LMN_OK)
        status = take_seconds(&out->duration, d->duration_s, caller, error);
    if (status == LMN_OK)
        status = take_name(out, d->name, error);
    if (status != LMN_OK)
        return status;
    out->fit = fits[d->fit];
    out->times = d->times;
    out->exponent = d->kind == LMN_ACTIVITY_CREEP ? d->exponent : 1;
    if (d->kind < LMN_ACTIVITY_CONSTRAINT)
        return take_children(out, scene, d, caller, error);
    if (d->kind == LMN_ACTIVITY_CLIP)
        return take_clip(out, scene, d->clip, caller, error);
    out->target = content_index(d->node);
    return d->node ? content_check_node(scene, d->node, caller, error) : LMN_OK;
}

static lmn_status put_activity(lmn_scene *scene, int32_t index, const lmn_activity_desc *desc, uint32_t *out,
                               const char *caller, lmn_error *error)
{
    lmn_activity_desc full = LMN_ACTIVITY_DESC_INIT;
    behaviour_node    n;
    lmn_status        status = desc_complete(&full, sizeof full, desc, "LMN_ACTIVITY_DESC_INIT", error);
    if (status != LMN_OK)
        return status;
    status = make_activity(&n, scene, &full, caller, error);
    return put(scene, index, &n, status, out, error);
}

lmn_status lmn_behaviour_add(lmn_scene *scene, const lmn_activity_desc *desc, uint32_t *out, lmn_error *error)
{
    lmn_status status = content_check_scene(scene, "lmn_behaviour_add", error);
    return status == LMN_OK ? put_activity(scene, NONE, desc, out, "lmn_behaviour_add", error) : status;
}

lmn_status lmn_behaviour_set(lmn_scene *scene, uint32_t activity, const lmn_activity_desc *desc, lmn_error *error)
{
    const char *caller = "lmn_behaviour_set";
    lmn_status  status = content_check_scene(scene, caller, error);
    if (status == LMN_OK)
        status = check_activity(scene, activity, caller, error);
    return status == LMN_OK ? put_activity(scene, content_index(activity), desc, NULL, caller, error) : status;
}

/* --- constraints -------------------------------------------------------------------------------------------- */

/* A callback in the caller's units. */
typedef struct foreign {
    lmn_behaviour_fn         function;
    lmn_behaviour_release_fn release;
    void                    *user;
    size_t                   count;
    double                   unit;
    bool                     is_colour;
} foreign;

static double to_linear(double encoded)
{
    return (double)colour_to_linear((float)encoded);
}

static void call_foreign(double seconds, double *out, void *user)
{
    const foreign *f = user;
    f->function(seconds, out, f->user);
    for (size_t k = 0; k < f->count; k++)
        out[k] = f->is_colour ? to_linear(out[k]) : out[k] * f->unit;
}

static void release_foreign(void *user)
{
    foreign *f = user;
    if (f->release)
        f->release(f->user);
    mem_free(f);
}

static lmn_status take_callback(behaviour_map *m, const lmn_constraint_desc *d, double unit, const char *caller,
                                lmn_error *error)
{
    if (!d->function)
        return error_set(error, LMN_USAGE, "%s: `function` is NULL", caller);
    foreign *f = mem_alloc(sizeof *f);
    if (!f)
        return error_memory(error);
    *f = (foreign){d->function, NULL, d->function_user, m->components, unit, d->property == LMN_PROPERTY_LIGHT_COLOUR};
    m->function = call_foreign;
    m->release = release_foreign;
    m->user = f;
    return LMN_OK;
}

static lmn_status take_values(behaviour_map *m, const lmn_constraint_desc *d, double unit, const char *caller,
                              lmn_error *error)
{
    const size_t numbers = d->value_count * m->components;
    if (d->value_count && !d->values)
        return error_set(error, LMN_USAGE, "%s: `values` is NULL", caller);
    if (m->components && d->value_count > VALUES_MAX / m->components)
        return error_set(error, LMN_LIMIT, "%s: more than %d numbers", caller, VALUES_MAX);
    if (numbers == 0)
        return LMN_OK; /* which is no map: the check says so */
    m->values = mem_copy(d->values, numbers * sizeof *m->values);
    m->times =
        d->times_s && d->map == LMN_TIME_MAP_LINEAR ? mem_copy(d->times_s, d->value_count * sizeof *m->times) : NULL;
    if (!m->values || (d->times_s && d->map == LMN_TIME_MAP_LINEAR && !m->times))
        return error_memory(error);
    m->value_count = d->value_count;
    for (size_t i = 0; i < numbers; i++)
        m->values[i] = d->property == LMN_PROPERTY_LIGHT_COLOUR ? to_linear(m->values[i]) : m->values[i] * unit;
    return LMN_OK;
}

/* What was given, unless it is 0 0 0. */
static void take_vector(double out[3], const double given[3])
{
    if (given[0] != 0 || given[1] != 0 || given[2] != 0)
        vector3_copy(out, given);
}

static lmn_status take_function(behaviour_node *n, const lmn_scene *scene, const lmn_constraint_desc *d, double unit,
                                const char *caller, lmn_error *error)
{
    behaviour_map *m = &n->map;
    take_vector(m->gravity, d->gravity);
    vector3_copy(m->start, d->start);
    vector3_copy(m->velocity, d->map == LMN_TIME_MAP_OSCILLATE ? d->amplitude : d->velocity);
    if (d->map == LMN_TIME_MAP_OSCILLATE)
        for (int k = 0; k < 3; k++) {
            m->start[k] *= unit;
            m->velocity[k] *= unit;
        }
    else if (!d->start_given && n->path == PATH_TRANSLATION)
        schedule_rest(scene, n->path, n->target, m->start);
    m->floor = d->floor_height;
    m->restitution = d->restitution;
    m->frequency = d->frequency;
    m->phase = d->map == LMN_TIME_MAP_SPIN ? d->phase_deg * DEGREE : d->phase;
    m->rate = d->rate_deg * DEGREE;
    m->delay = d->delay_s;
    vector3_copy(m->offset, d->offset);
    if (d->map != LMN_TIME_MAP_FOLLOW)
        return LMN_OK;
    m->other = content_index(d->follows);
    return content_check_node(scene, d->follows, caller, error);
}

static lmn_status take_map(behaviour_node *n, const lmn_scene *scene, const lmn_constraint_desc *d, const char *caller,
                           lmn_error *error)
{
    behaviour_map *m = &n->map;
    const double   unit = n->about || n->path == PATH_CAMERA_FOV ? DEGREE : 1;
    map_defaults(m, scene);
    m->kind = (map_kind)d->map;
    m->components = n->about ? 1 : d->map == LMN_TIME_MAP_TANGENT ? 3 : behaviour_components(scene, n->path, n->target);
    m->curve = d->curve == LMN_CURVE_BEZIER ? CURVE_BEZIER : CURVE_CATMULL_ROM;
    m->closed = d->closed;
    m->by_length = d->by_length;
    take_vector(m->axis, d->axis);
    vector3_copy(n->axis, m->axis);
    take_vector(m->forward, d->forward);
    take_vector(m->up, d->up);
    if (d->map <= LMN_TIME_MAP_TANGENT)
        return take_values(m, d, d->map == LMN_TIME_MAP_TANGENT ? 1 : unit, caller, error);
    if (d->map == LMN_TIME_MAP_CALLBACK)
        return take_callback(m, d, unit, caller, error);
    return take_function(n, scene, d, unit, caller, error);
}

static lmn_status make_constraint(behaviour_node *out, const lmn_scene *scene, const lmn_constraint_desc *d,
                                  const char *caller, lmn_error *error)
{
    *out = behaviour_blank(BEHAVIOUR_CONSTRAINT);
    lmn_status status =
        content_check_range((double)d->property, 0, LMN_PROPERTY_LIGHT_INTENSITY, "the property", caller, error);
    if (status == LMN_OK)
        status = content_check_range((double)d->map, 0, LMN_TIME_MAP_CALLBACK, "the map", caller, error);
    if (status == LMN_OK)
        status = content_check_range((double)d->curve, 0, LMN_CURVE_BEZIER, "the curve", caller, error);
    if (status == LMN_OK)
        status = content_check_node(scene, d->node, caller, error);
    if (status == LMN_OK)
        status = take_seconds(&out->duration, d->duration_s, caller, error);
    if (status == LMN_OK)
        status = take_name(out, d->name, error);
    if (status != LMN_OK)
        return status;
    out->path = (animation_path)d->property;
    out->about = d->about_axis;
    out->target = behaviour_target_of(scene, out->path, content_index(d->node));
    if (out->target == NONE)
        return error_set(error, LMN_USAGE, "%s: node %u has no %s", caller, (unsigned)d->node,
                         animation_thing_of(out->path) == ANIMATED_CAMERA ? "camera" : "light");
    return take_map(out, scene, d, caller, error);
}

static lmn_status put_constraint(lmn_scene *scene, int32_t index, const lmn_constraint_desc *desc, uint32_t *out,
                                 const char *caller, lmn_error *error)
{
    lmn_constraint_desc full = LMN_CONSTRAINT_DESC_INIT;
    behaviour_node      n;
    uint32_t            made = 0;
    lmn_status          status = desc_complete(&full, sizeof full, desc, "LMN_CONSTRAINT_DESC_INIT", error);
    if (status != LMN_OK)
        return status;
    status = make_constraint(&n, scene, &full, caller, error);
    void *callback = status == LMN_OK && n.map.kind == MAP_CALLBACK ? n.map.user : NULL;
    status = put(scene, index, &n, status, &made, error);
    if (status == LMN_OK && callback)
        ((foreign *)callback)->release = full.release; /* from now on it is the scene's */
    if (status == LMN_OK && out)
        *out = made;
    return status;
}

lmn_status lmn_behaviour_add_constraint(lmn_scene *scene, const lmn_constraint_desc *desc, uint32_t *out,
                                        lmn_error *error)
{
    const char *caller = "lmn_behaviour_add_constraint";
    lmn_status  status = content_check_scene(scene, caller, error);
    return status == LMN_OK ? put_constraint(scene, NONE, desc, out, caller, error) : status;
}

lmn_status lmn_behaviour_set_constraint(lmn_scene *scene, uint32_t activity, const lmn_constraint_desc *desc,
                                        lmn_error *error)
{
    const char *caller = "lmn_behaviour_set_constraint";
    lmn_status  status = content_check_scene(scene, caller, error);
    if (status == LMN_OK)
        status = check_activity(scene, activity, caller, error);
    return status == LMN_OK ? put_constraint(scene, content_index(activity), desc, NULL, caller, error) : status;
}

/* --- what plays ------------------------------------------------------------------------------------------------ */

lmn_status lmn_behaviour_play(lmn_scene *scene, const uint32_t *activities, size_t count, lmn_error *error)
{
    const char *caller = "lmn_behaviour_play";
    lmn_status  status = content_check_scene(scene, caller, error);
    if (status == LMN_OK && !activities)
        status = error_set(error, LMN_USAGE, "%s: `activities` is NULL", caller);
    if (status == LMN_OK)
        status = content_check_range((double)count, 1, BEHAVIOUR_SPANS_MAX, "the number of activities", caller, error);
    for (size_t i = 0; i < count && status == LMN_OK; i++)
        status = check_activity(scene, activities[i], caller, error);
    if (status != LMN_OK)
        return status;
    int32_t *roots = mem_alloc(count * sizeof *roots);
    if (!roots)
        return error_memory(error);
    for (size_t i = 0; i < count; i++)
        roots[i] = content_index(activities[i]);
    work w;
    work_begin(&w, NULL, NULL);
    status = as_usage(behaviour_play(scene, roots, count, error), error);
    status = status == LMN_OK ? work_end_done(&w) : work_end(&w, status, error);
    mem_free(roots);
    return status;
}

lmn_status lmn_behaviour_stop(lmn_scene *scene, lmn_error *error)
{
    lmn_status status = content_check_scene(scene, "lmn_behaviour_stop", error);
    if (status == LMN_OK)
        behaviour_stop(scene);
    return status;
}

size_t lmn_behaviour_count(const lmn_scene *scene)
{
    return scene && scene->behaviour ? scene->behaviour->node_count : 0;
}

uint32_t lmn_behaviour_root_at(const lmn_scene *scene, size_t index)
{
    return scene && scene->behaviour && index < scene->behaviour->root_count
               ? (uint32_t)scene->behaviour->roots[index] + 1
               : 0;
}
