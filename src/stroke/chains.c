/* Lines joined into long chains, chains cut where the number of surfaces in front changes, and points left out that
 * change nothing. Freudenberg 2003, section 7.3.3; row OE-11. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/curve_path.h"

/* Stretches shorter than this take the visibility of what lies beside them, units of paper: rounding, not geometry. */
#define FLICKER 0.9
/* Where more than two outlines meet, those that turn by less than this go on as one: cosine. Both visible or both
 * hidden, they may turn more. */
#define STRAIGHT_ON 0.5
#define TURNS_BACK  -0.7
/* The same of polylines of files, which meet at corners as well. */
#define CROSSES 0.7
enum {
    KEPT = 1, /* of points that stay */
    KEPT_BETWEEN,
    OUTSIDE = -1,
    MEETING_MAX = 24,
    MARKS_MAX = 8
}; /* of the page; lines at one end that are looked at; edges that a chain is known by */

/* A point of a chain and how many surfaces lie in front from here to the next one. */
typedef struct chain_point {
    double  x, y, z, arc;
    float   weight;
    int32_t count;
    double  aside[2]; /* as of stroke points */
} chain_point;

typedef struct chainer {
    stroke_set           *out;
    const stroke_view    *v;
    const view_lines     *lines;
    const visibility     *seen;
    const stroke_options *options;
    double                focal;    /* pixels to a unit of length, at depth 1 in perspective */
    uint32_t             *heads;    /* per end: a half-line 2 · line + end there, NO_VERTEX */
    uint32_t             *nexts;    /* per half-line: another one at the same end */
    uint32_t             *partners; /* per half-line: the one that goes on where it begins, NO_VERTEX: none */
    uint8_t              *used;     /* per line */
    uint32_t             *path;     /* half-lines of the chain, by the end that they begin at */
    size_t                path_count, path_capacity;
    chain_point          *points, *rotated;
    size_t                point_count, point_capacity, rotated_capacity;
    uint8_t              *kept; /* per point */
    uint32_t             *stack;
    size_t                kept_capacity, stack_capacity;
    size_t                stroke_capacity, out_capacity, mark_capacity, fine_capacity;
    stroke_mark           marks[MARKS_MAX]; /* of the chain, least ids first */
    size_t                mark_count;
    curve_path            curve;
    bool                  curved; /* the chain is */
} chainer;

/* --- joining -------------------------------------------------------------------------------------------- */

static const window_point *end_position(const chainer *c, uint32_t half)
{
    const window_segment *s = &c->lines->segments[half / 2];
    return half & 1 ? &s->b : &s->a;
}

static uint32_t end_number(const chainer *c, uint32_t half)
{
    return c->lines->lines[half / 2].ends[half & 1];
}

/* The cosine of the turn from coming in along one half-line to going out along another; both begin at the same end. */
static double turn_between(const chainer *c, uint32_t in, uint32_t out)
{
    const window_point *p = end_position(c, in ^ 1), *q = end_position(c, out), *r = end_position(c, out ^ 1);
    double ax = (double)q->x - p->x, ay = (double)q->y - p->y, bx = (double)r->x - q->x, by = (double)r->y - q->y;
    double length = sqrt((ax * ax + ay * ay) * (bx * bx + by * by));
    return length > 0 ? (ax * bx + ay * by) / length : 1;
}

/* Does a kind of line end where three meet? Sharp ones end at corners; outlines and crossings go straight on. */
static bool ends_at_corners(stroke_class kind)
{
    return kind == STROKE_BORDER || kind == STROKE_CREASE || kind == STROKE_MATERIAL;
}

/* Is the line visible where this half-line begins? */
static bool begins_visible(const chainer *c, uint32_t half)
{
    uint32_t first = c->seen->starts[half / 2], last = c->seen->starts[half / 2 + 1] - 1;
    return c->seen->spans[half & 1 ? last : first].count == 0;
}

/* How well one line goes on as another one: what is visible goes on as what is visible, then what turns least.
 * Below 0: not at all. */
static double fit(const chainer *c, uint32_t in, uint32_t out)
{
    double turn = turn_between(c, in, out);
    bool   alike = begins_visible(c, in) == begins_visible(c, out);
    if (c->lines->lines[in / 2].kind == STROKE_DRAWN) /* polylines that cross or end on others */
        return turn < CROSSES ? -1 : turn + 1;
    return turn < (alike ? TURNS_BACK : STRAIGHT_ON) ? -1 : turn + (alike ? 4 : 1);
}

/* Pairs the half-lines of one kind at one end, best fit first. Sharp lines end at corners. */
static void pair_lines(chainer *c, const uint32_t *halves, size_t count)
{
    if (count == 2) {
        c->partners[halves[0]] = halves[1];
        c->partners[halves[1]] = halves[0];
    }
    if (count <= 2 || ends_at_corners(c->lines->lines[halves[0] / 2].kind))
        return;
    for (;;) {
        double   most = 0;
        uint32_t p = 0, q = 0;
        for (size_t i = 0; i < count; i++)
            for (size_t k = i + 1; k < count; k++) {
                bool free = c->partners[halves[i]] == NO_VERTEX && c->partners[halves[k]] == NO_VERTEX &&
                            halves[i] / 2 != halves[k] / 2;
                double own = free ? fit(c, halves[i], halves[k]) : -1;
                if (own > most) {
                    most = own;
                    p = halves[i];
                    q = halves[k];
                }
            }
        if (most <= 0)
            return;
        c->partners[p] = q;
        c->partners[q] = p;
    }
}

static void pair_ends(chainer *c)
{
    for (uint32_t end = 0; end < c->lines->end_count; end++)
        for (int kind = 0; kind < STROKE_CLASS_COUNT && c->heads[end] != NO_VERTEX; kind++) {
            uint32_t halves[MEETING_MAX];
            size_t   count = 0;
            for (uint32_t h = c->heads[end]; h != NO_VERTEX && count < MEETING_MAX; h = c->nexts[h])
                if ((int)c->lines->lines[h / 2].kind == kind)
                    halves[count++] = h;
            if (count > 1)
                pair_lines(c, halves, count);
        }
}

static bool link_ends(chainer *c)
{
    const view_lines *l = c->lines;
    c->heads = mem_alloc(((size_t)l->end_count + 1) * sizeof *c->heads);
    c->nexts = mem_alloc((2 * l->count + 1) * sizeof *c->nexts);
    c->used = mem_calloc(l->count + 1, 1);
    c->partners = mem_alloc((2 * l->count + 1) * sizeof *c->partners);
    if (!c->heads || !c->nexts || !c->used || !c->partners)
        return false;
    memset(c->partners, 0xFF, 2 * l->count * sizeof *c->partners);
    memset(c->heads, 0xFF, ((size_t)l->end_count + 1) * sizeof *c->heads);
    for (size_t h = 2 * l->count; h-- > 0;) {
        uint32_t end = end_number(c, (uint32_t)h);
        c->nexts[h] = c->heads[end];
        c->heads[end] = (uint32_t)h;
    }
    pair_ends(c);
    return true;
}

/* Follows lines from a half-line on until they end or come back. The path gets the half-lines by the end that they
 * begin at. */
static bool follow(chainer *c, uint32_t half, bool *closed)
{
    *closed = false;
    for (uint32_t h = half;;) {
        if (!mem_grow((void **)&c->path, &c->path_capacity, c->path_count + 1, sizeof *c->path))
            return false;
        c->path[c->path_count++] = h;
        c->used[h / 2] = 1;
        uint32_t next = c->partners[h ^ 1];
        *closed = next == half && c->path_count > 1;
        if (next == NO_VERTEX || c->used[next / 2])
            return true;
        h = next;
    }
}

/* The first half-line of the chain that a line belongs to. */
static uint32_t first_of(const chainer *c, uint32_t line)
{
    uint32_t start = 2 * line, h = start;
    for (size_t steps = 0; steps <= c->lines->count; steps++) {
        uint32_t before = c->partners[h];
        if (before == NO_VERTEX || (before ^ 1) == start || c->used[before / 2])
            return h;
        h = before ^ 1;
    }
    return start;
}

/* --- points --------------------------------------------------------------------------------------------- */

/* At a fraction of the i-th line of the chain, counted from where the line itself begins. */
static chain_point point_at(const chainer *c, size_t i, double fraction, int32_t count)
{
    const window_segment *s = &c->lines->segments[c->path[i] / 2];
    const float          *weights = c->lines->lines[c->path[i] / 2].weights;
    double       p[3] = {s->a.x + fraction * ((double)s->b.x - s->a.x), s->a.y + fraction * ((double)s->b.y - s->a.y),
                         s->a.z + fraction * (s->b.z - s->a.z)};
    const double home[2] = {p[0], p[1]};
    if (c->curved)
        curve_path_at(&c->curve, i, c->path[i] & 1 ? 1 - fraction : fraction, p);
    return (chain_point){p[0] / c->v->units + 0.5 * c->v->camera.width,
                         p[1] / c->v->units + 0.5 * c->v->camera.height,
                         p[2],
                         0,
                         weights[0] + (float)fraction * (weights[1] - weights[0]),
                         count,
                         {(p[0] - home[0]) / c->v->units, (p[1] - home[1]) / c->v->units}};
}

static bool put_point(chainer *c, chain_point p)
{
    if (!mem_grow((void **)&c->points, &c->point_capacity, c->point_count + 1, sizeof *c->points))
        return false;
    c->points[c->point_count++] = p;
    return true;
}

/* The part of a straight piece that lies on the page. */
static bool clip_to_page(const chainer *c, const chain_point *p, const chain_point *q, double cut[2])
{
    const double from[2] = {p->x, p->y}, to[2] = {q->x, q->y}, limit[2] = {c->v->camera.width, c->v->camera.height};
    cut[0] = 0;
    cut[1] = 1;
    for (int k = 0; k < 2; k++) {
        double step = to[k] - from[k], low = -from[k], high = limit[k] - from[k];
        if (step == 0 && (low > 0 || high < 0))
            return false;
        if (step == 0)
            continue;
        double enter = (step > 0 ? low : high) / step, leave = (step > 0 ? high : low) / step;
        cut[0] = fmax(cut[0], enter);
        cut[1] = fmin(cut[1], leave);
    }
    return cut[0] < cut[1];
}

static chain_point between(const chain_point *p, const chain_point *q, double fraction, int32_t count)
{
    return (chain_point){
        p->x + fraction * (q->x - p->x),
        p->y + fraction * (q->y - p->y),
        p->z + fraction * (q->z - p->z),
        0,
        p->weight + (float)fraction * (q->weight - p->weight),
        count,
        {p->aside[0] + fraction * (q->aside[0] - p->aside[0]), p->aside[1] + fraction * (q->aside[1] - p->aside[1])}};
}

/* One straight piece with one count: cut at the rim of the page. */
static bool put_piece(chainer *c, const chain_point *p, const chain_point *q)
{
    double      cut[2];
    chain_point from = *p;
    if (p->x >= 0 && q->x >= 0 && p->y >= 0 && q->y >= 0 && p->x <= c->v->camera.width && q->x <= c->v->camera.width &&
        p->y <= c->v->camera.height && q->y <= c->v->camera.height)
        return put_point(c, from);
    if (!clip_to_page(c, p, q, cut)) {
        from.count = OUTSIDE;
        return put_point(c, from);
    }
    if (cut[0] > 0) {
        from.count = OUTSIDE;
        if (!put_point(c, from))
            return false;
        from = between(p, q, cut[0], p->count);
    }
    return put_point(c, from) && (cut[1] >= 1 || put_point(c, (between(p, q, cut[1], OUTSIDE))));
}

/* What lies between two fractions of the i-th line, counted in the chain's direction; curves have more than one
 * straight piece there. */
static bool put_stretch(chainer *c, size_t i, double from, double to, int32_t count)
{
    bool   back = c->path[i] & 1;
    size_t pieces = c->curved ? curve_path_pieces(&c->curve, i) : 1, k = 1;
    for (double at = from; at < to; k++) {
        double stop = k < pieces ? curve_path_stop(&c->curve, i, k) : 1, next = stop < to ? stop : to;
        if (next <= at)
            continue;
        chain_point p = point_at(c, i, back ? 1 - at : at, count), q = point_at(c, i, back ? 1 - next : next, count);
        if (!put_piece(c, &p, &q))
            return false;
        at = next;
    }
    return true;
}

/* The i-th line of the chain, in the chain's direction; all points but the last. */
static bool put_line_points(chainer *c, size_t i)
{
    uint32_t               half = c->path[i];
    const visibility_span *spans = c->seen->spans + c->seen->starts[half / 2];
    size_t                 count = c->seen->starts[half / 2 + 1] - c->seen->starts[half / 2];
    for (size_t j = 0; j < count; j++) {
        size_t  k = half & 1 ? count - 1 - j : j;
        double  from = spans[k].from, to = k + 1 < count ? (double)spans[k + 1].from : 1;
        int32_t number = spans[k].count < INT32_MAX ? (int32_t)spans[k].count : INT32_MAX;
        if (!put_stretch(c, i, half & 1 ? 1 - to : from, half & 1 ? 1 - from : to, number))
            return false;
    }
    return true;
}

static bool put_path(chainer *c, bool closed)
{
    c->point_count = 0;
    c->curved = curve_path_bends(&c->curve, c->lines->lines[c->path[0] / 2].kind);
    if (c->curved && !curve_path_take(&c->curve, c->path, c->path_count, closed))
        return false;
    for (size_t i = 0; i < c->path_count; i++)
        if (!put_line_points(c, i))
            return false;
    size_t last = c->path_count - 1;
    return put_point(c, point_at(c, last, c->path[last] & 1 ? 0 : 1, OUTSIDE));
}

static double line_length(const chainer *c, uint32_t half)
{
    const window_segment *s = &c->lines->segments[half / 2];
    double                x = (double)s->b.x - s->a.x, y = (double)s->b.y - s->a.y;
    return sqrt(x * x + y * y) / c->v->units;
}

/* The edges with the least ids, and where on the path they begin. An id is as good as random, so that such an edge
 * is left when others come and go. */
static void find_marks(chainer *c)
{
    double arc = 0;
    c->mark_count = 0;
    for (size_t i = 0; i < c->path_count; i++) {
        stroke_mark own = {c->lines->lines[c->path[i] / 2].id, 0, (float)arc};
        arc += line_length(c, c->path[i]);
        if (c->mark_count == MARKS_MAX && own.id >= c->marks[MARKS_MAX - 1].id)
            continue;
        size_t at = c->mark_count < MARKS_MAX ? c->mark_count++ : MARKS_MAX - 1;
        for (; at > 0 && c->marks[at - 1].id > own.id; at--)
            c->marks[at] = c->marks[at - 1];
        c->marks[at] = own;
    }
}

/* Does the chain run against its way? Outlines have what is seen from the front to one side; other chains run the
 * way of their least edge, which stays with them. */
static bool runs_back(const chainer *c)
{
    const view_line *lines = c->lines->lines;
    size_t           least = 0, back = 0;
    for (size_t i = 0; i < c->path_count; i++) {
        back += (c->path[i] & 1) != lines[c->path[i] / 2].turned;
        if (lines[c->path[i] / 2].id < lines[c->path[least] / 2].id)
            least = i;
    }
    return lines[c->path[0] / 2].kind == STROKE_CONTOUR ? 2 * back > c->path_count : c->path[least] & 1;
}

/* So that chains do not turn round from one frame to the next. */
static void orient(chainer *c)
{
    if (!runs_back(c))
        return;
    for (size_t i = 0, k = c->path_count - 1; i <= k && k < c->path_count; i++, k--) {
        uint32_t other = c->path[i] ^ 1;
        c->path[i] = c->path[k] ^ 1;
        c->path[k] = other;
    }
}

static double measure(chainer *c)
{
    double arc = 0;
    for (size_t i = 0; i < c->point_count; i++) {
        double x = i ? c->points[i].x - c->points[i - 1].x : 0, y = i ? c->points[i].y - c->points[i - 1].y : 0;
        arc += sqrt(x * x + y * y);
        c->points[i].arc = arc;
    }
    return arc;
}

/* A closed chain begins where its visibility changes, so that no stretch is cut where the chain happens to begin. */
static bool rotate(chainer *c)
{
    size_t count = c->point_count - 1, first = 0;
    while (first < count && c->points[first].count == c->points[first ? first - 1 : count - 1].count)
        first++;
    if (first == 0 || first == count)
        return true;
    if (!mem_grow((void **)&c->rotated, &c->rotated_capacity, c->point_count, sizeof *c->rotated))
        return false;
    double length = measure(c);
    for (size_t i = 0; i < c->mark_count; i++) {
        double arc = c->marks[i].arc - c->points[first].arc;
        c->marks[i].arc = (float)(arc < 0 ? arc + length : arc);
    }
    memcpy(c->rotated, c->points + first, (count - first) * sizeof *c->points);
    memcpy(c->rotated + count - first, c->points, first * sizeof *c->points);
    memcpy(c->points, c->rotated, count * sizeof *c->points);
    c->points[count] = c->points[0];
    c->points[count].count = OUTSIDE;
    return true;
}

static size_t stretch_end(const chainer *c, size_t begin)
{
    size_t end = begin;
    while (end + 1 < c->point_count && c->points[end].count == c->points[begin].count)
        end++;
    return end;
}

/* What a short stretch becomes between two others: like the one that is visible, or hidden, as it is itself; else
 * like the one before. */
static int32_t calm_count(int32_t own, int32_t before, int32_t after)
{
    if (before == OUTSIDE)
        return after == OUTSIDE ? own : after;
    if (after == OUTSIDE)
        return before;
    return (before == 0) != (own == 0) && (after == 0) == (own == 0) ? after : before;
}

/* Stretches too short to be seen take the visibility of a neighbour. */
static void calm(chainer *c)
{
    int32_t before = OUTSIDE;
    for (size_t begin = 0, end; begin + 1 < c->point_count; begin = end) {
        end = stretch_end(c, begin);
        int32_t own = c->points[begin].count, after = end + 1 < c->point_count ? c->points[end].count : OUTSIDE;
        double  limit = before == OUTSIDE || after == OUTSIDE
                            ? FLICKER / 2
                            : FLICKER; /* no position farther than half of it from one that is so */
        bool    brief = own != OUTSIDE && c->points[end].arc - c->points[begin].arc < limit;
        for (size_t i = begin; i < end && brief; i++)
            c->points[i].count = calm_count(own, before, after);
        before = c->points[begin].count;
    }
}

/* --- simplifying ---------------------------------------------------------------------------------------- */

/* Of what a depth is off, so much counts beside what the position on the page is: depth may be off by less than half a
 * pixel, so that whoever looks the line up finds it on its surface. */
#define DEPTH_FRACTION 0.25
/* The same of what lies aside: less than half a pixel, too. */
#define ASIDE_FRACTION 0.25

/* By how much a point lies off a straight piece, pixels. */
static double distance_from(const chainer *c, const chain_point *p, const chain_point *a, const chain_point *b)
{
    double x = b->x - a->x, y = b->y - a->y, length = x * x + y * y;
    double fraction = length > 0 ? ((p->x - a->x) * x + (p->y - a->y) * y) / length : 0;
    fraction = fraction < 0 ? 0 : fraction > 1 ? 1 : fraction;
    double away_x = p->x - a->x - fraction * x, away_y = p->y - a->y - fraction * y;
    double depth = (p->z - a->z - fraction * (b->z - a->z)) *
                   (c->v->camera.orthographic ? c->focal : -c->focal / p->z) * DEPTH_FRACTION;
    double aside = ASIDE_FRACTION * hypot(p->aside[0] - a->aside[0] - fraction * (b->aside[0] - a->aside[0]),
                                          p->aside[1] - a->aside[1] - fraction * (b->aside[1] - a->aside[1]));
    return sqrt(away_x * away_x + away_y * away_y + depth * depth + aside * aside);
}

/* Marks the points that stay between two that do (Douglas and Peucker). */
static void keep_between(chainer *c, size_t begin, size_t end, double limit, uint8_t mark)
{
    size_t depth = 0;
    c->stack[depth++] = (uint32_t)begin;
    c->stack[depth++] = (uint32_t)end;
    while (depth > 0) {
        size_t last = c->stack[--depth], first = c->stack[--depth], worst = 0;
        double most = limit;
        for (size_t i = first + 1; i < last; i++) {
            double away = distance_from(c, &c->points[i], &c->points[first], &c->points[last]);
            if (away > most) {
                most = away;
                worst = i;
            }
        }
        if (!worst)
            continue;
        c->kept[worst] = mark;
        c->stack[depth++] = (uint32_t)first;
        c->stack[depth++] = (uint32_t)worst;
        c->stack[depth++] = (uint32_t)worst;
        c->stack[depth++] = (uint32_t)last;
    }
}

/* Marks the points of a stretch that stay, and with another mark those that are kept between them. */
static bool simplify(chainer *c, size_t begin, size_t end)
{
    const stroke_options *w = c->options;
    if (!mem_grow((void **)&c->kept, &c->kept_capacity, c->point_count, 1) ||
        !mem_grow((void **)&c->stack, &c->stack_capacity, 2 * (end - begin) + 4, sizeof *c->stack))
        return false;
    memset(c->kept + begin, 0, end - begin + 1);
    c->kept[begin] = c->kept[end] = KEPT;
    keep_between(c, begin, end, w->simplify, KEPT);
    for (size_t first = begin, i = begin + 1; i <= end && w->fine > 0 && w->fine < w->simplify; i++)
        if (c->kept[i] == KEPT) {
            keep_between(c, first, i, w->fine, KEPT_BETWEEN);
            first = i;
        }
    return true;
}

/* --- strokes -------------------------------------------------------------------------------------------- */

/* Behind the point that was put last. */
static bool put_fine(chainer *c, const chain_point *p)
{
    stroke_set   *out = c->out;
    stroke_point *before = &out->points[out->point_count - 1];
    if (out->fine_count >= UINT32_MAX ||
        !mem_grow((void **)&out->fine, &c->fine_capacity, out->fine_count + 1, sizeof *out->fine))
        return false;
    out->fine[out->fine_count++] =
        (stroke_fine){(float)p->x, (float)p->y, (float)view_depth(c->v, p->z), (float)p->arc - before->arc};
    before->fine_count++;
    return true;
}

static bool put_stroke(chainer *c, stroke s, size_t begin, size_t end)
{
    stroke_set *out = c->out;
    if (!simplify(c, begin, end) ||
        !mem_grow((void **)&out->strokes, &c->stroke_capacity, out->stroke_count + 1, sizeof *out->strokes) ||
        !mem_grow((void **)&out->points, &c->out_capacity, out->point_count + (end - begin + 1), sizeof *out->points))
        return false;
    s.first = (uint32_t)out->point_count;
    for (size_t i = begin; i <= end; i++) {
        const chain_point *p = &c->points[i];
        if (c->kept[i] == KEPT)
            out->points[out->point_count++] = (stroke_point){.x = (float)p->x,
                                                             .y = (float)p->y,
                                                             .depth = (float)view_depth(c->v, p->z),
                                                             .arc = (float)p->arc,
                                                             .weight = p->weight,
                                                             .aside = {(float)p->aside[0], (float)p->aside[1]},
                                                             .fine = (uint32_t)out->fine_count};
        else if (c->kept[i] == KEPT_BETWEEN && !put_fine(c, p))
            return false;
    }
    s.count = (uint32_t)(out->point_count - s.first);
    out->strokes[out->stroke_count++] = s;
    return true;
}

static uint32_t piece_of(const chainer *c, uint32_t line)
{
    const view_item *item = &c->v->items[c->lines->lines[line].item];
    const edge_mesh *m = &c->v->scene->meshes[c->v->scene->items[c->lines->lines[line].item].mesh];
    if (c->lines->lines[line].kind == STROKE_DRAWN)
        return item->first_piece + m->piece_count - 1;
    uint32_t face = c->lines->segments[line].faces[0] - item->first_face;
    return item->first_piece + (face < m->face_count ? m->pieces[face] : 0);
}

static float lift_of(const chainer *c, uint32_t line)
{
    const window_segment *s = &c->lines->segments[line];
    return s->beside_count ? fmaxf(s->lift, (float)(BESIDE_LIFT * c->v->scene->extent)) : s->lift;
}

/* Is what is hidden of the chain wanted? */
static bool wants_hidden(const chainer *c)
{
    bool wanted = c->options->hidden && !c->lines->bare;
    for (size_t i = 0; i < c->path_count && c->options->hidden && !wanted; i++) {
        const uint32_t *faces = c->lines->segments[c->path[i] / 2].faces;
        for (int k = 0; k < 2 && !wanted; k++)
            wanted = faces[k] == EDGE_NO_FACE ? k == 0 : !c->lines->bare[c->v->face_pieces[faces[k]]];
    }
    return wanted;
}

static bool put_strokes(chainer *c, const view_line *line, uint64_t id, bool closed, double length)
{
    stroke     s = {.kind = line->kind,
                    .part = c->v->scene->items[line->item].part_index + 1,
                    .piece = piece_of(c, c->path[0] / 2),
                    .chain = (uint32_t)c->out->chain_count,
                    .id = id,
                    .chain_length = (float)length,
                    .smooth = c->lines->segments[c->path[0] / 2].ignored_count > 0};
    size_t     before = c->out->stroke_count;
    const bool hidden = wants_hidden(c);
    for (size_t i = 0; i < c->path_count; i++)
        s.lift = fmaxf(s.lift, lift_of(c, c->path[i] / 2));
    for (size_t begin = 0, end; begin + 1 < c->point_count; begin = end) {
        end = stretch_end(c, begin);
        int32_t count = c->points[begin].count;
        if (count == OUTSIDE || (count > 0 && !hidden) || c->points[end].arc <= c->points[begin].arc)
            continue;
        s.hidden_by = (uint32_t)count;
        s.closed = closed && begin == 0 && end + 1 == c->point_count;
        if (!put_stroke(c, s, begin, end))
            return false;
    }
    if (c->out->stroke_count == before)
        return true;
    if (!mem_grow((void **)&c->out->marks, &c->mark_capacity, c->out->mark_count + c->mark_count,
                  sizeof *c->out->marks))
        return false;
    for (size_t i = 0; i < c->mark_count; i++) {
        c->marks[i].chain = s.chain;
        c->out->marks[c->out->mark_count++] = c->marks[i];
    }
    c->out->chain_count++;
    return true;
}

static bool make_chain(chainer *c, uint32_t line)
{
    bool closed;
    c->path_count = 0;
    if (!follow(c, first_of(c, line), &closed))
        return false;
    orient(c);
    find_marks(c);
    if (!put_path(c, closed) || (closed && !rotate(c)))
        return false;
    double length = measure(c);
    if (length <= 0)
        return true;
    calm(c);
    return put_strokes(c, &c->lines->lines[line], c->marks[0].id, closed, length);
}

lmn_status chains_make(stroke_set *out, const stroke_view *v, const view_lines *lines, const visibility *seen,
                       const stroke_options *options, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->pairs = seen->pairs;
    out->entries = seen->entries;
    out->search = lines->search;
    chainer c = {.out = out,
                 .v = v,
                 .lines = lines,
                 .seen = seen,
                 .options = options,
                 .focal = 0.5 * v->camera.height * fabs(v->camera.projection.m[5])};
    bool    good = link_ends(&c) && curve_path_open(&c.curve, v, lines, options);
    for (int kind = 0; kind < STROKE_CLASS_COUNT && good; kind++)
        for (uint32_t i = 0; i < lines->count && good; i++)
            if ((int)lines->lines[i].kind == kind && !c.used[i])
                good = make_chain(&c, i);
    mem_free(c.heads);
    mem_free(c.nexts);
    mem_free(c.partners);
    mem_free(c.used);
    mem_free(c.path);
    mem_free(c.points);
    mem_free(c.rotated);
    mem_free(c.kept);
    mem_free(c.stack);
    curve_path_close(&c.curve);
    if (!good)
        stroke_set_release(out);
    return good ? LMN_OK : error_memory(error);
}

void stroke_set_release(stroke_set *s)
{
    mem_free(s->strokes);
    mem_free(s->points);
    mem_free(s->marks);
    mem_free(s->fine);
    memset(s, 0, sizeof *s);
}

/* Leaves out what says least and what lies on other lines, but for what closes corners; then what belongs to
 * nothing that is left. */
static lmn_status leave_out(stroke_set *set, const stroke_view *v, const stroke_options *options, lmn_error *error)
{
    uint8_t *gone = mem_calloc(set->stroke_count + 1, 1);
    if (!gone)
        return error_memory(error);
    lmn_status status = strokes_choose(set, v, options, gone, error);
    if (status == LMN_OK)
        status = strokes_thin(set, options->crowd, v->camera.width, v->camera.height, gone, error);
    if (status == LMN_OK && memchr(gone, 1, set->stroke_count) && !strokes_close_corners(set, gone))
        status = error_memory(error);
    if (status == LMN_OK && !strokes_drop_orphans(set, options->detail, options->shortest, gone))
        status = error_memory(error);
    size_t kept = 0;
    for (size_t i = 0; i < set->stroke_count && status == LMN_OK; i++)
        if (!gone[i])
            set->strokes[kept++] = set->strokes[i];
    if (status == LMN_OK)
        set->stroke_count = kept;
    mem_free(gone);
    return status;
}

lmn_status stroke_find(stroke_set *out, const stroke_view *v, const stroke_options *options, const bool *parts,
                       lmn_progress_fn progress, void *user, lmn_error *error)
{
    view_lines lines;
    visibility seen;
    uint8_t   *hidden = NULL;
    memset(out, 0, sizeof *out);
    lmn_status status = occlusion_find(&hidden, v, options, error);
    if (status == LMN_OK)
        status = lines_collect(&lines, v, options, parts, hidden, progress, user, error);
    const bool many = hidden != NULL;
    mem_free(hidden);
    if (status != LMN_OK)
        return status;
    const size_t asked = lines.count;
    status = outlines_see(&seen, v, &lines, progress, user, error);
    if (status == LMN_OK && many && !occlusion_drop(&lines, &seen, v, options))
        status = error_memory(error);
    if (status == LMN_OK)
        status = chains_make(out, v, &lines, &seen, options, error);
    out->lines = asked;
    if (status == LMN_OK)
        status = strokes_join(out, v, options, error);
    if (status == LMN_OK)
        strokes_cut_swallowtails(out);
    if (status == LMN_OK)
        status = leave_out(out, v, options, error);
    out->perspective = !v->camera.orthographic;
    if (status != LMN_OK)
        stroke_set_release(out);
    visibility_release(&seen);
    lines_release(&lines);
    return status;
}
