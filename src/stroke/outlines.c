/* What is hidden of outlines of samplings is decided by whole stretches of their chains, not piece by piece: the pieces
 * are as short as faces, and what hides one of them may be noise. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* A hidden stretch no longer than this goes on when what hides it lies within so many mean edges of depth: mm of paper,
 * or mean edges where these are longer. */
#define BRIDGED_MM    2.2
#define BRIDGED_EDGES 4.0
#define BRIDGED_DEPTH 3.0
/* A visible stretch goes on so far where it is hidden like this, straight on: cosine. */
#define EXTENDED_MM    1.6
#define EXTENDED_EDGES 3.0
#define STRAIGHT       0.2
/* What is visible of a chain and no longer than this is noise. */
#define SPECK_MM    0.8
#define SPECK_EDGES 1.5
/* A chain no longer than this is a fold of the noise: mean edges. */
#define ISLAND_EDGES 14.0

/* The span of a line, in the order and direction of its chain. */
typedef struct chain_span {
    uint32_t lift;      /* of the line */
    uint32_t span;      /* of the visibility */
    double   from, to;  /* fractions of the line */
    double   length;    /* mm */
    bool     backwards; /* the line runs against the chain */
} chain_span;

/* Spans of a chain that are all visible, or all hidden. */
typedef struct span_run {
    size_t first, end;
    double length, edge; /* mm */
    bool   visible;
} span_run;

typedef struct seer {
    const stroke_view *v;
    view_lines        *lines;
    visibility        *seen;
    uint32_t          *slots; /* per end number, less the least: two lifts + 1 whose lines end there */
    uint32_t           first_end, end_count;
    uint8_t           *used; /* per lift */
    uint32_t          *path; /* lifts of the chain · 2 + 1 where passed backwards */
    size_t             path_count;
    bool               closed;
    chain_span        *spans;
    size_t             span_count, span_capacity;
    span_run          *runs;
    size_t             run_count, run_capacity;
} seer;

/* --- chains ---------------------------------------------------------------------------------------------- */

static const view_line *line_of(const seer *s, uint32_t lift)
{
    return &s->lines->lines[s->lines->lifts[lift].line];
}

static bool open_seer(seer *s)
{
    size_t   count = s->lines->lift_count;
    uint32_t most = 0;
    s->first_end = UINT32_MAX;
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) {
            uint32_t end = line_of(s, i)->ends[k];
            s->first_end = end < s->first_end ? end : s->first_end;
            most = end > most ? end : most;
        }
    s->end_count = most - s->first_end + 1;
    s->slots = mem_calloc((size_t)s->end_count * 2, sizeof *s->slots);
    s->used = mem_calloc(count + 1, 1);
    s->path = mem_alloc((count + 1) * sizeof *s->path);
    if (!s->slots || !s->used || !s->path)
        return false;
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) {
            uint32_t *slot = &s->slots[2 * (size_t)(line_of(s, i)->ends[k] - s->first_end)];
            slot[slot[0] != 0] = i + 1;
        }
    return true;
}

static void close_seer(seer *s)
{
    mem_free(s->slots);
    mem_free(s->used);
    mem_free(s->path);
    mem_free(s->spans);
    mem_free(s->runs);
}

/* What goes on where a half of the path ends; UINT32_MAX: nothing. */
static uint32_t next_half(const seer *s, uint32_t half)
{
    uint32_t        end = line_of(s, half / 2)->ends[half & 1 ? 0 : 1];
    const uint32_t *slot = &s->slots[2 * (size_t)(end - s->first_end)];
    for (int k = 0; k < 2; k++)
        if (slot[k] && slot[k] - 1 != half / 2)
            return 2 * (slot[k] - 1) + (line_of(s, slot[k] - 1)->ends[0] == end ? 0 : 1);
    return UINT32_MAX;
}

static void follow(seer *s, uint32_t start)
{
    uint32_t half = 2 * start + 1, before = next_half(s, half);
    for (size_t steps = 0; before != UINT32_MAX && before / 2 != start && steps < s->lines->lift_count; steps++) {
        half = before;
        before = next_half(s, half);
    }
    s->closed = before != UINT32_MAX && before / 2 == start;
    s->path_count = 0;
    for (half ^= 1; half != UINT32_MAX && !s->used[half / 2]; half = next_half(s, half)) {
        s->used[half / 2] = 1;
        s->path[s->path_count++] = half;
    }
}

static double line_length(const seer *s, uint32_t lift)
{
    const window_segment *w = &s->lines->segments[s->lines->lifts[lift].line];
    double                x = (double)w->b.x - w->a.x, y = (double)w->b.y - w->a.y;
    return sqrt(x * x + y * y) / s->v->units / PAPER_UNITS_PER_MM;
}

static double edge_length(const seer *s, uint32_t lift)
{
    const stroke_camera  *c = &s->v->camera;
    const window_segment *w = &s->lines->segments[s->lines->lifts[lift].line];
    double                scale = 0.5 * c->height * fabs(c->projection.m[5]);
    return s->lines->lifts[lift].edge * scale / (c->orthographic ? 1 : view_depth(s->v, w->a.z)) / PAPER_UNITS_PER_MM;
}

/* --- islands --------------------------------------------------------------------------------------------- */

/* Marks the lines of chains that are no more than a fold of the noise. */
static size_t mark_islands(seer *s, uint8_t *gone)
{
    size_t count = 0;
    for (uint32_t i = 0; i < s->lines->lift_count; i++) {
        if (s->used[i])
            continue;
        double length = 0;
        follow(s, i);
        for (size_t k = 0; k < s->path_count; k++) {
            const view_lift *l = &s->lines->lifts[s->path[k] / 2];
            double3          along = double3_minus(l->ends[1], l->ends[0]);
            length += sqrt(double3_dot(along, along)) / l->edge;
        }
        for (size_t k = 0; k < s->path_count && length < ISLAND_EDGES; k++, count++)
            gone[s->lines->lifts[s->path[k] / 2].line] = 1;
    }
    return count;
}

static void drop_lines(view_lines *l, const uint8_t *gone)
{
    uint32_t kept = 0;
    size_t   lifts = 0, next = 0;
    for (uint32_t i = 0; i < l->count; i++) {
        bool is_lifted = next < l->lift_count && l->lifts[next].line == i;
        if (is_lifted && !gone[i]) {
            l->lifts[lifts] = l->lifts[next];
            l->lifts[lifts++].line = kept;
        }
        next += is_lifted;
        if (gone[i])
            continue;
        l->lines[kept] = l->lines[i];
        l->segments[kept++] = l->segments[i];
    }
    l->count = kept;
    l->lift_count = lifts;
}

static bool drop_islands(view_lines *lines, const stroke_view *v)
{
    seer     s = {.v = v, .lines = lines};
    uint8_t *gone = mem_calloc(lines->count + 1, 1);
    bool     good = gone && open_seer(&s);
    if (good && mark_islands(&s, gone))
        drop_lines(lines, gone);
    close_seer(&s);
    mem_free(gone);
    return good;
}

/* --- the vote -------------------------------------------------------------------------------------------- */

static bool gather_spans(seer *s)
{
    s->span_count = 0;
    for (size_t i = 0; i < s->path_count; i++) {
        uint32_t half = s->path[i], line = s->lines->lifts[half / 2].line, first = s->seen->starts[line],
                 count = s->seen->starts[line + 1] - first;
        double length = line_length(s, half / 2);
        if (!mem_grow((void **)&s->spans, &s->span_capacity, s->span_count + count, sizeof *s->spans))
            return false;
        for (uint32_t k = 0; k < count; k++) {
            uint32_t span = first + (half & 1 ? count - 1 - k : k);
            double   from = s->seen->spans[span].from,
                   to = span + 1 < first + count ? (double)s->seen->spans[span + 1].from : 1;
            s->spans[s->span_count++] = (chain_span){half / 2, span, from, to, (to - from) * length, half & 1};
        }
    }
    return true;
}

static uint32_t *count_of(const seer *s, size_t i)
{
    return &s->seen->spans[s->spans[i].span].count;
}

/* A closed chain begins where its visibility changes. */
static void rotate(seer *s)
{
    size_t first = 1;
    while (first < s->span_count && (*count_of(s, first) == 0) == (*count_of(s, first - 1) == 0))
        first++;
    for (size_t part = 0; part < 3 && s->closed && first < s->span_count; part++) { /* by turning round three times */
        size_t low = part == 1 ? first : 0, high = part == 0 ? first : s->span_count;
        for (; low + 1 < high; low++) {
            chain_span other = s->spans[low];
            s->spans[low] = s->spans[--high];
            s->spans[high] = other;
        }
    }
}

static bool gather_runs(seer *s)
{
    s->run_count = 0;
    for (size_t i = 0; i < s->span_count; i++) {
        bool visible = *count_of(s, i) == 0;
        if (s->run_count == 0 || s->runs[s->run_count - 1].visible != visible) {
            if (!mem_grow((void **)&s->runs, &s->run_capacity, s->run_count + 1, sizeof *s->runs))
                return false;
            s->runs[s->run_count++] = (span_run){i, i, 0, edge_length(s, s->spans[i].lift), visible};
        }
        span_run *r = &s->runs[s->run_count - 1];
        r->end = i + 1;
        r->length += s->spans[i].length;
    }
    return true;
}

/* Is a position seen from as much nearer to the eye? */
static bool is_near_surface(const seer *s, const chain_span *c)
{
    const view_lift *l = &s->lines->lifts[c->lift];
    const mat4      *view = &s->v->camera.view;
    double           at = 0.5 * (c->from + c->to),
           p[3] = {l->ends[0].x + at * (l->ends[1].x - l->ends[0].x), l->ends[0].y + at * (l->ends[1].y - l->ends[0].y),
                   l->ends[0].z + at * (l->ends[1].z - l->ends[0].z)};
    double back[3], length = 0;
    for (int k = 0; k < 3; k++) { /* towards the eye: the view matrix turns and moves */
        const double *m = view->m;
        double        eye = -(m[4 * k] * m[12] + m[4 * k + 1] * m[13] + m[4 * k + 2] * m[14]);
        back[k] = s->v->camera.orthographic ? m[4 * k + 2] : eye - p[k];
        length += back[k] * back[k];
    }
    for (int k = 0; k < 3; k++)
        p[k] += back[k] / sqrt(length) * BRIDGED_DEPTH * l->edge;
    uint32_t count;
    stroke_view_count(s->v, (const double(*)[3])p, 1, &count);
    return count == 0;
}

static bool is_hidden_by_itself(const seer *s, const span_run *r)
{
    for (size_t i = r->first; i < r->end; i++)
        if (!is_near_surface(s, &s->spans[i]))
            return false;
    return true;
}

static void set_run(seer *s, span_run *r, bool visible, uint32_t count)
{
    for (size_t i = r->first; i < r->end; i++)
        *count_of(s, i) = visible ? 0 : count;
    r->visible = visible;
}

/* The runs that neighbour a run; NULL at an end of the chain. */
static span_run *beside(seer *s, size_t run, int step)
{
    size_t count = s->run_count;
    if (step < 0 ? run > 0 : run + 1 < count)
        return &s->runs[step < 0 ? run - 1 : run + 1];
    return s->closed && count > 2 ? &s->runs[step < 0 ? count - 1 : 0] : NULL;
}

/* Hidden stretches between visible ones, where only the own surface hides them. */
static void bridge(seer *s)
{
    for (size_t i = 0; i < s->run_count; i++) {
        span_run *r = &s->runs[i], *before = beside(s, i, -1), *after = beside(s, i, 1);
        bool      between = before && after && before->visible && after->visible;
        if (!r->visible && between && r->length < fmax(BRIDGED_MM, BRIDGED_EDGES * r->edge) &&
            is_hidden_by_itself(s, r))
            set_run(s, r, true, 0);
    }
}

/* The direction of a span on the page, along its chain. */
static void span_direction(const seer *s, const chain_span *c, bool backwards, double out[2])
{
    const window_segment *w = &s->lines->segments[s->lines->lifts[c->lift].line];
    double                x = (double)w->b.x - w->a.x, y = (double)w->b.y - w->a.y, length = sqrt(x * x + y * y);
    double                sign = backwards ? -1 : 1;
    out[0] = length > 0 ? sign * x / length : 0;
    out[1] = length > 0 ? sign * y / length : 0;
}

/* Visible stretches go on to where their outline turns back, as far as only the own surface hides them: noise hides
 * such ends first. `step`: along the chain or against it. */
static void extend(seer *s, size_t from, int step, double most)
{
    double direction[2], next[2], length = 0;
    span_direction(s, &s->spans[from], s->spans[from].backwards, direction);
    for (size_t i = from + (size_t)step; i<s->span_count && * count_of(s, i)> 0; i += (size_t)step) {
        length += s->spans[i].length;
        span_direction(s, &s->spans[i], s->spans[i].backwards, next);
        if (length > most || direction[0] * next[0] + direction[1] * next[1] < STRAIGHT ||
            !is_near_surface(s, &s->spans[i]))
            return;
        *count_of(s, i) = 0;
    }
}

static void extend_all(seer *s)
{
    for (size_t i = 0; i < s->run_count; i++) {
        const span_run *r = &s->runs[i];
        if (!r->visible || r->length < fmax(SPECK_MM, SPECK_EDGES * r->edge))
            continue;
        double most = fmax(EXTENDED_MM, EXTENDED_EDGES * r->edge);
        extend(s, r->first, -1, most);
        extend(s, r->end - 1, 1, most);
    }
}

/* Short visible stretches beside hidden ones. */
static void drop_specks(seer *s)
{
    for (size_t i = 0; i < s->run_count; i++) {
        span_run       *r = &s->runs[i];
        const span_run *before = beside(s, i, -1), *after = beside(s, i, 1), *other = before ? before : after;
        if (r->visible && other && r->length < fmax(SPECK_MM, SPECK_EDGES * r->edge))
            set_run(s, r, false, *count_of(s, other->first));
    }
}

static bool vote(seer *s)
{
    bool good = true;
    for (uint32_t i = 0; i < s->lines->lift_count && good; i++) {
        if (s->used[i])
            continue;
        follow(s, i);
        good = gather_spans(s);
        if (good)
            rotate(s);
        good = good && gather_runs(s);
        if (good)
            bridge(s);
        good = good && gather_runs(s);
        if (good)
            extend_all(s);
        good = good && gather_runs(s);
        if (good)
            drop_specks(s);
    }
    return good;
}

/* --- all ------------------------------------------------------------------------------------------------- */

/* Segments with those of samplings where they are looked for. */
static window_segment *lift_segments(const view_lines *lines)
{
    window_segment *out = mem_copy(lines->segments, lines->count * sizeof *out);
    for (size_t i = 0; out && i < lines->lift_count; i++) {
        window_segment *s = &out[lines->lifts[i].line];
        s->a = lines->lifts[i].a;
        s->b = lines->lifts[i].b;
    }
    return out;
}

lmn_status outlines_see(visibility *out, const stroke_view *v, view_lines *lines, lmn_progress_fn progress, void *user,
                        lmn_error *error)
{
    memset(out, 0, sizeof *out);
    if (lines->lift_count && !drop_islands(lines, v))
        return error_memory(error);
    if (!lines->lift_count)
        return visibility_find(out, v, lines->segments, lines->count, progress, user, error);
    window_segment *lifted = lift_segments(lines);
    lmn_status      status =
        lifted ? visibility_find(out, v, lifted, lines->count, progress, user, error) : error_memory(error);
    mem_free(lifted);
    if (status != LMN_OK)
        return status;
    seer s = {.v = v, .lines = lines, .seen = out};
    if (!open_seer(&s) || !vote(&s))
        status = error_memory(error);
    close_seer(&s);
    return status;
}
