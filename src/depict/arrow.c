/* Arrows along a way: past and present solid, future dashed. Nienhaus 2005, section 7.6, figure 7-5. */
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "depict/course.h"
#include "depict/page.h"
#include "depict/rounded.h"

/* More cannot be told from a line on any page. */
enum { DASHES_MOST = 2000 };

/* --- along a way ----------------------------------------------------------------------------------------------------
 */

/* A piece of it as a ribbon, with all corners between; `tail` and `tip` are widths at the whole course's ends. */
static void put_piece(glyph_mesh *m, const depict_job *j, const course *c, double from, double to, double tail,
                      double tip)
{
    const size_t first = course_behind(c, from), last = course_behind(c, to), room = last - first + 3;
    double(*points)[3] = mem_alloc(room * sizeof *points), *widths = mem_alloc(room * sizeof *widths);
    size_t count = 0;
    m->failed = m->failed || !points || !widths;
    for (size_t i = 0; i < room && !m->failed; i++) {
        double at = i == 0 ? from : i == room - 1 ? to : c->lengths[first + i - 1];
        if (i > 0 && i < room - 1 && (at <= from || at >= to))
            continue;
        course_at(c, at, points[count]);
        widths[count++] = tail + (tip - tail) * at / course_end(c);
    }
    if (!m->failed && to > from)
        glyph_put_ribbon(m, j, &(glyph_ribbon){(const double(*)[3])points, widths, count});
    mem_free(points);
    mem_free(widths);
}

/* Straight, as the way's last stretch goes: where it bends, the body leads to its base. */
static void put_head(glyph_mesh *m, const depict_job *j, const course *c, double base, double end, double width)
{
    double points[2][3], widths[2] = {2.6 * width, 0};
    course_at(c, base, points[0]);
    course_at(c, end, points[1]);
    glyph_put_ribbon(m, j, &(glyph_ribbon){(const double(*)[3])points, widths, 2});
}

/* How long the head must be along the way to be nearly as long as wanted on the page, where the way leads towards the
 * viewer or away; as wanted where no length helps. */
static double head_length(const depict_job *j, const course *c, double end, double wanted)
{
    const double usual = fmin(wanted, end * 0.6), most = fmin(2.5 * wanted, end * 0.6);
    double       tip[3], to_eye[3];
    course_at(c, end, tip);
    depict_to_eye(j, tip, to_eye);
    for (double head = usual; head > 0 && head <= most; head *= 1.2) {
        double base[3];
        course_at(c, end - head, base);
        vector3_add(base, base, -1, tip);
        vector3_add(base, base, -vector3_dot(base, to_eye), to_eye);
        if (vector3_length(base) >= 0.8 * usual)
            return head;
    }
    return usual;
}

/* Of the whole arrow: lengths and widths of a run are those of its part. */
typedef struct arrow_part {
    double before, whole; /* lengths: of the runs in front of it, of all */
    bool   last;
} arrow_part;

/* Dashes, the last of which ends where the body does, so that none is a stub; each as long as the others. */
static void fit_dashes(const depict_job *j, double body, double *dash, double *step)
{
    const double gap = *step - *dash;
    if (body > DASHES_MOST * *step) { /* nobody could see them */
        warnings_add(j->warnings, WARNING_UNTOLD, "an arrow would have %.0f dashes; it has %d, which are longer",
                     body / *step, DASHES_MOST);
        *dash *= body / DASHES_MOST / *step;
        *step = body / DASHES_MOST;
        return;
    }
    const double count = fmax(round((body + gap) / *step), 1), factor = (body + gap) / (count * *step);
    *dash *= factor;
    *step *= factor;
}

static void put_run(glyph_mesh *m, const depict_job *j, const course *c, const arrow_style *style,
                    const arrow_part *part)
{
    const double length = course_end(c), end = part->last ? fmax(length - style->short_of, length * 0.3) : length,
                 head = part->last ? head_length(j, c, end, style->head * style->width) : 0, body = end - head;
    double       step = style->dash > 0 ? style->dash + style->gap : body, dash = style->dash > 0 ? style->dash : body;
    const double tail = style->tail * style->width, along = (1 - style->tail) * style->width / part->whole;
    if (style->dash > 0 && body > 0)
        fit_dashes(j, body, &dash, &step);
    for (int i = 0; i < DASHES_MOST && i * step < body * (1 - 1e-9) && step > 0 && !m->failed; i++)
        put_piece(m, j, c, i * step, fmin(i * step + dash, body), tail + along * part->before,
                  tail + along * (part->before + length));
    if (head > 0)
        put_head(m, j, c, body, end, style->width);
}

/* The run that gets the head: the last one that has room for it, or the longest. */
static size_t last_run(const rounded_way *way, const double *lengths, double room)
{
    size_t best = 0;
    double longest = 0;
    for (size_t r = way->run_count; r-- > 0;) {
        const rounded_run *run = &way->runs[r];
        const double       length = run->count ? lengths[run->first + run->count - 1] : 0;
        if (length >= room)
            return r;
        best = length > longest ? r : best;
        longest = fmax(longest, length);
    }
    return best;
}

void glyph_put_arrow(glyph_mesh *m, const depict_job *j, const double (*points)[3], size_t count,
                     const arrow_style *style)
{
    rounded_way way;
    arrow_part  part = {0, 0, false};
    rounded_make(&way, j, points, count, style->width);
    double *lengths = mem_alloc((way.point_count + 1) * sizeof *lengths);
    m->failed = m->failed || way.failed || !lengths;
    for (size_t r = 0; r < way.run_count && !m->failed; r++)
        for (size_t k = 0; k < way.runs[r].count; k++) {
            const size_t i = way.runs[r].first + k;
            lengths[i] = k == 0 ? 0 : lengths[i - 1] + vector3_distance(way.points[i - 1], way.points[i]);
            part.whole += k == 0 ? 0 : lengths[i] - lengths[i - 1];
        }
    const size_t last = m->failed ? 0 : last_run(&way, lengths, 1.5 * style->head * style->width);
    for (size_t r = 0; r < way.run_count && r <= last && !m->failed; r++) {
        const rounded_run *run = &way.runs[r];
        const course       c = {(const double(*)[3])way.points + run->first, lengths + run->first, run->count};
        part.last = r == last;
        if (run->count > 1 && course_end(&c) > 0) {
            put_run(m, j, &c, style, &part);
            part.before += course_end(&c);
        }
    }
    mem_free(lengths);
    rounded_release(&way);
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
    float   width, head, tail, dash, gap, offset, aside, short_of;
    bool    tip, before;
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
        path_values, aside, .def = 0, .min = -100, .max = 100, .soft_min = -2, .soft_max = 2, .unit = UNIT_FRACTION,
        .doc = "How far it lies to the left of the way, as it is seen, fraction of the radius: what goes back "
               "where it came from lies beside that."),
    PARAM_FLOAT_ROW(
        path_values, short_of, .def = 1.2, .min = 0, .max = 100, .soft_max = 3, .unit = UNIT_FRACTION,
        .doc = "How far before the way's end it ends, so that a ghost image there leaves the head to be seen; radii."),
    PARAM_BOOL_ROW(path_values, tip, .def = 0,
                   .doc = "The way of the place that is farthest from the target's origin, as of a limb's end, instead "
                          "of its middle's."),
    PARAM_BOOL_ROW(path_values, before, .def = 0,
                   .doc = "Before all that the scene has, on the lines of sight through the way, so that nothing hides "
                          "it."),
    PARAM_COLOUR_ROW(path_values, colour, .def_colour = {0, 0, 0, 0},
                     .doc = "Of the arrow; none: grey for the past, red for the future."),
};

/* Moves points to the left of the way that they make on the page, by as much all along it. */
static bool shift_aside(const depict_job *j, double (*points)[3], size_t count, double aside)
{
    double(*moved)[3] = mem_alloc((count + 1) * sizeof *moved);
    double left[3] = {0, 0, 0};
    for (size_t i = 0; i < count && moved; i++) {
        double along[3], to_eye[3], own[3];
        vector3_add(along, points[i + 1 < count ? i + 1 : i], -1, points[i > 0 ? i - 1 : 0]);
        depict_to_eye(j, points[i], to_eye);
        vector3_cross(own, to_eye, along);
        if (vector3_normalise(own)) /* where it goes towards the viewer it stays at its side */
            vector3_copy(left, own);
        vector3_add(moved[i], points[i], aside, left);
    }
    if (moved && count)
        memcpy(points, moved, count * sizeof *points);
    mem_free(moved);
    return moved != NULL;
}

double glyph_lift_before(const depict_job *j, double (*points)[3], size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const double far = vector3_distance(points[i], j->camera.eye);
        depict_lift(j, points[i], depict_front(j, points[i]));
        sum += j->camera.orthographic || !(far > 0) ? 1 : vector3_distance(points[i], j->camera.eye) / far;
    }
    return count ? sum / (double)count : 1;
}

static lmn_status put_way(depict_job *j, const expression *e, const depict_target *t, double from, double to,
                          glyph_tense when, bool has_head, lmn_error *error)
{
    const path_values *v = e->values;
    trajectory         way;
    glyph_mesh         m = {0};
    double             middle[3];
    way_point(&t->way, t->centre, fmin(fmax(e->now, from), to), middle);
    /* Finer than half a pixel of a large page nobody sees it. */
    const double fine = fmax(t->radius * 0.01, page_height(j, middle) / 4000);
    lmn_status   status = way_trajectory(&way, &t->way, t->centre, from, to, fine, error);
    double(*points)[3] = status == LMN_OK ? mem_alloc(way.count * sizeof *points) : NULL;
    if (status == LMN_OK && !points)
        status = error_memory(error);
    for (size_t i = 0; i < way.count && status == LMN_OK; i++)
        vector3_add(points[i], way.samples[i].position, (double)v->offset * t->radius, j->camera.up);
    if (status == LMN_OK && v->aside != 0 && !shift_aside(j, points, way.count, (double)v->aside * t->radius))
        status = error_memory(error);
    const double scale = v->before && status == LMN_OK ? glyph_lift_before(j, points, way.count) : 1;
    const double width = (double)v->width * t->radius * scale;
    if (status == LMN_OK) {
        const arrow_style style = {width,
                                   when == GLYPH_FUTURE ? (double)v->dash * width : 0,
                                   (double)v->gap * width,
                                   when == GLYPH_FUTURE ? 1 : (double)v->tail,
                                   has_head ? (double)v->head : 0,
                                   has_head && v->pieces == 1 ? (double)v->short_of * t->radius * scale : 0};
        glyph_put_arrow(&m, j, (const double(*)[3])points, way.count, &style);
        status = glyph_put(j, &m, &(glyph_label){"arrow", e->target, when, depict_tint(when, v->colour)}, error);
    }
    glyph_mesh_release(&m);
    mem_free(points);
    trajectory_release(&way);
    return status;
}

/* Does it go the same way again after `lap` seconds, as long as the interval lasts? */
static bool goes_again(const depict_target *t, double from, double to, double lap, double within)
{
    enum { STEPS = 128 };
    bool again = true;
    for (int i = 0; i <= STEPS && again; i++) {
        const double seconds = from + (to - lap - from) * i / STEPS;
        double       first[3], second[3];
        way_point(&t->way, t->centre, seconds, first);
        way_point(&t->way, t->centre, seconds + lap, second);
        again = vector3_distance(first, second) <= within;
    }
    return again;
}

/* How long it takes what goes round and round, or to and fro, before it does so again; 0: it does not. */
static lmn_status find_lap(double *lap, const depict_target *t, double from, double to, lmn_error *error)
{
    enum { TRIES = 64 };
    const double within = 0.01 * t->radius;
    trajectory   way;
    lmn_status   status = way_trajectory(&way, &t->way, t->centre, from, to, within, error);
    double       gone = 0;
    *lap = 0;
    for (size_t i = 1, tries = 0; i < way.count && status == LMN_OK && *lap == 0 && tries < TRIES; i++) {
        const double off = vector3_distance(way.samples[i].position, way.samples[0].position),
                     after = way.samples[i].seconds - from;
        gone = fmax(gone, off);
        if (2 * after > to - from)
            break;
        if (gone <= t->radius || off > within)
            continue;
        tries++;
        *lap = goes_again(t, from, to, after, within) ? after : 0;
    }
    trajectory_release(&way);
    return status == LMN_OK ? work_check(error) : status;
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
    if (status == LMN_OK && ((const path_values *)e->values)->tip)
        status = target_take_tip(&t, j, error);
    const bool has_future = e->to > e->now;
    double     lap = 0;
    if (status == LMN_OK && ((const path_values *)e->values)->pieces == 1)
        status = find_lap(&lap, &t, e->from, e->to, error);
    for (int future = 0; future < 2 && status == LMN_OK; future++) {
        double from = future ? fmax(e->now, e->from) : e->from, to = future ? e->to : fmin(e->now, e->to);
        if (!(to > from))
            continue;
        if (lap > 0) /* arrows on arrows are seen as one: the last lap, and the next one */
            *(future ? &to : &from) = future ? fmin(to, from + lap) : fmax(from, to - lap);
        status = put_pieces(j, e, &t, from, to, future ? GLYPH_FUTURE : GLYPH_PAST, future || !has_future, error);
    }
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
