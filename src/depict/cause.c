/* What set something off: a ghost image of what did it, and an arrow from there to what it did it to. Nienhaus 2005,
 * section 7.10, figure 7-11. */
#include "base/error.h"
#include "base/memory.h"
#include "depict/page.h"

typedef struct cause_values {
    float  at, width;
    bool   ghost;
    colour colour;
} cause_values;

static const param cause_params[] = {
    PARAM_FLOAT_ROW(cause_values, at, .def = 0, .min = 0, .max = 1e9, .can_auto = true, .def_auto = true,
                    .doc = "When it happens, seconds; auto: the strongest impact, or else where the target begins to "
                           "move."),
    PARAM_FLOAT_ROW(cause_values, width, .def = 0.35, .min = 0.001, .max = 10, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "Breadth of the arrow, fraction of the target's radius."),
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

static lmn_status put_cause(depict_job *j, const expression *e, const depict_target *t, const depict_target *partner,
                            double event, lmn_error *error)
{
    const cause_values *v = e->values;
    double              points[2][3], begin[3], moved[3], along[3];
    glyph_mesh          m = {0};
    way_point(&partner->way, partner->centre, event, points[0]);
    vector3_copy(begin, points[0]);
    way_point(&t->way, t->centre, event, points[1]);
    way_point(&partner->way, partner->centre, fmin(fmax(e->now, 0), e->to), moved);
    vector3_add(along, points[1], -1, points[0]);
    const double apart = vector3_length(along);
    /* From the partner's surface to that of the target, or over what there is between the middles. */
    if (apart > 0)
        for (int k = 0; k < 3; k++) {
            points[0][k] += along[k] * fmin(partner->radius / apart, 0.4);
            points[1][k] -= along[k] * fmin(t->radius / apart, 0.15);
        }
    for (int i = 0; i < 2; i++)
        depict_lift(j, points[i], depict_front(j, points[i]));
    glyph_put_arrow(&m, j, (const double(*)[3])points, 2,
                    &(arrow_style){.width = (double)v->width * t->radius, .tail = 0.5, .head = 2.2});
    lmn_status status = glyph_put(j, &m, &(glyph_label){"cause-arrow", e->target, GLYPH_PAST, v->colour}, error);
    glyph_mesh_release(&m);
    /* One that is still there is its own image. */
    if (status == LMN_OK && v->ghost && vector3_distance(begin, moved) > 0.05 * partner->radius)
        status = put_ghost(j, e, event, error);
    return status;
}

static lmn_status cause_depict(depict_job *j, const expression *e, lmn_error *error)
{
    depict_target t = {0}, partner = {0};
    double        event = e->from;
    if (e->partner == NONE)
        return error_set(error, LMN_USAGE, "'cause' needs \"partner\", what did it");
    lmn_status status = target_open(&t, j, e->target, error);
    if (status == LMN_OK)
        status = target_open(&partner, j, e->partner, error);
    if (status == LMN_OK)
        status = find_event(&event, e, &t, error);
    if (status == LMN_OK)
        status = put_cause(j, e, &t, &partner, event, error);
    target_release(&t);
    target_release(&partner);
    return status;
}

const depiction depiction_cause = {
    "cause",
    NULL,
    "What set the target off: a ghost image of \"partner\" when it did, and an arrow from it to the target.",
    cause_params,
    PARAM_COUNT(cause_params),
    sizeof(cause_values),
    false,
    cause_depict,
};
