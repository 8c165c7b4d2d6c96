/* Priorities: who is drawn first as light fades, and who stays as the surface moves away. Rows EX-19 to EX-22. What
 * is ordered are lines: a stroke, or the chords of a curve, which stay together. */
#include "stroke_texture/strokes_private.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

const char *const perspective_order_names[5] = {"tied", "random", "even", "layers", NULL};

enum { POINTS_A_LINE = 16, POINTS_MAX = 100000, AREA_SIDE = 1024, AREA_SIDE_MAX = 4096 };

typedef struct line {
    size_t  first, count; /* strokes */
    int32_t layer;
    double  length, step; /* step: what it takes of the priorities */
} line;

typedef struct line_list {
    line  *items;
    size_t count;
} line_list;

static int compare_layers(const void *a, const void *b)
{
    const line *x = a, *y = b;
    if (x->layer != y->layer)
        return x->layer < y->layer ? -1 : 1;
    return x->first < y->first ? -1 : x->first > y->first;
}

/* Lines by layer, within it as they are in the list. */
static bool gather_lines(line_list *out, const strokes *s)
{
    *out = (line_list){mem_calloc(s->count, sizeof *out->items), 0};
    for (size_t i = 0; out->items && i < s->count; i++) {
        bool  goes_on = i > 0 && stroke_goes_on(&s->items[i - 1], &s->items[i]);
        line *l = goes_on ? &out->items[out->count - 1] : &out->items[out->count++];
        if (!goes_on)
            *l = (line){.first = i, .layer = s->items[i].layer};
        l->count++;
        l->length += stroke_length(&s->items[i]);
    }
    if (out->count > 1)
        qsort(out->items, out->count, sizeof *out->items, compare_layers);
    return out->items != NULL;
}

/* A position at `fraction` of a line's length. */
static spread_point point_on(const strokes *s, const line *l, double fraction)
{
    double                wanted = fraction * l->length;
    const texture_stroke *t = &s->items[l->first];
    for (size_t i = 0; i < l->count; i++) {
        t = &s->items[l->first + i];
        double length = stroke_length(t);
        if (wanted <= length || i + 1 == l->count) {
            double along = length > 0 ? fmin(wanted / length, 1) : 0;
            return (spread_point){(float)((double)t->u0 + along * ((double)t->u1 - (double)t->u0)),
                                  (float)((double)t->v0 + along * ((double)t->v1 - (double)t->v0)), 0};
        }
        wanted -= length;
    }
    return (spread_point){t->u0, t->v0, 0};
}

/* Long lines are spread by points along them, as far apart as the lines are if they lie side by side: else strokes
 * could lie beside each other whose points are far apart. */
static size_t points_on(const line *l, size_t line_count)
{
    double wanted = 1 + l->length * l->length * (double)line_count;
    size_t most = POINTS_MAX / line_count < POINTS_A_LINE ? POINTS_MAX / line_count : POINTS_A_LINE;
    most = most ? most : 1;
    return wanted < (double)most ? (size_t)wanted : most;
}

/* Puts lines into the order in which they are most evenly spread. */
static bool order_evenly(const strokes *s, line *lines, size_t count, uint32_t seed)
{
    size_t points = 0, *order = mem_calloc(count, sizeof *order);
    for (size_t i = 0; i < count; i++)
        points += points_on(&lines[i], count);
    spread_point *positions = mem_calloc(points, sizeof *positions);
    line         *sorted = mem_calloc(count, sizeof *sorted);
    points = 0;
    for (size_t i = 0; positions && i < count; i++) {
        size_t on = points_on(&lines[i], count);
        for (size_t k = 0; k < on; k++) {
            positions[points] = point_on(s, &lines[i], ((double)k + 0.5) / (double)on);
            positions[points++].item = i;
        }
    }
    bool good = order && positions && sorted && spread_order(order, count, positions, points, count, seed);
    for (size_t i = 0; good && i < count; i++)
        sorted[i] = lines[order[i]];
    if (good && count > 0)
        memcpy(lines, sorted, count * sizeof *lines);
    mem_free(order);
    mem_free(positions);
    mem_free(sorted);
    return good;
}

static void shuffle_lines(line *lines, size_t count, random_source *chance)
{
    for (size_t i = count; i > 1; i--) {
        size_t j = random_below(chance, i);
        line   kept = lines[i - 1];
        lines[i - 1] = lines[j];
        lines[j] = kept;
    }
}

static bool order_layers(const strokes *s, line_list *lines, priority_order order, uint32_t seed)
{
    random_source chance = random_start(seed, 0x50FF);
    bool          good = true;
    for (size_t from = 0, to; good && from < lines->count; from = to) {
        for (to = from + 1; to < lines->count && lines->items[to].layer == lines->items[from].layer; to++)
            ;
        if (order == ORDER_SHUFFLED)
            shuffle_lines(lines->items + from, to - from, &chance);
        else if (order == ORDER_EVEN)
            good = order_evenly(s, lines->items + from, to - from, seed + (uint32_t)lines->items[from].layer);
    }
    return good;
}

/* --- steps --- */

typedef struct area {
    float *covered;
    double fresh; /* what the line covers that none before did, in texels */
} area;

static void cover(void *user, size_t index, float coverage)
{
    area *a = user;
    if (coverage > a->covered[index]) {
        a->fresh += (double)(coverage - a->covered[index]);
        a->covered[index] = coverage;
    }
}

/* Lines narrower than two texels would be measured by their antialiasing. */
static int area_side(double covering)
{
    int side = AREA_SIDE;
    while (side < AREA_SIDE_MAX && covering * side < 2)
        side *= 2;
    return side;
}

static bool measure_areas(const strokes *s, line_list *lines, double covering)
{
    int          side = area_side(covering);
    area         a = {mem_calloc((size_t)side * (size_t)side, sizeof *a.covered), 0};
    stroke_brush brush = {.width = fmax(covering * side, 1e-3)};
    for (size_t i = 0; a.covered && i < lines->count; i++) {
        line *l = &lines->items[i];
        a.fresh = 0;
        for (size_t k = 0; k < l->count; k++)
            stroke_draw(&s->items[l->first + k], side, &brush, cover, &a);
        l->step = a.fresh;
    }
    mem_free(a.covered);
    return a.covered != NULL;
}

static bool measure_steps(const strokes *s, line_list *lines, priority_fraction fraction, double covering)
{
    double sum = 0;
    for (size_t i = 0; i < lines->count; i++)
        lines->items[i].step = fraction == FRACTION_LENGTH ? lines->items[i].length : (double)lines->items[i].count;
    if (fraction == FRACTION_AREA && !measure_areas(s, lines, covering))
        return false;
    for (size_t i = 0; i < lines->count; i++)
        sum += lines->items[i].step;
    /* Dots have no length. */
    for (size_t i = 0; sum <= 0 && i < lines->count; i++)
        lines->items[i].step = 1;
    return true;
}

/* A line's priority is what is left of 1 when those before it have taken their steps; so the first has 1, and none
 * has 0, which is never drawn. */
static void set_light(strokes *s, const line_list *lines)
{
    double sum = 0, done = 0;
    for (size_t i = 0; i < lines->count; i++)
        sum += lines->items[i].step;
    for (size_t i = 0; i < lines->count; i++) {
        const line *l = &lines->items[i];
        float       light = fmaxf((float)(1 - done / sum), 0x1p-24f);
        for (size_t k = 0; k < l->count; k++)
            s->items[l->first + k].light = light;
        done += l->step;
    }
}

lmn_status strokes_set_light(strokes *s, priority_order order, priority_fraction fraction, double covering,
                             uint32_t seed, lmn_error *error)
{
    line_list lines;
    bool      good =
        gather_lines(&lines, s) && order_layers(s, &lines, order, seed) && measure_steps(s, &lines, fraction, covering);
    if (good)
        set_light(s, &lines);
    mem_free(lines.items);
    return good ? LMN_OK : error_memory(error);
}

/* --- perspective --- */

/* The fraction of strokes, by number or by length, with at least 1 − t is t at every t, to half a stroke. */
static void set_perspective(strokes *s, const line_list *lines, bool by_length)
{
    double done = 0, all = 0;
    for (size_t i = 0; i < lines->count; i++)
        all += by_length ? lines->items[i].length : (double)lines->items[i].count;
    if (!(all > 0)) {
        by_length = false; /* there is nothing but dots */
        all = (double)s->count;
    }
    for (size_t i = 0; i < lines->count; i++) {
        const line *l = &lines->items[i];
        double      own = by_length ? l->length : (double)l->count;
        for (size_t k = 0; k < l->count; k++)
            s->items[l->first + k].perspective = (float)(1 - (done + 0.5 * own) / all);
        done += own;
    }
}

lmn_status strokes_set_perspective(strokes *s, perspective_order order, uint32_t seed, lmn_error *error)
{
    line_list     lines;
    random_source chance = random_start(seed, 0xFA2);
    if (order == PERSPECTIVE_TIED) {
        for (size_t i = 0; i < s->count; i++)
            s->items[i].perspective = s->items[i].light;
        return LMN_OK;
    }
    bool good = gather_lines(&lines, s);
    if (good && order == PERSPECTIVE_RANDOM)
        shuffle_lines(lines.items, lines.count, &chance);
    else if (good && order == PERSPECTIVE_EVEN)
        good = order_evenly(s, lines.items, lines.count, seed);
    else if (good) /* layers: from the last to the first, within each evenly */
        good = order_layers(s, &lines, ORDER_EVEN, seed);
    if (good)
        set_perspective(s, &lines, order != PERSPECTIVE_RANDOM); /* as much ink as is left, not as many strokes */
    mem_free(lines.items);
    return good ? LMN_OK : error_memory(error);
}
