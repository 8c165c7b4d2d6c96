/* What set something off: a ghost image of what did it, and an arrow along the way that the place which
 * did it went while it did; from what does not move, an arrow straight to what it did it to. Nienhaus 2005,
 * section 7.10, figure 7-11. */
#include "base/error.h"
#include "base/memory.h"
#include "contact/surface.h"
#include "depict/meeting.h"
#include "depict/page.h"

typedef struct cause_values {
    float  at, width, seconds;
    bool   ghost;
    colour colour;
} cause_values;

static const param cause_params[] = {
    PARAM_FLOAT_ROW(cause_values, at, .def = 0, .min = 0, .max = 1e9, .can_auto = true, .def_auto = true,
                    .doc = "When it happens, seconds; auto: the strongest impact, or else where the target begins to "
                           "move."),
    PARAM_FLOAT_ROW(cause_values, width, .def = 0.6, .min = 0.001, .max = 10, .soft_max = 2, .unit = UNIT_FRACTION,
                    .doc = "Breadth of the arrow, fraction of the target's radius."),
    PARAM_FLOAT_ROW(cause_values, seconds, .def = 0.5, .min = 0, .max = 1e6, .soft_max = 3,
                    .doc = "How much of what the partner did before it is told at most."),
    PARAM_BOOL_ROW(cause_values, ghost, .def = 1, .doc = "A ghost image of the partner as it was then."),
    PARAM_COLOUR_ROW(cause_values, colour, .def_colour = {0.42f, 0.25f, 0.6f, 1}, .doc = "Of the arrow."),
};

/* When the target begins to move within the interval; its begin where it does so before. */
static double begin_of_motion(const expression *e, const depict_target *t)
{
    enum { STEPS = 512 };
    double first[3], now[3];
    way_point(&t->way, t->centre, e->from, first);
    for (int i = 1; i <= STEPS; i++) {
        way_point(&t->way, t->centre, e->from + (e->to - e->from) * i / STEPS, now);
        if (vector3_distance(first, now) > 1e-3 * t->radius)
            return e->from + (e->to - e->from) * (i - 1) / STEPS;
    }
    return e->from;
}

static lmn_status find_event(double *out, const expression *e, const depict_target *t, lmn_error *error)
{
    const cause_values *v = e->values;
    depict_impact       impact;
    size_t              count = 0;
    *out = (double)v->at;
    if (!isnan(v->at))
        return LMN_OK;
    lmn_status status = target_impacts(&impact, 1, &count, t, e->from, e->to, error);
    *out = count ? impact.time : begin_of_motion(e, t);
    return status;
}

/* As the row of ghost images does it, of the partner at the event. */
static lmn_status put_ghost(depict_job *j, const expression *e, double event, lmn_error *error)
{
    const depiction *row = depiction_find("still", depict_semantics(j->scene, e->partner));
    expression       ghost = *e;
    ghost.row = row;
    ghost.target = e->partner;
    ghost.partner = NONE;
    ghost.now = event;
    ghost.values = mem_calloc(1, row->values_size);
    if (!ghost.values)
        return error_memory(error);
    params_set_defaults(row->params, row->param_count, ghost.values);
    lmn_status status = row->depict(j, &ghost, error);
    mem_free(ghost.values);
    return status;
}

/* The place of the partner that is nearest to the target when it happens, in the axes of what carries it. */
typedef struct doer {
    way    way;
    double local[3];
    double begin, end; /* of the act: it sets off, and they part */
} doer;

static lmn_status find_doer(doer *out, const depict_job *j, const depict_target *partner, const double at[3],
                            double event, lmn_error *error)
{
    double        place[3];
    int32_t       own = partner->node;
    const pose   *posed = NULL;
    surface_place nearest;
    bool          found = false;
    way_point(&partner->way, partner->centre, event, place);
    lmn_status status = depict_pose(&posed, j, event, error);
    if (status == LMN_OK)
        status = surface_nearest(&nearest, &found, posed, partner->parts, at, INFINITY, error);
    if (status == LMN_OK && found) {
        vector3_copy(place, nearest.place);
        own = j->scene->parts[nearest.part].node;
    }
    /* What has a skin goes where its hip goes. */
    if (status == LMN_OK)
        status = way_open(&out->way, j->scene,
                          j->scene->nodes[own].skin == NONE ? own : partner->way.steps[partner->way.count - 1].node,
                          &j->when, error);
    if (status == LMN_OK) {
        const mat4 world = way_world(&out->way, event), inverse = mat4_inverse(&world);
        for (int k = 0; k < 3; k++)
            out->local[k] =
                inverse.m[k] * place[0] + inverse.m[4 + k] * place[1] + inverse.m[8 + k] * place[2] + inverse.m[12 + k];
    }
    return status;
}

/* Back from the event for as long as the doer moves, and on for as long as both go together. */
static void find_act(doer *d, const expression *e, const depict_target *t, double event)
{
    enum { STEPS = 200 };
    const cause_values *v = e->values;
    const double        step = (e->to - e->from) / STEPS, slow = 0.02 * t->radius;
    double              last[3], now[3], at[3], beside[3];
    d->begin = d->end = event;
    way_point(&d->way, d->local, event, last);
    way_point(&t->way, t->centre, event, beside);
    for (int i = 1; i <= STEPS && event - step * i >= e->from && step * i <= (double)v->seconds; i++) {
        way_point(&d->way, d->local, event - step * i, now);
        if (vector3_distance(now, last) < slow)
            break;
        vector3_copy(last, now);
        d->begin = event - step * i;
    }
    way_point(&d->way, d->local, event, last);
    for (int i = 1; i <= STEPS && event + step * i <= e->to; i++) {
        double own[3], other[3], apart[3];
        way_point(&d->way, d->local, event + step * i, now);
        way_point(&t->way, t->centre, event + step * i, at);
        vector3_add(own, now, -1, last);
        vector3_add(other, at, -1, beside);
        vector3_add(apart, own, -1, other);
        if (vector3_length(apart) > 0.5 * fmax(vector3_length(own), vector3_length(other)))
            break;
        vector3_copy(last, now);
        vector3_copy(beside, at);
        d->end = event + step * i;
    }
}

/* The way of the doer's place while it acts; where that does not move, straight from the partner to the target. */
static lmn_status put_cause(depict_job *j, const expression *e, const depict_target *t, const depict_target *partner,
                            const doer *d, double event, lmn_error *error)
{
    enum { STEPS = 48 };
    const cause_values *v = e->values;
    double              points[STEPS + 1][3], along[3], gone = 0;
    glyph_mesh          m = {0};
    size_t              count = STEPS + 1;
    for (int i = 0; i <= STEPS; i++) {
        way_point(&d->way, d->local, d->begin + (d->end - d->begin) * i / STEPS, points[i]);
        gone += i ? vector3_distance(points[i], points[i - 1]) : 0;
    }
    if (gone < t->radius) {
        count = 2;
        way_point(&partner->way, partner->centre, event, points[0]);
        way_point(&t->way, t->centre, event, points[1]);
        vector3_add(along, points[1], -1, points[0]);
        const double apart = vector3_length(along);
        /* From the partner's surface to that of the target, or over what there is between the middles. */
        for (int k = 0; k < 3 && apart > 0; k++) {
            points[0][k] += along[k] * fmin(partner->radius / apart, 0.4);
            points[1][k] -= along[k] * fmin(t->radius / apart, 0.15);
        }
    }
    for (size_t i = 0; i < count; i++)
        depict_lift(j, points[i], depict_front(j, points[i]));
    glyph_put_arrow(&m, j, (const double(*)[3])points, count,
                    &(arrow_style){.width = (double)v->width * t->radius, .tail = 0.25, .head = 2.2});
    lmn_status status = glyph_put(j, &m, &(glyph_label){"cause-arrow", e->target, GLYPH_PAST, v->colour}, error);
    glyph_mesh_release(&m);
    return status;
}

/* One that is still as it was is its own image. */
static bool has_changed(const expression *e, const doer *d, double event)
{
    double then[3], now[3], other[3];
    way_point(&d->way, d->local, event, then);
    way_point(&d->way, d->local, fmin(fmax(e->now, 0), e->to), now);
    way_point(&d->way, (const double[3]){0, 0, 0}, event, other);
    return vector3_distance(then, now) > 0.02 * vector3_distance(then, other) + 1e-6;
}

static lmn_status cause_depict(depict_job *j, const expression *e, lmn_error *error)
{
    const cause_values *v = e->values;
    depict_target       t = {0}, partner = {0};
    doer                d = {0};
    double              event = e->from, at[3];
    if (e->partner == NONE)
        return error_set(error, LMN_USAGE, "'cause' needs \"partner\", what did it");
    lmn_status status = target_open(&t, j, e->target, error);
    if (status == LMN_OK)
        status = target_open(&partner, j, e->partner, error);
    if (status == LMN_OK)
        status = find_event(&event, e, &t, error);
    if (status == LMN_OK) {
        way_point(&t.way, t.centre, event, at);
        status = find_doer(&d, j, &partner, at, event, error);
    }
    if (status == LMN_OK) {
        find_act(&d, e, &t, event);
        if (v->ghost && has_changed(e, &d, event))
            status = put_ghost(j, e, event, error);
    }
    if (status == LMN_OK)
        status = put_cause(j, e, &t, &partner, &d, event, error);
    way_release(&d.way);
    target_release(&t);
    target_release(&partner);
    return status;
}

const depiction depiction_cause = {
    "cause",
    NULL,
    "What set the target off: a ghost image of \"partner\" as it was then, and an arrow along the way of the place "
    "that did "
    "it, as long as it did; from a partner that rests, straight to the target.",
    cause_params,
    PARAM_COUNT(cause_params),
    sizeof(cause_values),
    false,
    cause_depict,
};
