/* Many that part: explosions from one place, and one way that splits into several. Nienhaus 2005, section 7.10, figure
 * 7-9. */
#include "base/error.h"
#include "base/memory.h"
#include "depict/page.h"
#include "depict/pieces.h"

/* --- explosions --------------------------------------------------------------------------------------------------- */

typedef struct explode_values {
    param_words text;
    int32_t     form, spikes;
    float       size, width;
    bool        arrows;
    colour      colour, rim, letters, ways;
} explode_values;

static const char *const forms[] = {"star", "cloud", NULL};
enum { FORM_STAR, FORM_CLOUD };

static const param explode_params[] = {
    PARAM_TEXT_ROW(explode_values, text, .def_text = "BOOM", .example = "CRASH",
                   .doc = "The noise that it makes; \"|\" begins a line; empty: none."),
    PARAM_ENUM_ROW(explode_values, form, .names = forms, .def = FORM_STAR, .doc = "What is seen in the middle."),
    PARAM_INT_ROW(explode_values, spikes, .def = 15, .min = 3, .max = 64, .soft_max = 24, .unit = UNIT_COUNT,
                  .only_if = "form=star", .doc = "Spikes of the star."),
    PARAM_FLOAT_ROW(explode_values, size, .def = 1, .min = 0.01, .max = 100, .soft_max = 4, .unit = UNIT_FRACTION,
                    .doc = "Radius of star or cloud, in distances of the outermost piece from the middle before it."),
    PARAM_BOOL_ROW(explode_values, arrows, .def = 1, .doc = "An arrow for each piece, along its way."),
    PARAM_FLOAT_ROW(explode_values, width, .def = 0.3, .min = 0.001, .max = 10, .soft_max = 1, .unit = UNIT_FRACTION,
                    .only_if = "arrows", .doc = "Breadth of an arrow, fraction of its piece's radius."),
    PARAM_COLOUR_ROW(explode_values, colour, .def_colour = {1, 0.86f, 0.3f, 1}, .doc = "Of star or cloud."),
    PARAM_COLOUR_ROW(explode_values, rim, .def_colour = {0.93f, 0.45f, 0.16f, 1}, .doc = "Around it."),
    PARAM_COLOUR_ROW(explode_values, letters, .def_colour = {0.75f, 0.12f, 0.1f, 1}, .doc = "Of the noise."),
    PARAM_COLOUR_ROW(explode_values, ways, .def_colour = {0.55f, 0.57f, 0.62f, 1}, .only_if = "arrows",
                     .doc = "Of arrows."),
};

static void middle_of_all(const pieces *p, double seconds, double out[3])
{
    vector3_set(out, 0, 0, 0);
    for (size_t i = 0; i < p->count; i++) {
        double at[3];
        piece_at(p, i, seconds, at);
        vector3_add(out, out, 1.0 / (double)p->count, at);
    }
}

static double reach_of_all(const pieces *p, double seconds, const double middle[3])
{
    double reach = 0;
    for (size_t i = 0; i < p->count; i++) {
        double at[3];
        piece_at(p, i, seconds, at);
        reach = fmax(reach, vector3_distance(at, middle) + p->items[i].radius);
    }
    return reach;
}

/* From where it leaves the middle's sign to where it is now, before the piece; nothing of one that has not left yet. */
static lmn_status put_piece_arrow(depict_job *j, const expression *e, const depict_target *t, double begin, double end,
                                  const double middle[3], double clear, glyph_mesh *m, lmn_error *error)
{
    const explode_values *v = e->values;
    trajectory            way;
    lmn_status            status = way_trajectory(&way, &t->way, t->centre, begin, end, t->radius * 0.01, error);
    double(*points)[3] = status == LMN_OK ? mem_alloc(way.count * sizeof *points) : NULL;
    size_t count = 0;
    if (status == LMN_OK && !points)
        status = error_memory(error);
    for (size_t i = 0; i < way.count && status == LMN_OK; i++)
        if (vector3_distance(way.samples[i].position, middle) >= clear)
            vector3_copy(points[count++], way.samples[i].position);
    if (count > 0 && count < way.count) { /* the last point inside, brought to the sign's edge */
        const double *inside = way.samples[way.count - count - 1].position, *out = points[0];
        const double  a = vector3_distance(inside, middle), b = vector3_distance(out, middle);
        double        edge[3];
        vector3_mix(edge, inside, out, b > a ? (clear - a) / (b - a) : 0);
        for (size_t i = count; i > 0; i--)
            vector3_copy(points[i], points[i - 1]);
        vector3_copy(points[0], edge);
        count++;
    }
    if (count > 1)
        glyph_put_arrow(
            m, j, (const double(*)[3])points, count,
            &(arrow_style){
                .width = (double)v->width * t->radius, .tail = 0.25, .head = 2.4, .short_of = 1.3 * t->radius});
    mem_free(points);
    trajectory_release(&way);
    return status;
}

static lmn_status explode_depict(depict_job *j, const expression *e, lmn_error *error)
{
    const explode_values *v = e->values;
    pieces                p;
    double                middle[3];
    glyph_mesh            m = {0};
    lmn_status            status = pieces_open(&p, j, e->target, error);
    if (status == LMN_OK && p.count < 2)
        depict_say_nothing(j, "there are no two things below it that could part");
    if (status == LMN_OK && p.count > 1) {
        const double begin = pieces_parting(&p, e->from, e->to, 1e-3 * p.items[0].radius);
        middle_of_all(&p, begin, middle);
        const double      radius = (double)v->size * reach_of_all(&p, begin, middle);
        const burst_style style = {radius,    v->spikes, v->form == FORM_CLOUD, v->text.text, v->rim,
                                   v->colour, v->letters};
        const glyph_tense when = begin > e->now ? GLYPH_FUTURE : GLYPH_PRESENT;
        status = glyph_put_burst(j, e, middle, depict_front(j, middle), 0, &style, when, error);
        const double end = e->now > begin ? fmin(e->now, e->to) : e->to;
        for (size_t i = 0; i < p.count && v->arrows && status == LMN_OK; i++)
            status = put_piece_arrow(j, e, &p.items[i], begin, end, middle, radius * 0.9, &m, error);
        if (status == LMN_OK)
            status = glyph_put(j, &m, &(glyph_label){"burst-arrows", e->target, when, v->ways}, error);
    }
    glyph_mesh_release(&m);
    pieces_release(&p);
    return status;
}

const depiction depiction_explode = {
    "explode",
    NULL,
    "A star or a cloud of dust where many things part, with the noise that it makes, and an arrow outward for each of "
    "these; the target is the node that they lie in.",
    explode_params,
    PARAM_COUNT(explode_params),
    sizeof(explode_values),
    false,
    explode_depict,
};

/* --- ways that split ---------------------------------------------------------------------------------------------- */

typedef struct split_values {
    float  width, head, apart;
    colour colour, branches;
} split_values;

static const param split_params[] = {
    PARAM_FLOAT_ROW(split_values, width, .def = 0.4, .min = 0.001, .max = 10, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "Breadth of the stem, fraction of a piece's radius; branches have half of it."),
    PARAM_FLOAT_ROW(split_values, head, .def = 3, .min = 0, .max = 20, .soft_max = 8,
                    .doc = "Length of the heads, in breadths; 0: none."),
    PARAM_FLOAT_ROW(split_values, apart, .def = 0.02, .min = 0.0001, .max = 10, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "How far things are from going together when the stem ends, in radii."),
    PARAM_COLOUR_ROW(split_values, colour, .def_colour = {0, 0, 0, 0},
                     .doc = "Of the stem; none: grey for the past, red for the future."),
    PARAM_COLOUR_ROW(split_values, branches, .def_colour = {0, 0, 0, 0},
                     .doc = "Of branches; none: grey for the past, red for the future."),
};

enum { SPLIT_STEPS = 64 };

enum { STEM = -1 };

typedef struct split_way {
    const pieces *pieces;
    int           piece; /* STEM: of all together */
    double        split; /* when they part */
    double        from, to;
    double        width;
} split_way;

/* A branch leaves the stem as the stem goes on, and comes to its piece's own way over a third of its time. */
static void split_way_at(const split_way *w, const expression *e, double seconds, double out[3])
{
    const double f = w->to > w->split ? (seconds - w->split) / (w->to - w->split) : 0, u = fmin(3 * f, 1),
                 own = u * u * u * (10 + u * (6 * u - 15)), span = (w->split - e->from) / SPLIT_STEPS;
    double straight[3], before[3], at[3];
    if (w->piece == STEM) {
        middle_of_all(w->pieces, seconds, out);
        return;
    }
    middle_of_all(w->pieces, w->split, straight);
    middle_of_all(w->pieces, w->split - span, before);
    for (int k = 0; k < 3 && span > 0; k++)
        straight[k] += (straight[k] - before[k]) / span * (seconds - w->split);
    piece_at(w->pieces, (size_t)w->piece, seconds, at);
    vector3_mix(out, straight, at, own);
}

/* What of it lies within a time: branches end in heads. */
static lmn_status put_split_part(depict_job *j, const expression *e, const split_way *w, double from, double to,
                                 glyph_tense when, lmn_error *error)
{
    const split_values *v = e->values;
    const bool          stem = w->piece == STEM, ends = !stem && to >= w->to;
    const arrow_style   style = {.width = w->width,
                                 .dash = when == GLYPH_FUTURE ? 2.5 * w->width : 0,
                                 .gap = 1.4 * w->width,
                                 .tail = stem && from <= e->from ? 0.5 : 1,
                                 .head = ends ? (double)v->head : 0,
                                 .short_of = ends ? 1.2 * w->pieces->items[w->piece].radius : 0};
    double              points[SPLIT_STEPS + 1][3];
    glyph_mesh          m = {0};
    for (int i = 0; i <= SPLIT_STEPS; i++)
        split_way_at(w, e, from + (to - from) * i / SPLIT_STEPS, points[i]);
    glyph_put_arrow(&m, j, (const double(*)[3])points, SPLIT_STEPS + 1, &style);
    const glyph_label label = {stem ? "stem" : "branch", e->target, when,
                               depict_tint(when, stem ? v->colour : v->branches)};
    lmn_status        status = glyph_put(j, &m, &label, error);
    glyph_mesh_release(&m);
    return status;
}

/* Solid up to now, dashed behind it. */
static lmn_status put_split_way(depict_job *j, const expression *e, const split_way *w, lmn_error *error)
{
    const double now = fmin(fmax(e->now, w->from), w->to);
    lmn_status   status = LMN_OK;
    if (now > w->from)
        status = put_split_part(j, e, w, w->from, now, GLYPH_PAST, error);
    if (now < w->to && status == LMN_OK)
        status = put_split_part(j, e, w, now, w->to, GLYPH_FUTURE, error);
    return status;
}

static lmn_status split_depict(depict_job *j, const expression *e, lmn_error *error)
{
    const split_values *v = e->values;
    pieces              p;
    lmn_status          status = pieces_open(&p, j, e->target, error);
    if (status == LMN_OK && p.count < 2)
        depict_say_nothing(j, "there are no two things below it that could part");
    if (status == LMN_OK && p.count > 1) {
        const double radius = p.items[0].radius, width = (double)v->width * radius,
                     split = pieces_parting(&p, e->from, e->to, (double)v->apart * radius);
        if (split > e->from)
            status = put_split_way(j, e, &(split_way){&p, STEM, split, e->from, split, width}, error);
        for (size_t i = 0; i < p.count && split < e->to && status == LMN_OK; i++)
            status = put_split_way(j, e, &(split_way){&p, (int)i, split, split, e->to, width / 2}, error);
    }
    pieces_release(&p);
    return status;
}

const depiction depiction_split_path = {
    "split-path",
    NULL,
    "One arrow that splits smoothly into several: the way that the things in the target have together, then the ways "
    "of each; solid up to now, dashed where they will be.",
    split_params,
    PARAM_COUNT(split_params),
    sizeof(split_values),
    false,
    split_depict,
};
