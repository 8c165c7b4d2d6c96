/* Motion lines: from the target's rearmost positions back along the ways that they came, with strokes beside them as
 * of a quick hand. Nienhaus 2005, section 7.6, figure 7-6. */
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "depict/depict_private.h"

typedef struct motion_line_values {
    int32_t count, strokes;
    float   seconds, width, jitter, gap;
    colour  colour;
} motion_line_values;

static const param motion_params[] = {
    PARAM_INT_ROW(motion_line_values, count, .def = 7, .min = 1, .max = 100, .soft_max = 24, .unit = UNIT_COUNT,
                  .doc = "How many lines."),
    PARAM_FLOAT_ROW(motion_line_values, seconds, .def = 0.3, .min = 0.001, .max = 1000, .soft_max = 2,
                    .doc = "How much of the way a line shows, seconds."),
    PARAM_FLOAT_ROW(motion_line_values, width, .def = 0.05, .min = 0.001, .max = 2, .soft_max = 0.3,
                    .unit = UNIT_FRACTION, .doc = "Breadth where it begins, fraction of the target's radius."),
    PARAM_INT_ROW(motion_line_values, strokes, .def = 1, .min = 0, .max = 8, .unit = UNIT_COUNT,
                  .doc = "Shorter strokes beside each line."),
    PARAM_FLOAT_ROW(motion_line_values, jitter, .def = 0.3, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much lines differ in length, and how far strokes lie beside them."),
    PARAM_FLOAT_ROW(motion_line_values, gap, .def = 0.15, .min = 0, .max = 10, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "Distance from the target, in radii."),
    PARAM_COLOUR_ROW(motion_line_values, colour, .def_colour = {0.13f, 0.14f, 0.17f, 1}, .doc = "Of the lines."),
};

/* The rearmost vertex in each of `count` strips along the motion, as it is seen; NaN where a strip has none. */
static void find_rear(const depict_job *j, const vec3 *vertices, size_t count, const double velocity[3],
                      double (*rear)[3], int strips)
{
    double to_eye[3], way[3], across[3], low = INFINITY, high = -INFINITY;
    double first[3] = {(double)vertices[0].x, (double)vertices[0].y, (double)vertices[0].z};
    depict_to_eye(j, first, to_eye);
    vector3_add(way, velocity, -vector3_dot(velocity, to_eye), to_eye);
    vector3_normalise(way);
    vector3_cross(across, to_eye, way);
    for (size_t i = 0; i < count; i++) {
        double p[3] = {(double)vertices[i].x, (double)vertices[i].y, (double)vertices[i].z},
               at = vector3_dot(p, across);
        low = fmin(low, at);
        high = fmax(high, at);
    }
    for (int k = 0; k < strips; k++)
        rear[k][0] = NAN;
    for (size_t i = 0; i < count && high > low; i++) {
        double p[3] = {(double)vertices[i].x, (double)vertices[i].y, (double)vertices[i].z};
        int    k = (int)fmin((vector3_dot(p, across) - low) / (high - low) * strips, strips - 1);
        if (isnan(rear[k][0]) || vector3_dot(p, way) < vector3_dot(rear[k], way))
            vector3_copy(rear[k], p);
    }
}

/* Back along the way of what is at a place now. `beside` moves all of it. */
static void put_line(glyph_mesh *m, const depict_job *j, const expression *e, const depict_target *t,
                     const double at[3], double seconds, const double beside[3], double width)
{
    enum { STEPS = 24 };
    const motion_line_values *v = e->values;
    double points[STEPS + 1][3], widths[STEPS + 1], local[3], gap = (double)v->gap * t->radius, gone = 0;
    mat4   world = way_world(&t->way, e->now), inverse = mat4_inverse(&world);
    size_t count = 0;
    vec3   inside = mat4_transform_point(&inverse, (vec3){(float)at[0], (float)at[1], (float)at[2]});
    vector3_set(local, (double)inside.x, (double)inside.y, (double)inside.z);
    double last[3], back[3] = {0, 0, 0};
    vector3_copy(last, at);
    for (int i = 0; i <= STEPS; i++) {
        double ago = seconds * i / STEPS, p[3];
        if (e->now - ago < e->from)
            break;
        way_point(&t->way, local, e->now - ago, p);
        double step[3];
        vector3_add(step, p, -1, last);
        /* Where the way turns back a line would have a hook. */
        if (vector3_dot(step, back) < 0)
            break;
        if (vector3_length(step) > 1e-3 * t->radius)
            vector3_copy(back, step);
        gone += vector3_length(step);
        vector3_copy(last, p);
        if (gone < gap)
            continue;
        vector3_add(points[count], p, 1, beside);
        widths[count++] = width * (1 - (double)i / STEPS);
    }
    if (count > 1)
        glyph_put_ribbon(m, j, &(glyph_ribbon){(const double(*)[3])points, widths, count});
}

static void put_lines(glyph_mesh *m, const depict_job *j, const expression *e, const depict_target *t,
                      const double (*rear)[3])
{
    const motion_line_values *v = e->values;
    for (int k = 0; k < v->count; k++)
        for (int s = 0; s <= v->strokes && !isnan(rear[k][0]); s++) {
            const uint32_t what = (uint32_t)s * 4;
            double         beside[3] = {0, 0, 0}, shorter = s ? 0.5 : 1;
            for (int a = 0; a < 3 && s; a++)
                beside[a] = (double)v->jitter * 0.4 * t->radius *
                            (2 * depict_random(j, e, (uint32_t)k, what + (uint32_t)a) - 1);
            double part = 1 - (double)v->jitter * depict_random(j, e, (uint32_t)k, what + 3);
            put_line(m, j, e, t, rear[k], (double)v->seconds * part * shorter, beside,
                     (double)v->width * t->radius * (s ? 0.6 : 1));
        }
}

/* Joined with what tells of an impact of the same target, lines end where the last impact was: the star stands there.
 * Nienhaus 2005, section 7.10. */
static lmn_status find_begin(double *out, const depict_job *j, const expression *e, const depict_target *t,
                             lmn_error *error)
{
    enum { IMPACTS = 16 };
    depict_impact impacts[IMPACTS];
    size_t        count = 0;
    lmn_status    status = LMN_OK;
    *out = e->from;
    for (size_t i = 0; j->expressions && i < j->expressions->count && status == LMN_OK; i++) {
        const expression *other = &j->expressions->items[i];
        const double      from = fmax(other->from, e->from), to = fmin(other->to, e->to);
        if (strcmp(other->row->characteristic, "collision") != 0 || other->target != e->target || !(to > from))
            continue;
        status = target_impacts(impacts, IMPACTS, &count, t, from, to, error);
        for (size_t k = 0; k < count && status == LMN_OK; k++)
            if (impacts[k].time < e->now)
                *out = fmax(*out, impacts[k].time);
    }
    return status;
}

static lmn_status motion_depict(depict_job *j, const expression *wanted, lmn_error *error)
{
    expression                joined = *wanted;
    const expression         *e = &joined;
    const motion_line_values *v = e->values;
    depict_target             t;
    glyph_mesh                m = {0};
    vec3                     *vertices = NULL;
    size_t                    count = 0;
    double                    velocity[3], now[3];
    double(*rear)[3] = mem_alloc((size_t)v->count * sizeof *rear);
    lmn_status status = target_open(&t, j, e->target, error);
    if (status == LMN_OK && !rear)
        status = error_memory(error);
    if (status == LMN_OK)
        status = find_begin(&joined.from, j, wanted, &t, error);
    if (status == LMN_OK)
        status = target_vertices(&vertices, &count, j, &t, e->now, error);
    if (status == LMN_OK && count > 0) {
        way_point(&t.way, t.centre, e->now, now);
        way_point(&t.way, t.centre, fmax(e->now - (double)v->seconds, e->from), velocity);
        vector3_add(velocity, now, -1, velocity);
        if (vector3_length(velocity) > 1e-6 * t.radius) {
            find_rear(j, vertices, count, velocity, rear, v->count);
            put_lines(&m, j, e, &t, (const double(*)[3])rear);
        } else
            depict_say_nothing(j, "it rests at %g s", e->now);
        status = glyph_put(j, &m, &(glyph_label){"motion-lines", e->target, GLYPH_PAST, v->colour}, error);
    }
    glyph_mesh_release(&m);
    mem_free(vertices);
    mem_free(rear);
    target_release(&t);
    return status;
}

const depiction depiction_motion = {
    "motion",
    NULL,
    "Motion lines behind the target, along the way that it came.",
    motion_params,
    PARAM_COUNT(motion_params),
    sizeof(motion_line_values),
    false,
    motion_depict,
};
