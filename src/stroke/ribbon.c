#include "stroke/ribbon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/ribbon_hidden.h"
#include "stroke/ribbon_private.h"
#include "stroke/stroke_private.h"

/* Numbers of taste, on paper (1/96 inch) unless they are shares. */
static const float pressure_wave = 70; /* how far apart swellings of the pressure are */
static const float repeat_wave = 90;   /* how finely repeats are divided that lie apart */
static const float taper_most = 0.45f; /* fraction of a chain that one of its ends may take to thin out */
static const float taper_end = 0.12f;  /* what is left of the width at the very end */
static const float straight_over = 8;  /* how far back an end must be straight to run on */
static const float straight_cosine = 0.985f;
static const float sway_most = 0.05f; /* fraction of a line's length that it may stray */
static const float crumb = 1.5f;      /* what is left of a cut line and shorter than this is left out */
static const float close_points = 1e-3f;
static const float fine_aside = 0.3f; /* fine points lie no farther from the line between two others */
enum { REPEATS_MOST = 16, POINTS_A_SPAN_MOST = 1 << 20 };

/* --- lists of spans and gaps ---------------------------------------------------------------------------- */

void span_list_add(span_list *list, float from, float to)
{
    if (!(to > from))
        return;
    if (list->failed || !mem_grow((void **)&list->items, &list->capacity, list->count + 1, sizeof *list->items)) {
        list->failed = true;
        return;
    }
    list->items[list->count++] = (span){from, to};
}

void span_list_release(span_list *list)
{
    mem_free(list->items);
    *list = (span_list){0};
}

void span_list_intersect(span_list *out, const span_list *a, const span_list *b)
{
    out->count = 0;
    out->failed = out->failed || a->failed || b->failed;
    for (size_t i = 0, k = 0; i < a->count && k < b->count;) {
        span_list_add(out, fmaxf(a->items[i].from, b->items[k].from), fminf(a->items[i].to, b->items[k].to));
        if (a->items[i].to < b->items[k].to)
            i++;
        else
            k++;
    }
}

void gap_list_add(gap_list *list, uint32_t stroke, float from, float to)
{
    if (list->failed || !mem_grow((void **)&list->items, &list->capacity, list->count + 1, sizeof *list->items)) {
        list->failed = true;
        return;
    }
    list->items[list->count++] = (stroke_gap){stroke, from, to};
}

void gap_list_release(gap_list *list)
{
    mem_free(list->items);
    *list = (gap_list){0};
}

static int compare_gaps(const void *a, const void *b)
{
    const stroke_gap *one = a, *other = b;
    if (one->stroke != other->stroke)
        return one->stroke < other->stroke ? -1 : 1;
    if (one->from != other->from)
        return one->from < other->from ? -1 : 1;
    return one->to < other->to ? -1 : one->to > other->to;
}

void gap_list_sort(gap_list *list)
{
    if (list->count)
        qsort(list->items, list->count, sizeof *list->items, compare_gaps);
}

/* --- facts of strokes ----------------------------------------------------------------------------------- */

static bool is_outline(stroke_class kind)
{
    return kind == STROKE_CONTOUR || kind == STROKE_BORDER;
}

float ribbon_width(const ribbon_job *job, const stroke *s)
{
    const stroke_style *style = job->style;
    if (s->hidden_by > 0 && style->hidden_width > 0)
        return style->hidden_width;
    if (style->narrow && (s->kind == STROKE_MATERIAL || s->kind >= STROKE_DRAWN))
        return style->width / 2;
    return (float)stroke_width_on_piece(s, style->width * (is_outline(s->kind) ? 1 : style->crease_width));
}

float ribbon_depth_between(const ribbon_job *job, float a, float b, float fraction)
{
    if (!job->strokes->perspective || !(a > 0) || !(b > 0))
        return a + fraction * (b - a);
    return 1 / (1 / a + fraction * (1 / b - 1 / a));
}

static bool is_wanted(const stroke_style *style, const stroke *s)
{
    if (s->count < 2 || (unsigned)s->kind >= STROKE_CLASS_COUNT)
        return false;
    if (s->hidden_by == 0)
        return true;
    return style->hidden != HIDDEN_NONE && (style->hidden_depth <= 0 || s->hidden_by <= (uint32_t)style->hidden_depth);
}

static const stroke_point *last_point(const stroke_set *set, const stroke *s)
{
    return &set->points[s->first + s->count - 1];
}

static void find_chain(ribbon_job *job, size_t first, size_t end)
{
    const stroke_set *set = job->strokes;
    const stroke     *one = &set->strokes[first], *last = &set->strokes[end - 1];
    chain_facts       facts = {
              .first = (uint32_t)first, .count = (uint32_t)(end - first), .closed = one->closed, .length = one->chain_length};
    if (one->count && last->count) {
        const stroke_point *a = &set->points[one->first], *b = last_point(set, last);
        bool                meets =
            hypotf(a->x - b->x, a->y - b->y) < close_points && fabsf(a->depth - b->depth) <= 1e-5f * fabsf(a->depth);
        facts.closed = facts.closed || (meets && a->arc == 0 && b->arc >= facts.length * 0.9999f);
        if (!(facts.length > 0) || !isfinite(facts.length))
            facts.length = b->arc;
    }
    for (size_t i = first; i < end; i++)
        job->chain_of[i] = (uint32_t)job->chain_count;
    job->chains[job->chain_count++] = facts;
}

static bool find_chains(ribbon_job *job)
{
    const stroke_set *set = job->strokes;
    job->chains = mem_calloc(set->stroke_count, sizeof *job->chains);
    job->chain_of = mem_calloc(set->stroke_count, sizeof *job->chain_of);
    job->drawn = mem_calloc(set->stroke_count, sizeof *job->drawn);
    if (!job->chains || !job->chain_of || !job->drawn)
        return false;
    size_t first = 0;
    for (size_t i = 0; i < set->stroke_count; i++) {
        job->drawn[i] = is_wanted(job->style, &set->strokes[i]);
        if (i + 1 == set->stroke_count || set->strokes[i + 1].chain != set->strokes[i].chain) {
            find_chain(job, first, i + 1);
            first = i + 1;
        }
    }
    return true;
}

/* --- what is random: noise along chains ----------------------------------------------------------------- */

float ribbon_random(uint64_t key, int64_t position)
{
    uint64_t z = key + (uint64_t)position * UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    z ^= z >> 31;
    return (float)((double)(z >> 11) * 0x1p-52 - 1);
}

/* What is random of a chain, and in it of one purpose. */
static uint64_t noise_key(const ribbon_job *job, const stroke *s, int repeat, int purpose)
{
    uint64_t key =
        s->id ^ ((uint64_t)job->seed << 32) ^ ((uint64_t)(unsigned)repeat << 8) ^ (uint64_t)(unsigned)purpose;
    return (uint64_t)((double)ribbon_random(key, 1) * 0x1p60 + 0x1p61) ^ key;
}

/* Smooth, −1 … 1, waves `wave` pixels apart; closed chains end as they begin. */
static float noise_at(uint64_t key, float arc, float wave, const chain_facts *chain)
{
    double cells = chain->closed ? fmax(round((double)chain->length / (double)wave), 3) : 0;
    double at = chain->closed ? (double)arc / (double)chain->length * cells : (double)arc / (double)wave;
    if (!isfinite(at) || fabs(at) > 1e12)
        return 0;
    double  whole = floor(at), t = at - whole, smooth = t * t * (3 - 2 * t);
    int64_t low = (int64_t)whole, high = low + 1, count = (int64_t)cells;
    if (count > 0) {
        low = ((low % count) + count) % count;
        high = ((high % count) + count) % count;
    }
    float a = ribbon_random(key, low), b = ribbon_random(key, high);
    return a + (float)smooth * (b - a);
}

enum { NOISE_X, NOISE_Y, NOISE_PRESSURE, NOISE_HAND, NOISE_COUNT };

/* --- one line: a stretch of a stroke as it is drawn once ------------------------------------------------ */

typedef struct builder {
    ribbon_job         job;
    ribbon_set        *out;
    size_t             ribbon_capacity, point_capacity, dash_capacity;
    span_list          inked, dashes, spans;
    hand_pulls         pulls;
    segment_grid       grid;   /* of visible strokes, where a hand draws */
    const stroke_fine *fine;   /* of the strokes; NULL: there are none */
    stroke_point      *points; /* of a stroke with its fine ones */
    size_t             fine_capacity;
    float             *arcs; /* where a line's points are */
    size_t             arc_count, arc_capacity;
    bool               failed;
} builder;

typedef struct line {
    const stroke       *s;
    const chain_facts  *chain;
    const stroke_point *points; /* that it goes through: of the stroke, or of a pull of it */
    uint32_t            count;
    hand_piece          piece;         /* how the hand draws it; a whole stroke is one piece */
    float               begin, end;    /* of the piece */
    bool                starts, ends;  /* the chain does so here */
    bool                thins[2];      /* the line runs out at its beginning, its end: nothing else is there */
    float               thin[2];       /* what is left of the width then, fraction */
    bool                closed;        /* it ends where it begins */
    bool                varies, moves; /* width or opacity; position */
    float               sway;          /* how far it strays */
    float               pen;           /* what crowding leaves of the width, where it does not vary */
    uint64_t            keys[NOISE_COUNT];
} line;

static void add_arc(builder *b, float arc)
{
    if (b->failed || (b->arc_count && arc <= b->arcs[b->arc_count - 1]))
        return;
    if (!mem_grow((void **)&b->arcs, &b->arc_capacity, b->arc_count + 1, sizeof *b->arcs)) {
        b->failed = true;
        return;
    }
    b->arcs[b->arc_count++] = arc;
}

/* How finely a line is divided so that what varies along it is smooth. */
static float step_of(const builder *b, const line *l)
{
    const stroke_style *style = b->job.style;
    float               step = INFINITY;
    if (l->sway > 0)
        step = fminf(step, fmaxf(style->wobble_length, 1) / 6);
    if (l->moves && (l->piece.bow[0] != 0 || l->piece.bow[1] != 0))
        step = fminf(step, repeat_wave / 8);
    if (l->varies && style->pressure > 0)
        step = fminf(step, pressure_wave / 8);
    if (l->varies && style->taper > 0)
        step = fminf(step, fmaxf(style->taper / 6, 1));
    if (l->varies && l->pen < 1)
        step = fminf(step, 2 * b->job.room.cell);
    return step;
}

/* The arcs of all points from a span's beginning to its end. */
static void divide(builder *b, const line *l, span where)
{
    float step = step_of(b, l), before = where.from, least = (where.to - where.from) / POINTS_A_SPAN_MOST;
    step = fmaxf(step, least);
    b->arc_count = 0;
    add_arc(b, where.from);
    for (uint32_t k = 0; k <= l->count; k++) {
        float next = k < l->count ? l->points[k].arc : where.to;
        if (!(next > before))
            continue;
        next = fminf(next, where.to);
        int pieces = isfinite(step) ? (int)ceilf((next - before) / step) : 1;
        for (int i = 1; i < pieces; i++)
            add_arc(b, before + (next - before) * (float)i / (float)pieces);
        add_arc(b, next);
        before = next;
        if (next >= where.to)
            break;
    }
}

/* The point of the true line; beyond the stroke's ends it runs straight on. */
static ribbon_point true_point(const builder *b, const line *l, float arc, uint32_t *from)
{
    const stroke_point *points = l->points;
    uint32_t            k = *from, last = l->count - 2;
    while (k < last && points[k + 1].arc < arc)
        k++;
    *from = k;
    const stroke_point *p = &points[k], *q = p + 1;
    float length = q->arc - p->arc, t = length > 0 ? (arc - p->arc) / length : 0, fraction = fminf(fmaxf(t, 0), 1);
    return (ribbon_point){p->x + t * (q->x - p->x),
                          p->y + t * (q->y - p->y),
                          ribbon_depth_between(&b->job, p->depth, q->depth, fraction),
                          arc,
                          0,
                          p->weight + fraction * (q->weight - p->weight)};
}

static void displace(const builder *b, const line *l, ribbon_point *p)
{
    float along = p->arc + l->s->phase, wave = fmaxf(b->job.style->wobble_length, 1);
    if (l->sway > 0) {
        p->x += l->sway * noise_at(l->keys[NOISE_X], along, wave, l->chain);
        p->y += l->sway * noise_at(l->keys[NOISE_Y], along, wave, l->chain);
    }
    float at = l->end > l->begin ? (p->arc - l->begin) / (l->end - l->begin) : 0, within = fminf(fmaxf(at, 0), 1);
    const hand_piece *piece = &l->piece;
    p->x += piece->lean[0][0] * (1 - at) + piece->lean[1][0] * at + 4 * within * (1 - within) * piece->bow[0];
    p->y += piece->lean[0][1] * (1 - at) + piece->lean[1][1] * at + 4 * within * (1 - within) * piece->bow[1];
}

/* At a distance from an end that the line runs out at. */
static float taper_over(const line *l, int end, float distance, float reach)
{
    float fraction = fminf(fmaxf(distance / reach, 0), 1);
    return l->thins[end] ? l->thin[end] + (1 - l->thin[end]) * sqrtf(fraction * (2 - fraction)) : 1;
}

/* 1 but near free ends. */
static float taper_at(const builder *b, const line *l, float arc, span where)
{
    float reach = fminf(b->job.style->taper, taper_most * fmaxf(l->end - l->begin, where.to - where.from));
    if (!(reach > 0))
        return 1;
    return fminf(taper_over(l, 0, arc - fminf(where.from, l->begin), reach),
                 taper_over(l, 1, fmaxf(where.to, l->end) - arc, reach));
}

static void weigh(const builder *b, const line *l, ribbon_point *p, span where, float half, float alpha)
{
    const stroke_style *style = b->job.style;
    float               weight = isfinite(p->alpha) ? fminf(fmaxf(p->alpha, 0), 1) : 1;
    bool                soft = style->brush == BRUSH_PENCIL || style->brush == BRUSH_CHARCOAL;
    p->half = half * (l->varies ? line_room_at(&b->job.room, p->x, p->y) : l->pen);
    p->alpha = soft ? alpha * weight : alpha;
    if (!l->varies)
        return;
    if (!soft)
        p->half *= weight;
    p->half *= taper_at(b, l, p->arc, where);
    if (style->pressure > 0)
        p->half *= 1 + 0.5f * style->pressure *
                           noise_at(l->keys[NOISE_PRESSURE], p->arc + l->s->phase, pressure_wave, l->chain);
}

static bool has_weights(const builder *b, const stroke *s)
{
    for (uint32_t k = 0; k < s->count; k++)
        if (b->job.strokes->points[s->first + k].weight < 1)
            return true;
    return false;
}

static colour ink_of(const ribbon_job *job, const stroke *s)
{
    const stroke_style *style = job->style;
    colour              ink = s->hidden_by > 0 ? style->hidden_colour : style->colours[s->kind];
    if (isnan(ink.r))
        ink = style->colours[s->kind];
    if (isnan(ink.r))
        ink = style->colours[STROKE_CONTOUR];
    return ink;
}

static float opacity_of(const ribbon_job *job, const stroke *s)
{
    if (s->hidden_by < 3 || !(job->style->hidden_fade < 1))
        return 1;
    return powf(fmaxf(job->style->hidden_fade, 0), (float)((s->hidden_by - 1) / 2));
}

static bool reserve(builder *b)
{
    ribbon_set *out = b->out;
    if (b->failed || out->point_count + b->arc_count > UINT32_MAX ||
        !mem_grow((void **)&out->ribbons, &b->ribbon_capacity, out->ribbon_count + 1, sizeof *out->ribbons) ||
        !mem_grow((void **)&out->points, &b->point_capacity, out->point_count + b->arc_count, sizeof *out->points))
        b->failed = true;
    return !b->failed;
}

static void emit(builder *b, const line *l, span where, bool dashed)
{
    const stroke *s = l->s;
    divide(b, l, where);
    if (b->arc_count < 2 || !reserve(b))
        return;
    bool   whole = l->closed && where.from <= l->begin && where.to >= l->end;
    float  half = ribbon_width(&b->job, s) / 2 * l->piece.weight, alpha = opacity_of(&b->job, s) * l->piece.opacity;
    ribbon r = {.kind = s->kind,
                .part = s->part,
                .hidden_by = s->hidden_by,
                .chain = s->chain,
                .id = s->id,
                .ink = ink_of(&b->job, s),
                .brush = b->job.style->brush,
                .first = (uint32_t)b->out->point_count,
                .count = (uint32_t)b->arc_count,
                .closed = whole,
                .even = !l->varies,
                .end = dashed ? RIBBON_BUTT : RIBBON_ROUND};
    ribbon_point *points = &b->out->points[b->out->point_count];
    uint32_t      from = 0;
    for (size_t i = 0; i < b->arc_count; i++) {
        points[i] = true_point(b, l, b->arcs[i], &from);
        if (l->moves)
            displace(b, l, &points[i]);
        weigh(b, l, &points[i], where, half, alpha);
        if (!isfinite(points[i].x) || !isfinite(points[i].y))
            return; /* nothing that can be drawn */
    }
    if (whole) {
        points[b->arc_count - 1].x = points[0].x;
        points[b->arc_count - 1].y = points[0].y;
    }
    b->out->point_count += b->arc_count;
    b->out->ribbons[b->out->ribbon_count++] = r;
}

/* --- ends ----------------------------------------------------------------------------------------------- */

/* Is the line straight as far back from this end as counts? */
static bool is_straight(const line *l, bool at_end)
{
    const stroke_point *end = &l->points[at_end ? l->count - 1 : 0];
    float               direction[2] = {0, 0};
    for (uint32_t i = 1; i < l->count; i++) {
        const stroke_point *p = at_end ? end - i : end + i, *q = at_end ? p + 1 : p - 1;
        float dx = p->x - q->x, dy = p->y - q->y, length = hypotf(dx, dy), so_far = hypotf(direction[0], direction[1]);
        if (length > 0 && so_far > 0 && dx * direction[0] + dy * direction[1] < straight_cosine * length * so_far)
            return false;
        direction[0] += dx;
        direction[1] += dy;
        if (fabsf(p->arc - end->arc) >= straight_over)
            return true;
    }
    return true;
}

/* --- strokes -------------------------------------------------------------------------------------------- */

/* What is left of a stroke between its gaps; they are sorted, `gap` is the next one of all. */
static void find_inked(builder *b, uint32_t index, float from, float to, const gap_list *gaps, size_t *gap)
{
    span_list *out = &b->inked;
    bool       cut = false;
    out->count = 0;
    while (*gap < gaps->count && gaps->items[*gap].stroke < index)
        (*gap)++;
    for (; *gap < gaps->count && gaps->items[*gap].stroke == index; (*gap)++) {
        const stroke_gap *g = &gaps->items[*gap];
        if (g->from - from > crumb)
            span_list_add(out, from, fminf(g->from, to));
        from = fmaxf(from, g->to);
        cut = true;
    }
    if (!cut || to - from > crumb)
        span_list_add(out, from, to);
}

static line line_of(const builder *b, uint32_t index)
{
    const stroke_set   *set = b->job.strokes;
    const stroke_style *style = b->job.style;
    const stroke       *s = &set->strokes[index];
    const chain_facts  *chain = &b->job.chains[b->job.chain_of[index]];
    line                l = {.s = s, .chain = chain, .points = &set->points[s->first], .count = s->count};
    l.begin = l.points[0].arc;
    l.end = last_point(set, s)->arc;
    l.piece = (hand_piece){.from = l.begin, .to = l.end, .weight = 1, .opacity = 1};
    l.starts = !chain->closed && index == chain->first;
    l.ends = !chain->closed && index + 1 == chain->first + chain->count;
    l.closed = s->closed && chain->closed;
    l.sway = fminf(style->wobble, sway_most * chain->length);
    l.moves = l.sway > 0;
    for (uint32_t end = 0; end < 2; end++) {
        const stroke_meeting *m = &b->job.meetings[2 * index + end];
        bool                  may = s->hidden_by > 0 ? (end ? l.ends : l.starts) : !s->closed && !chain->closed;
        l.thins[end] = may && (!m->meets || m->half > 0);
        l.thin[end] = m->meets ? m->half / (ribbon_width(&b->job, s) / 2) : taper_end;
    }
    l.pen = line_room_pen(&b->job.room, set, s);
    l.varies = style->pressure > 0 || (style->taper > 0 && (l.thins[0] || l.thins[1])) || has_weights(b, s);
    for (int i = 0; i < NOISE_COUNT; i++)
        l.keys[i] = noise_key(&b->job, s, 0, i);
    return l;
}

/* The fine points that lie between a point and the next one, as they are now: lines may have been cut since, joined, or
 * turned round. */
static size_t put_fine(builder *b, const stroke_point *p, const stroke_point *q, size_t count)
{
    float x = q->x - p->x, y = q->y - p->y, length = hypotf(x, y), reach = q->arc - p->arc;
    for (uint32_t i = 0; i < p->fine_count; i++) {
        const stroke_fine *f = &b->fine[p->fine + i];
        float across = fabsf((f->x - p->x) * y - (f->y - p->y) * x), along = (f->x - p->x) * x + (f->y - p->y) * y,
              part = reach > 0 ? f->along / reach : 1;
        if (!(part < 1) || across > fine_aside * length || along < 0 || along > length * length)
            continue;
        b->points[count++] = (stroke_point){.x = f->x,
                                            .y = f->y,
                                            .depth = f->depth,
                                            .arc = p->arc + f->along,
                                            .weight = p->weight + part * (q->weight - p->weight)};
    }
    return count;
}

/* Lines that no hand draws go through all that is known of them. */
static void take_fine(builder *b, line *l)
{
    size_t count = 0, most = l->count;
    for (uint32_t k = 0; k < l->count && b->fine; k++)
        most += l->points[k].fine_count;
    if (most == l->count)
        return;
    if (!mem_grow((void **)&b->points, &b->fine_capacity, most, sizeof *b->points)) {
        b->failed = true;
        return;
    }
    for (uint32_t k = 0; k < l->count; k++) {
        b->points[count++] = l->points[k];
        if (k + 1 < l->count)
            count = put_fine(b, &l->points[k], &l->points[k + 1], count);
    }
    l->points = b->points;
    l->count = (uint32_t)count;
}

/* Closed strokes: what is inked of them, in arcs that go on round and round. */
static void unroll(builder *b, float begin)
{
    size_t count = b->spans.count;
    for (int round = 1; round < HAND_ROUNDS && count > 0; round++)
        for (size_t i = 0; i < count; i++) {
            span  one = b->spans.items[i], *last = &b->spans.items[b->spans.count - 1];
            float on = (float)round * b->pulls.loop;
            if (i == 0 && one.from <= begin && last->to >= begin + on - close_points)
                last->to = one.to + on;
            else
                span_list_add(&b->spans, one.from + on, one.to + on);
        }
}

/* Draws the inked spans of a line; `beyond`: how far its ends run on where they are inked. */
static void draw_line(builder *b, const line *l, const float beyond[2], bool dashed)
{
    for (size_t i = 0; i < b->spans.count && !b->failed; i++) {
        span where = {fmaxf(b->spans.items[i].from, l->begin), fminf(b->spans.items[i].to, l->end)};
        if (!(where.to > where.from))
            continue;
        if (where.from == l->begin)
            where.from -= beyond[0];
        if (where.to == l->end)
            where.to += beyond[1];
        if (where.to > where.from)
            emit(b, l, where, dashed);
    }
}

/* The dashes in `spans` as one ribbon. */
static void draw_dashes(builder *b, const line *l, const float beyond[2])
{
    span  *dashes = b->spans.items, *last = &dashes[b->spans.count - 1];
    size_t count = b->spans.count, before = b->out->ribbon_count;
    dashes->from = fmaxf(dashes->from, l->begin);
    last->to = fminf(last->to, l->end);
    dashes->from -= dashes->from == l->begin ? beyond[0] : 0;
    last->to += last->to == l->end ? beyond[1] : 0;
    emit(b, l, (span){dashes->from, last->to}, true);
    if (b->failed || b->out->ribbon_count == before)
        return;
    if (b->out->dash_count + count > UINT32_MAX ||
        !mem_grow((void **)&b->out->dashes, &b->dash_capacity, b->out->dash_count + count, sizeof *b->out->dashes)) {
        b->failed = true;
        return;
    }
    ribbon *r = &b->out->ribbons[before];
    r->first_dash = (uint32_t)b->out->dash_count;
    r->dash_count = (uint32_t)count;
    for (size_t i = 0; i < count; i++) {
        float *to = b->out->dashes[b->out->dash_count++];
        to[0] = dashes[i].from - dashes->from;
        to[1] = dashes[i].to - dashes->from;
    }
}

/* A dashed line whole: between two gaps it is one ribbon. */
static void draw_dashed(builder *b, const line *l, const float beyond[2])
{
    for (size_t i = 0; i < b->inked.count && !b->failed; i++) {
        const span_list one = {.items = &b->inked.items[i], .count = 1};
        span_list_intersect(&b->spans, &one, &b->dashes);
        b->failed = b->failed || b->spans.failed;
        if (b->spans.count > 1)
            draw_dashes(b, l, beyond);
        else
            draw_line(b, l, beyond, true);
    }
}

/* A piece of a pull, drawn for the how manieth time. */
static void draw_piece(builder *b, const stroke_style *style, const line *whole, const hand_pull *pull, int number,
                       int copy, int index, const float onward[2], bool dashed)
{
    line     l = *whole;
    uint64_t key = noise_key(&b->job, l.s, number, NOISE_HAND);
    int      count = hand_piece_count(style, &b->pulls, pull, key), pieces = 32;
    float    beyond[2];
    bool     cut[2] = {pull->cut[0], pull->cut[1]};
    if (index >= count)
        return;
    l.piece = hand_piece_of(style, &b->pulls, pull, key, copy, index, count);
    l.points = &b->pulls.points[pull->first];
    l.count = pull->count;
    l.begin = l.piece.from;
    l.end = l.piece.to;
    l.sway = fminf(style->wobble, sway_most * (l.end - l.begin));
    l.moves = true;
    l.closed = false;
    int own = (number * 8 + copy) * pieces + index;
    for (int i = 0; i < NOISE_COUNT && own > 0; i++)
        l.keys[i] = noise_key(&b->job, l.s, own, i);
    for (int end = 0; end < 2; end++) {
        bool free_end = cut[end] || (end ? whole->ends : whole->starts);
        beyond[end] = l.piece.inside[end] ? 0
                      : free_end ? hand_run_on(style, &l.piece, end, is_straight(&l, end), l.keys[NOISE_HAND], copy)
                                 : 0;
        bool runs = l.piece.inside[end] || (free_end && (style->repeats > 1 || beyond[end] > 0));
        if (runs)
            l.thin[end] = taper_end;
        l.thins[end] = runs || (!cut[end] && l.thins[end]);
        if (!l.piece.inside[end] && !cut[end])
            beyond[end] += onward[end];
    }
    l.varies = l.varies || (style->taper > 0 && (l.thins[0] || l.thins[1]));
    draw_line(b, &l, beyond, dashed);
}

/* A pull as it is drawn where it is, with so much room. */
static void draw_pull(builder *b, const line *whole, int number, uint32_t own, const float onward[2], bool dashed)
{
    const hand_pull    *pull = &b->pulls.items[number];
    const stroke_point *points = &b->pulls.points[pull->first];
    hand_space          space = hand_space_beside(&b->job, &b->grid, own, points, pull->count);
    stroke_style        style = hand_style_in(b->job.style, space);
    float               length = b->pulls.round ? b->pulls.loop : points[pull->count - 1].arc - points[0].arc;
    int                 copies = hand_copies(&style, length, whole->pen);
    for (int copy = 0; copy < copies && copy < REPEATS_MOST; copy++)
        for (int index = 0; index < HAND_PIECES_MOST && !b->failed; index++)
            draw_piece(b, &style, whole, pull, number & 0xffff, copy, index, onward, dashed);
}

static void draw_pulls(builder *b, const line *whole, uint32_t own, const float onward[2], bool dashed)
{
    hand_pulls_find(&b->pulls, b->job.strokes, whole->s);
    b->failed = b->failed || b->pulls.failed;
    if (b->pulls.loop > 0)
        unroll(b, whole->begin);
    for (int i = 0; i < (int)b->pulls.count && !b->failed; i++)
        draw_pull(b, whole, i, own, onward, dashed);
    b->failed = b->failed || b->spans.failed;
}

static void draw_stroke(builder *b, uint32_t index, const gap_list *gaps, size_t *gap)
{
    const stroke *s = &b->job.strokes->strokes[index];
    line          l = line_of(b, index);
    float         onward[2] = {b->job.meetings[2 * index].onward, b->job.meetings[2 * index + 1].onward};
    if (!(l.end > l.begin) || !isfinite(l.end - l.begin) || !(ribbon_width(&b->job, s) > 0))
        return;
    find_inked(b, index, l.begin, l.end, gaps, gap);
    ribbon_dash(&b->dashes, &b->job, s, l.chain, l.begin, l.end);
    bool dashed = b->dashes.count > 1;
    span_list_intersect(&b->spans, &b->inked, &b->dashes);
    b->failed = b->failed || b->inked.failed || b->spans.failed;
    bool hand = s->hidden_by == 0 && hand_draws(b->job.style);
    if (!hand)
        take_fine(b, &l);
    if (hand)
        draw_pulls(b, &l, index, onward, dashed);
    else if (dashed && b->job.style->keeps_dashed && !l.varies)
        draw_dashed(b, &l, onward);
    else
        draw_line(b, &l, onward, dashed);
}

/* One pass over the strokes: the hidden ones, or the visible ones. */
static void draw_strokes(builder *b, const gap_list *gaps, bool hidden)
{
    size_t gap = 0;
    for (size_t i = 0; i < b->job.strokes->stroke_count && !b->failed; i++)
        if (b->job.drawn[i] && (b->job.strokes->strokes[i].hidden_by > 0) == hidden)
            draw_stroke(b, (uint32_t)i, gaps, &gap);
}

/* What must be known of all strokes before the first one is drawn. */
static bool look_round(ribbon_job *job, segment_grid *grid, stroke_set *whole, gap_list *gaps)
{
    bool good = ribbon_make_whole(whole, job);
    job->strokes = whole;
    good = good && find_chains(job) && ribbon_find_corners(job) && segment_grid_build(grid, job) &&
           ribbon_find_meetings(job, grid) && line_room_find(&job->room, job);
    if (good) {
        ribbon_find_halos(gaps, job, grid);
        ribbon_find_crowds(gaps, job);
        ribbon_find_loose(gaps, job);
        gap_list_sort(gaps);
    }
    return good && !gaps->failed;
}

lmn_status ribbons_make(ribbon_set *out, const stroke_set *strokes, const stroke_style *style, uint32_t seed,
                        lmn_error *error)
{
    *out = (ribbon_set){0};
    builder    b = {.job = {.strokes = strokes, .style = style, .seed = seed}, .out = out, .fine = strokes->fine};
    gap_list   gaps = {0};
    stroke_set whole = {0};
    b.failed = !look_round(&b.job, &b.grid, &whole, &gaps);
    if (!b.failed) {
        draw_strokes(&b, &gaps, true);
        draw_strokes(&b, &gaps, false);
    }
    gap_list_release(&gaps);
    span_list_release(&b.inked);
    span_list_release(&b.dashes);
    span_list_release(&b.spans);
    hand_pulls_release(&b.pulls);
    segment_grid_release(&b.grid);
    mem_free(b.arcs);
    mem_free(b.points);
    mem_free(b.job.chains);
    mem_free(b.job.chain_of);
    mem_free(b.job.drawn);
    mem_free(b.job.meetings);
    mem_free(b.job.corners);
    line_room_release(&b.job.room);
    stroke_set_release(&whole);
    if (!b.failed)
        return LMN_OK;
    ribbon_set_release(out);
    return error_memory(error);
}

void ribbon_set_release(ribbon_set *r)
{
    mem_free(r->ribbons);
    mem_free(r->points);
    mem_free(r->dashes);
    *r = (ribbon_set){0};
}
