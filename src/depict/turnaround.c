/* What turns: a bent arrow around its axis, or, where it moves on at the same time, a helix. Nienhaus 2005, section
 * 7.10, figures 7-9 and 7-10. */
#include "base/error.h"
#include "base/memory.h"
#include "depict/page.h"
#include "depict/turning.h"

typedef struct turn_values {
    float  radius, width, head;
    bool   before;
    colour colour;
} turn_values;

static const param turn_params[] = {
    PARAM_FLOAT_ROW(turn_values, radius, .def = 1.25, .min = 0.01, .max = 100, .soft_max = 3, .unit = UNIT_FRACTION,
                    .doc = "Of the bend, in distances of the target's outermost point from the axis."),
    PARAM_FLOAT_ROW(turn_values, width, .def = 0.2, .min = 0.001, .max = 10, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "Breadth of the arrow, fraction of the target's radius."),
    PARAM_FLOAT_ROW(turn_values, head, .def = 2.6, .min = 0, .max = 20, .soft_max = 8,
                    .doc = "Length of the head, in breadths; 0: none."),
    PARAM_BOOL_ROW(turn_values, before, .def = 0,
                   .doc = "Before all that the scene has, so that what turns inside of something is told, too."),
    PARAM_COLOUR_ROW(turn_values, colour, .def_colour = {0, 0, 0, 0},
                     .doc = "Of the arrow; none: grey for the past, red for the future."),
};

static const double full_turn = 6.283185307179586;

/* --- bent arrows -------------------------------------------------------------------------------------------------- */

typedef struct bend {
    double middle[3], first[3], second[3]; /* axes of the circle: `first` is where it begins */
    double radius;
} bend;

/* Around the axis, at the end of the target that the viewer sees, or, where the axis lies across the line of sight, as
 * far up as it leaves the middle to be seen, such as a face; outside all of it. It begins where the middle does, if
 * that goes around, else so that its own middle faces the viewer. */
static void bend_place(bend *b, const depict_job *j, const expression *e, const depict_target *t, const turning *turn,
                       const vec3 *vertices, size_t count)
{
    const double above_middle = 0.6;
    double       centre[3], off[3], begin[3], to_eye[3], far = 0, near = 0, top = 0;
    way_point(&t->way, t->centre, fmin(fmax(e->now, e->from), e->to), centre);
    vector3_add(off, centre, -1, turn->pivot);
    vector3_add(b->middle, turn->pivot, vector3_dot(off, turn->axis), turn->axis);
    depict_to_eye(j, b->middle, to_eye);
    const double facing = vector3_dot(to_eye, turn->axis), upward = vector3_dot(turn->axis, j->camera.up);
    for (size_t i = 0; i < count; i++) {
        double p[3] = {(double)vertices[i].x, (double)vertices[i].y, (double)vertices[i].z};
        vector3_add(p, p, -1, b->middle);
        near = fmax(near, facing * vector3_dot(p, turn->axis));
        top = fmax(top, copysign(1, upward) * vector3_dot(p, turn->axis));
        vector3_add(p, p, -vector3_dot(p, turn->axis), turn->axis);
        far = fmax(far, vector3_length(p));
    }
    if (fabs(facing) > 0.3)
        vector3_add(b->middle, b->middle, near / facing + copysign(0.15 * t->radius, facing), turn->axis);
    else
        vector3_add(b->middle, b->middle, above_middle * upward * top, turn->axis);
    const turn_values *v = e->values;
    b->radius = (double)v->radius * (far > 0 ? far : t->radius);
    way_point(&t->way, t->centre, e->from, begin);
    vector3_add(begin, begin, -1, b->middle);
    vector3_add(begin, begin, -vector3_dot(begin, turn->axis), turn->axis);
    double back = 0;
    if (vector3_length(begin) < 0.25 * far || !vector3_normalise(begin)) {
        depict_to_eye(j, b->middle, begin);
        vector3_add(begin, begin, -vector3_dot(begin, turn->axis), turn->axis);
        back = fmin(turn->angle, full_turn) / 2;
        if (vector3_length(begin) < 1e-6) { /* the axis points at the viewer: symmetrical about the top */
            vector3_copy(begin, j->camera.up);
            vector3_add(begin, begin, -vector3_dot(begin, turn->axis), turn->axis);
        }
        vector3_normalise(begin);
    }
    double across[3];
    vector3_cross(across, turn->axis, begin);
    for (int k = 0; k < 3; k++) {
        b->first[k] = cos(back) * begin[k] - sin(back) * across[k];
        b->second[k] = cos(back) * across[k] + sin(back) * begin[k];
    }
}

static lmn_status put_bend(depict_job *j, const expression *e, const depict_target *t, const bend *b, double from,
                           double to, glyph_tense when, bool has_head, lmn_error *error)
{
    enum { STEPS = 64 };
    const turn_values *v = e->values;
    double             points[STEPS + 1][3];
    glyph_mesh         m = {0};
    for (int i = 0; i <= STEPS; i++) {
        const double angle = from + (to - from) * i / STEPS;
        vector3_add(points[i], b->middle, b->radius * cos(angle), b->first);
        vector3_add(points[i], points[i], b->radius * sin(angle), b->second);
    }
    const double      width = (double)v->width * t->radius * (v->before ? glyph_lift_before(j, points, STEPS + 1) : 1);
    const bool        future = when == GLYPH_FUTURE;
    const arrow_style style = {.width = width,
                               .dash = future ? 2.2 * width : 0,
                               .gap = 1.2 * width,
                               .tail = future ? 1 : 0.35,
                               .head = has_head ? (double)v->head : 0};
    glyph_put_arrow(&m, j, (const double(*)[3])points, STEPS + 1, &style);
    lmn_status status =
        glyph_put(j, &m, &(glyph_label){"bent-arrow", e->target, when, depict_tint(when, v->colour)}, error);
    glyph_mesh_release(&m);
    return status;
}

static lmn_status turnaround_depict(depict_job *j, const expression *e, lmn_error *error)
{
    /* The tip of a whole turn would lie on its tail. */
    const double  most = full_turn * 0.94;
    depict_target t;
    turning       turn = {.angle = 0};
    bend          b;
    vec3         *vertices = NULL;
    size_t        count = 0;
    lmn_status    status = target_open(&t, j, e->target, error);
    if (status == LMN_OK)
        status = target_vertices(&vertices, &count, j, &t, fmin(fmax(e->now, e->from), e->to), error);
    if (status == LMN_OK)
        turning_find(&turn, &t.way, e->from, e->to, e->now);
    if (status == LMN_OK && turn.angle > 1e-3) {
        const double shrink = fmin(1, most / turn.angle), until = turn.until * shrink, end = turn.angle * shrink;
        const bool   has_future = end - until > 1e-3;
        turn.angle = end;
        bend_place(&b, j, e, &t, &turn, vertices, count);
        if (until > 1e-3)
            status = put_bend(j, e, &t, &b, 0, until, GLYPH_PAST, !has_future, error);
        if (status == LMN_OK && has_future)
            status = put_bend(j, e, &t, &b, until, end, GLYPH_FUTURE, true, error);
    }
    mem_free(vertices);
    target_release(&t);
    return status;
}

const depiction depiction_turnaround = {
    "turnaround",
    NULL,
    "A bent arrow around the axis that the target turns about, as far as it turns; what turns more than once has one "
    "almost whole turn.",
    turn_params,
    PARAM_COUNT(turn_params),
    sizeof(turn_values),
    false,
    turnaround_depict,
};

/* --- helices ------------------------------------------------------------------------------------------------------ */

static const param spin_params[] = {
    PARAM_FLOAT_ROW(turn_values, radius, .def = 1, .min = 0.01, .max = 100, .soft_max = 3, .unit = UNIT_FRACTION,
                    .doc = "Distance from the way of the target's middle, in radii."),
    PARAM_FLOAT_ROW(turn_values, width, .def = 0.16, .min = 0.001, .max = 10, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "Breadth of the ribbon, fraction of the target's radius."),
    PARAM_FLOAT_ROW(turn_values, head, .def = 3, .min = 0, .max = 20, .soft_max = 8,
                    .doc = "Length of the arrow's head, in breadths; 0: none."),
    PARAM_COLOUR_ROW(turn_values, colour, .def_colour = {0, 0, 0, 0},
                     .doc = "Of the ribbon; none: grey for the past, red for the future."),
};

/* A point beside the middle, across the axis of turning, in the way's own axes. */
static void beside_middle(const depict_job *j, const expression *e, const depict_target *t, const turning *turn,
                          double out[3])
{
    const turn_values *v = e->values;
    double             at[3], across[3];
    mat4               world = way_world(&t->way, e->from), inverse = mat4_inverse(&world);
    way_point(&t->way, t->centre, e->from, at);
    vector3_cross(across, turn->axis, j->camera.up);
    if (vector3_length(across) < 1e-3)
        depict_to_eye(j, at, across);
    vector3_add(across, across, -vector3_dot(across, turn->axis), turn->axis);
    vector3_normalise(across);
    vector3_add(at, at, (double)v->radius * t->radius, across);
    for (int k = 0; k < 3; k++)
        out[k] = inverse.m[k] * at[0] + inverse.m[4 + k] * at[1] + inverse.m[8 + k] * at[2] + inverse.m[12 + k];
}

static lmn_status put_helix(depict_job *j, const expression *e, const depict_target *t, const double local[3],
                            double from, double to, glyph_tense when, bool has_head, lmn_error *error)
{
    const turn_values *v = e->values;
    trajectory         way;
    glyph_mesh         m = {0};
    const double       width = (double)v->width * t->radius;
    lmn_status         status = way_trajectory(&way, &t->way, local, from, to, t->radius * 0.01, error);
    double(*points)[3] = status == LMN_OK ? mem_alloc(way.count * sizeof *points) : NULL;
    if (status == LMN_OK && !points)
        status = error_memory(error);
    for (size_t i = 0; i < way.count && points; i++)
        vector3_copy(points[i], way.samples[i].position);
    if (status == LMN_OK) {
        const bool        future = when == GLYPH_FUTURE;
        const arrow_style style = {.width = width,
                                   .dash = future ? 2.5 * width : 0,
                                   .gap = 1.4 * width,
                                   .tail = future ? 1 : 0.4,
                                   .head = has_head ? (double)v->head : 0};
        glyph_put_arrow(&m, j, (const double(*)[3])points, way.count, &style);
        status = glyph_put(j, &m, &(glyph_label){"helix", e->target, when, depict_tint(when, v->colour)}, error);
    }
    glyph_mesh_release(&m);
    mem_free(points);
    trajectory_release(&way);
    return status;
}

static lmn_status tailspin_depict(depict_job *j, const expression *e, lmn_error *error)
{
    depict_target t;
    turning       turn = {.angle = 0};
    double        local[3];
    lmn_status    status = target_open(&t, j, e->target, error);
    const bool    has_future = e->to > e->now;
    if (status == LMN_OK)
        turning_find(&turn, &t.way, e->from, e->to, e->from);
    if (status == LMN_OK && turn.angle > 1e-3) {
        beside_middle(j, e, &t, &turn, local);
        if (e->now > e->from)
            status = put_helix(j, e, &t, local, e->from, fmin(e->now, e->to), GLYPH_PAST, !has_future, error);
        if (status == LMN_OK && has_future)
            status = put_helix(j, e, &t, local, fmax(e->now, e->from), e->to, GLYPH_FUTURE, true, error);
    }
    target_release(&t);
    return status;
}

const depiction depiction_tailspin = {
    "tailspin",
    NULL,
    "A helix around the way of what turns while it moves on: the way of a point beside its middle.",
    spin_params,
    PARAM_COUNT(spin_params),
    sizeof(turn_values),
    false,
    tailspin_depict,
};
