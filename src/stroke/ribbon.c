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
static const float repeat_wave = 90;   /* the same of how repeats wander apart */
static const float taper_most = 0.45f; /* fraction of a chain that one of its ends may take to thin out */
static const float taper_end = 0.12f;  /* what is left of the width at the very end */
static const float straight_over = 8;  /* how far back an end must be straight to run on */
static const float straight_cosine = 0.985f;
static const float run_on_most = 0.35f; /* fraction of a chain that its end may run on */
static const float crumb = 1.5f;        /* what is left of a cut line and shorter than this is left out */
static const float close_points = 1e-3f;
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

static float lattice(uint64_t key, int64_t position)
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
    return (uint64_t)((double)lattice(key, 1) * 0x1p60 + 0x1p61) ^ key;
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
    float a = lattice(key, low), b = lattice(key, high);
    return a + (float)smooth * (b - a);
}

enum { NOISE_X, NOISE_Y, NOISE_PRESSURE, NOISE_REPEAT_X, NOISE_REPEAT_Y, NOISE_ENDS };

/* --- one line: a stretch of a stroke as it is drawn once ------------------------------------------------ */

typedef struct builder {
    ribbon_job  job;
    ribbon_set *out;
    size_t      ribbon_capacity, point_capacity;
    span_list   inked, dashes, spans;
    float      *arcs; /* where a line's points are */
    size_t      arc_count, arc_capacity;
    bool        failed;
} builder;

typedef struct line {
    const stroke      *s;
    const chain_facts *chain;
    int                repeat;
    float              begin, end;    /* of the stroke */
    bool               starts, ends;  /* the chain does so here */
    bool               thins[2];      /* the line runs out at its beginning, its end: nothing else is there */
    float              thin[2];       /* what is left of the width then, fraction */
    bool               varies, moves; /* width or opacity; position */
    float              pen;           /* what crowding leaves of the width, where it does not vary */
    uint64_t           keys[NOISE_ENDS + 1];
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
    if (l->moves && style->wobble > 0)
        step = fminf(step, fmaxf(style->wobble_length, 1) / 6);
    if (l->moves && l->repeat + style->repeats > 1)
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
    const stroke_set *set = b->job.strokes;
    float             step = step_of(b, l), before = where.from;
    float             least = (where.to - where.from) / POINTS_A_SPAN_MOST;
    step = fmaxf(step, least);
    b->arc_count = 0;
    add_arc(b, where.from);
    for (uint32_t k = 0; k <= l->s->count; k++) {
        float next = k < l->s->count ? set->points[l->s->first + k].arc : where.to;
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
    const stroke_point *points = b->job.strokes->points + l->s->first;
    uint32_t            k = *from, last = l->s->count - 2;
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
    const stroke_style *style = b->job.style;
    float               along = p->arc + l->s->phase, wave = fmaxf(style->wobble_length, 1);
    if (style->wobble > 0) {
        p->x += style->wobble * noise_at(l->keys[NOISE_X], along, wave, l->chain);
        p->y += style->wobble * noise_at(l->keys[NOISE_Y], along, wave, l->chain);
    }
    if (style->repeats > 1 && style->repeat_apart > 0) {
        p->x += style->repeat_apart * noise_at(l->keys[NOISE_REPEAT_X], along, repeat_wave, l->chain);
        p->y += style->repeat_apart * noise_at(l->keys[NOISE_REPEAT_Y], along, repeat_wave, l->chain);
    }
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
    bool          whole = s->closed && l->chain->closed && where.from <= l->begin && where.to >= l->end;
    float         half = ribbon_width(&b->job, s) / 2, alpha = opacity_of(&b->job, s);
    ribbon        r = {.kind = s->kind,
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
static bool is_straight(const builder *b, const line *l, bool at_end)
{
    const stroke_point *points = b->job.strokes->points + l->s->first, *end = &points[at_end ? l->s->count - 1 : 0];
    float               direction[2] = {0, 0};
    for (uint32_t i = 1; i < l->s->count; i++) {
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

/* How far the line runs on beyond an end of its chain, or ends before it. */
static float run_on(const builder *b, const line *l, bool at_end)
{
    const stroke_style *style = b->job.style;
    if (l->s->hidden_by > 0 || !(at_end ? l->ends : l->starts) || l->chain->closed)
        return 0;
    float by = 0, random = lattice(l->keys[NOISE_ENDS], at_end);
    if (style->overshoot > 0 && is_straight(b, l, at_end))
        by = fminf(style->overshoot * (0.75f + 0.25f * random), run_on_most * l->chain->length);
    if (style->repeats > 1 && style->repeat_apart > 0)
        by += fmaxf(style->repeat_apart * (0.5f + random), -0.2f * l->chain->length);
    return by;
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

static line line_of(const builder *b, uint32_t index, int repeat)
{
    const stroke_set   *set = b->job.strokes;
    const stroke_style *style = b->job.style;
    const stroke       *s = &set->strokes[index];
    const chain_facts  *chain = &b->job.chains[b->job.chain_of[index]];
    line                l = {
                       .s = s, .chain = chain, .repeat = repeat, .begin = set->points[s->first].arc, .end = last_point(set, s)->arc};
    l.starts = !chain->closed && index == chain->first;
    l.ends = !chain->closed && index + 1 == chain->first + chain->count;
    l.moves = style->wobble > 0 || (style->repeats > 1 && style->repeat_apart > 0);
    for (uint32_t end = 0; end < 2; end++) {
        const stroke_meeting *m = &b->job.meetings[2 * index + end];
        bool                  may = s->hidden_by > 0 ? (end ? l.ends : l.starts) : !s->closed && !chain->closed;
        l.thins[end] = may && (!m->meets || m->half > 0);
        l.thin[end] = m->meets ? m->half / (ribbon_width(&b->job, s) / 2) : taper_end;
    }
    l.pen = line_room_pen(&b->job.room, set, s);
    l.varies = style->pressure > 0 || (style->taper > 0 && (l.thins[0] || l.thins[1])) || has_weights(b, s);
    for (int i = 0; i <= NOISE_ENDS; i++)
        l.keys[i] = noise_key(&b->job, s, repeat, i);
    return l;
}

static void draw_stroke(builder *b, uint32_t index, const gap_list *gaps, size_t *gap)
{
    const stroke *s = &b->job.strokes->strokes[index];
    int           repeats = b->job.style->repeats < 1 || s->hidden_by > 0 ? 1 : b->job.style->repeats;
    line          l = line_of(b, index, 0);
    if (!(l.end > l.begin) || !isfinite(l.end - l.begin) || !(ribbon_width(&b->job, s) > 0))
        return;
    find_inked(b, index, l.begin, l.end, gaps, gap);
    ribbon_dash(&b->dashes, &b->job, s, l.chain, l.begin, l.end);
    bool dashed = b->dashes.count > 1;
    span_list_intersect(&b->spans, &b->inked, &b->dashes);
    b->failed = b->failed || b->inked.failed || b->spans.failed;
    for (int repeat = 0; repeat < repeats && repeat < REPEATS_MOST; repeat++) {
        l = line_of(b, index, repeat);
        for (size_t i = 0; i < b->spans.count && !b->failed; i++) {
            span where = b->spans.items[i];
            if (where.from == l.begin)
                where.from -= run_on(b, &l, false) + b->job.meetings[2 * index].onward;
            if (where.to == l.end)
                where.to += run_on(b, &l, true) + b->job.meetings[2 * index + 1].onward;
            if (where.to > where.from)
                emit(b, &l, where, dashed);
        }
    }
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
static bool look_round(ribbon_job *job, stroke_set *whole, gap_list *gaps)
{
    segment_grid grid = {0};
    bool         good = ribbon_make_whole(whole, job);
    job->strokes = whole;
    good = good && find_chains(job) && ribbon_find_corners(job) && segment_grid_build(&grid, job) &&
           ribbon_find_meetings(job, &grid) && line_room_find(&job->room, job);
    if (good) {
        ribbon_find_halos(gaps, job, &grid);
        ribbon_find_crowds(gaps, job);
        ribbon_find_loose(gaps, job);
        gap_list_sort(gaps);
    }
    segment_grid_release(&grid);
    return good && !gaps->failed;
}

lmn_status ribbons_make(ribbon_set *out, const stroke_set *strokes, const stroke_style *style, uint32_t seed,
                        lmn_error *error)
{
    *out = (ribbon_set){0};
    builder    b = {.job = {.strokes = strokes, .style = style, .seed = seed}, .out = out};
    gap_list   gaps = {0};
    stroke_set whole = {0};
    b.failed = !look_round(&b.job, &whole, &gaps);
    if (!b.failed) {
        draw_strokes(&b, &gaps, true);
        draw_strokes(&b, &gaps, false);
    }
    gap_list_release(&gaps);
    span_list_release(&b.inked);
    span_list_release(&b.dashes);
    span_list_release(&b.spans);
    mem_free(b.arcs);
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
    *r = (ribbon_set){0};
}
