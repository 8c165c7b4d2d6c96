/* Arrows along a way: past and present solid, future dashed. Nienhaus 2005, section 7.6, figure 7-5. */
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "depict/depict_private.h"

/* --- along a way ----------------------------------------------------------------------------------------------------
 */

typedef struct course {
    const double (*points)[3];
    double *lengths; /* up to each point */
    size_t  count;
} course;

static double course_end(const course *c)
{
    return c->lengths[c->count - 1];
}

static void course_at(const course *c, double length, double out[3])
{
    size_t i = 1;
    while (i + 1 < c->count && c->lengths[i] < length)
        i++;
    double piece = c->lengths[i] - c->lengths[i - 1], f = piece > 0 ? (length - c->lengths[i - 1]) / piece : 0;
    vector3_mix(out, c->points[i - 1], c->points[i], fmin(fmax(f, 0), 1));
}

/* A piece of it as a ribbon, with all corners between; `tail` and `tip` are widths at the whole course's ends. */
static void put_piece(glyph_mesh *m, const depict_job *j, const course *c, double from, double to, double tail,
                      double tip)
{
    double(*points)[3] = mem_alloc((c->count + 2) * sizeof *points),
    *widths = mem_alloc((c->count + 2) * sizeof *widths);
    size_t count = 0;
    m->failed = m->failed || !points || !widths;
    for (size_t i = 0; i < c->count + 2 && !m->failed; i++) {
        double at = i == 0 ? from : i == c->count + 1 ? to : c->lengths[i - 1];
        if (i > 0 && i <= c->count && (at <= from || at >= to))
            continue;
        course_at(c, at, points[count]);
        widths[count++] = tail + (tip - tail) * at / course_end(c);
    }
    if (!m->failed && to > from)
        glyph_put_ribbon(m, j, &(glyph_ribbon){(const double(*)[3])points, widths, count});
    mem_free(points);
    mem_free(widths);
}

static void put_head(glyph_mesh *m, const depict_job *j, const course *c, double base, double end, double width)
{
    double points[2][3], widths[2] = {2.6 * width, 0};
    course_at(c, base, points[0]);
    course_at(c, end, points[1]);
    /* Straight on where the way's last bit is too short to say where to. */
    glyph_put_ribbon(m, j, &(glyph_ribbon){(const double(*)[3])points, widths, 2});
}

void glyph_put_arrow(glyph_mesh *m, const depict_job *j, const double (*points)[3], size_t count,
                     const arrow_style *style)
{
    course c = {points, mem_alloc((count + 1) * sizeof(double)), count};
    m->failed = m->failed || !c.lengths;
    for (size_t i = 0; i < count && !m->failed; i++)
        c.lengths[i] = i == 0 ? 0 : c.lengths[i - 1] + vector3_distance(points[i - 1], points[i]);
    if (!m->failed && count > 1 && course_end(&c) > 0) {
        double end = fmax(course_end(&c) - style->short_of, course_end(&c) * 0.3);
        double head = fmin(style->head * style->width, end * 0.6), body = end - head;
        double step = style->dash > 0 ? style->dash + style->gap : body;
        for (double from = 0; from < body && step > 0 && !m->failed; from += step)
            put_piece(m, j, &c, from, fmin(from + (style->dash > 0 ? style->dash : body), body),
                      style->tail * style->width, style->width);
        if (head > 0)
            put_head(m, j, &c, body, end, style->width);
    }
    mem_free(c.lengths);
}

colour depict_tint(glyph_tense when, colour wanted)
{
    static const colour tints[] = {[GLYPH_PAST] = {0.72f, 0.74f, 0.78f, 1},
                                   [GLYPH_PRESENT] = {0.93f, 0.62f, 0.15f, 1},
                                   [GLYPH_FUTURE] = {0.87f, 0.25f, 0.19f, 1}};
    return wanted.a > 0 ? wanted : tints[when];
}

/* --- the way of a thing ------------------------------------------------------------------------------------------- */

typedef struct path_values {
    int32_t pieces;
    float   width, head, tail, dash, gap, offset, short_of;
    colour  colour;
} path_values;

static const param path_params[] = {
    PARAM_INT_ROW(
        path_values, pieces, .def = 1, .min = 1, .max = 64, .soft_max = 12, .unit = UNIT_COUNT,
        .doc = "Arrows one behind the other, each for the same time, so that they are longer where it is faster."),
    PARAM_FLOAT_ROW(path_values, width, .def = 0.25, .min = 0.001, .max = 10, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "Breadth of the arrow, fraction of its target's radius."),
    PARAM_FLOAT_ROW(path_values, head, .def = 3, .min = 0, .max = 20, .soft_max = 8,
                    .doc = "Length of the head, in breadths; 0: none."),
    PARAM_FLOAT_ROW(path_values, tail, .def = 0.35, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Breadth where it begins, fraction of where it ends."),
    PARAM_FLOAT_ROW(path_values, dash, .def = 2.5, .min = 0.1, .max = 100, .soft_max = 8,
                    .doc = "Length of the future's dashes, in breadths."),
    PARAM_FLOAT_ROW(path_values, gap, .def = 1.4, .min = 0.1, .max = 100, .soft_max = 8,
                    .doc = "Gaps between them, in breadths."),
    PARAM_FLOAT_ROW(path_values, offset, .def = 0, .min = -100, .max = 100, .soft_min = -2, .soft_max = 2,
                    .unit = UNIT_FRACTION,
                    .doc = "How far it lies above the way of the target's middle, fraction of the radius."),
    PARAM_FLOAT_ROW(
        path_values, short_of, .def = 1.2, .min = 0, .max = 100, .soft_max = 3, .unit = UNIT_FRACTION,
        .doc = "How far before the way's end it ends, so that a ghost image there leaves the head to be seen; radii."),
    PARAM_COLOUR_ROW(path_values, colour, .def_colour = {0, 0, 0, 0},
                     .doc = "Of the arrow; none: grey for the past, red for the future."),
};

static lmn_status put_way(depict_job *j, const expression *e, const depict_target *t, double from, double to,
                          glyph_tense when, bool has_head, lmn_error *error)
{
    const path_values *v = e->values;
    trajectory         way;
    glyph_mesh         m = {0};
    lmn_status         status = way_trajectory(&way, &t->way, t->centre, from, to, t->radius * 0.01, error);
    double(*points)[3] = status == LMN_OK ? mem_alloc(way.count * sizeof *points) : NULL;
    if (status == LMN_OK && !points)
        status = error_memory(error);
    const double width = (double)v->width * t->radius;
    for (size_t i = 0; i < way.count && status == LMN_OK; i++)
        vector3_add(points[i], way.samples[i].position, (double)v->offset * t->radius, j->camera.up);
    if (status == LMN_OK) {
        const arrow_style style = {width,
                                   when == GLYPH_FUTURE ? (double)v->dash * width : 0,
                                   (double)v->gap * width,
                                   when == GLYPH_FUTURE ? 1 : (double)v->tail,
                                   has_head ? (double)v->head : 0,
                                   has_head && v->pieces == 1 ? (double)v->short_of * t->radius : 0};
        glyph_put_arrow(&m, j, (const double(*)[3])points, way.count, &style);
        status = glyph_put(j, &m, &(glyph_label){"arrow", e->target, when, depict_tint(when, v->colour)}, error);
    }
    glyph_mesh_release(&m);
    mem_free(points);
    trajectory_release(&way);
    return status;
}

/* Split, each piece is an arrow of its own. Nienhaus 2005, section 7.10, figure 7-11. */
static lmn_status put_pieces(depict_job *j, const expression *e, const depict_target *t, double from, double to,
                             glyph_tense when, bool is_last, lmn_error *error)
{
    const path_values *v = e->values;
    const double       whole = (e->to - e->from) / v->pieces;
    lmn_status         status = LMN_OK;
    for (int i = 0; i < v->pieces && status == LMN_OK; i++) {
        double begin = fmax(from, e->from + i * whole),
               end = fmin(to, i + 1 == v->pieces ? e->to : e->from + (i + 1) * whole);
        if (end - begin > 1e-9 * (e->to - e->from))
            status = put_way(j, e, t, begin, end, when, v->pieces > 1 || is_last, error);
    }
    return status;
}

static lmn_status path_depict(depict_job *j, const expression *e, lmn_error *error)
{
    depict_target t;
    lmn_status    status = target_open(&t, j, e->target, error);
    bool          has_future = e->to > e->now;
    if (status == LMN_OK && e->now > e->from)
        status = put_pieces(j, e, &t, e->from, fmin(e->now, e->to), GLYPH_PAST, !has_future, error);
    if (status == LMN_OK && has_future)
        status = put_pieces(j, e, &t, fmax(e->now, e->from), e->to, GLYPH_FUTURE, true, error);
    target_release(&t);
    return status;
}

const depiction depiction_path = {
    "path",
    NULL,
    "An arrow along the way of the target's middle: solid up to now, dashed where it will be.",
    path_params,
    PARAM_COUNT(path_params),
    sizeof(path_values),
    false,
    path_depict,
};
