#include "stroke/ribbon_features.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

static const float same_place = 0.75f; /* on paper: ends that one feature goes on over */
static const float same_way = 0.8f;    /* cosine of the turn there */
static const float end_reach = 4;      /* how much of a stroke says which way its end points, on paper */
enum { ENDS_MOST = 64 /* near one in order that are looked at */ };

/* A feature or a body. */
typedef struct group {
    float length, depth; /* the mean number of surfaces in front */
    float low[2], high[2];
    int   kind;
    bool  seen;
} group;

/* A run in the making. */
typedef struct ranked_run {
    hidden_run   run;
    float        depth;
    stroke_class kind;
    const group *feature, *body, *part;
} ranked_run;

typedef struct run_end {
    uint32_t run, piece;
    float    x, y, out_x, out_y;
} run_end;

/* Numbers of all strokes, ascending, each once. */
typedef struct number_list {
    uint32_t *items;
    size_t    count;
} number_list;

typedef struct feature_finder {
    const ribbon_job *job;
    ranked_run       *runs;
    uint32_t         *sets; /* per run: another one of its feature, or itself */
    run_end          *ends;
    number_list       pieces, part_ids;
    group            *features, *bodies, *parts;
    size_t            count;
} feature_finder;

static uint32_t first_of(uint32_t *sets, uint32_t i)
{
    while (sets[i] != i)
        i = sets[i] = sets[sets[i]];
    return i;
}

static void unite(uint32_t *sets, uint32_t a, uint32_t b)
{
    uint32_t p = first_of(sets, a), q = first_of(sets, b);
    sets[p > q ? p : q] = p > q ? q : p;
}

/* --- runs ------------------------------------------------------------------------------------------------ */

static void find_runs(feature_finder *f)
{
    const stroke_set *set = f->job->strokes;
    for (size_t i = 0; i < set->stroke_count; i++) {
        const stroke *s = &set->strokes[i];
        if (s->hidden_by == 0 || !f->job->drawn[i])
            continue;
        bool same = i > 0 && f->job->chain_of[i] == f->job->chain_of[i - 1] && f->job->drawn[i - 1];
        if (!same || set->strokes[i - 1].hidden_by == 0)
            f->runs[f->count++] = (ranked_run){.run = {.first = (uint32_t)i}, .kind = s->kind};
        ranked_run *r = &f->runs[f->count - 1];
        float       length = s->count ? set->points[s->first + s->count - 1].arc - set->points[s->first].arc : 0;
        length = isfinite(length) ? length : 0;
        r->run.count++;
        r->run.length += length;
        r->depth += length * (float)s->hidden_by;
    }
}

/* --- features -------------------------------------------------------------------------------------------- */

static run_end end_of(const feature_finder *f, uint32_t run, bool at_end)
{
    const stroke_set   *set = f->job->strokes;
    const hidden_run   *r = &f->runs[run].run;
    const stroke       *s = &set->strokes[r->first + (at_end ? r->count - 1 : 0)];
    const stroke_point *p = &set->points[s->first], *from = at_end ? p + s->count - 1 : p;
    run_end             out = {.run = run, .piece = s->piece, .x = from->x, .y = from->y};
    float               x = 0, y = 0;
    for (uint32_t i = 1; i < s->count && x * x + y * y < end_reach * end_reach; i++) {
        x = from->x - (at_end ? from - i : from + i)->x;
        y = from->y - (at_end ? from - i : from + i)->y;
    }
    float length = hypotf(x, y);
    out.out_x = length > 0 ? x / length : 0;
    out.out_y = length > 0 ? y / length : 0;
    return out;
}

static int compare_ends(const void *a, const void *b)
{
    const run_end *p = a, *q = b;
    if (p->piece != q->piece)
        return p->piece < q->piece ? -1 : 1;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return p->run < q->run ? -1 : p->run > q->run;
}

static void find_features(feature_finder *f)
{
    size_t count = 0;
    for (uint32_t i = 0; i < f->count; i++) {
        f->sets[i] = i;
        if (i > 0 && f->job->chain_of[f->runs[i].run.first] == f->job->chain_of[f->runs[i - 1].run.first])
            unite(f->sets, i, i - 1);
        for (int end = 0; end < 2; end++) {
            run_end e = end_of(f, i, end);
            if (isfinite(e.x) && isfinite(e.y))
                f->ends[count++] = e;
        }
    }
    qsort(f->ends, count, sizeof *f->ends, compare_ends);
    for (size_t i = 0; i < count; i++)
        for (size_t k = i + 1; k < count && k < i + ENDS_MOST; k++) {
            const run_end *p = &f->ends[i], *q = &f->ends[k];
            if (p->piece != q->piece || q->x - p->x > same_place)
                break;
            if (fabsf(q->y - p->y) <= same_place && p->out_x * q->out_x + p->out_y * q->out_y < -same_way)
                unite(f->sets, p->run, q->run);
        }
}

/* --- bodies ---------------------------------------------------------------------------------------------- */

static int compare_numbers(const void *a, const void *b)
{
    const uint32_t *p = a, *q = b;
    return *p < *q ? -1 : *p > *q;
}

static void sort_numbers(number_list *list, size_t count)
{
    qsort(list->items, count, sizeof *list->items, compare_numbers);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || list->items[i] != list->items[list->count - 1])
            list->items[list->count++] = list->items[i];
}

static void find_numbers(feature_finder *f)
{
    const stroke_set *set = f->job->strokes;
    for (size_t i = 0; i < set->stroke_count; i++) {
        f->pieces.items[i] = set->strokes[i].piece;
        f->part_ids.items[i] = set->strokes[i].part;
    }
    sort_numbers(&f->pieces, set->stroke_count);
    sort_numbers(&f->part_ids, set->stroke_count);
}

static uint32_t place_of(const number_list *list, uint32_t number)
{
    const uint32_t *found = bsearch(&number, list->items, list->count, sizeof *list->items, compare_numbers);
    return (uint32_t)(found - list->items);
}

static void add_to(group *g, const ranked_run *r)
{
    g->kind = g->length == 0 || (int)r->kind < g->kind ? (int)r->kind : g->kind;
    g->length += r->run.length;
    g->depth += r->depth;
}

static void widen(const feature_finder *f, group *g, const stroke *s)
{
    for (uint32_t k = 0; k < s->count; k++) {
        const stroke_point *p = &f->job->strokes->points[s->first + k];
        const float         at[2] = {p->x, p->y};
        for (int axis = 0; axis < 2; axis++) {
            g->low[axis] = fminf(g->low[axis], at[axis]);
            g->high[axis] = fmaxf(g->high[axis], at[axis]);
        }
    }
}

static void find_bodies(feature_finder *f)
{
    const stroke_set *set = f->job->strokes;
    find_numbers(f);
    for (size_t i = 0; i < f->pieces.count; i++)
        f->bodies[i] = (group){.low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    for (size_t i = 0; i < set->stroke_count; i++) {
        group *body = &f->bodies[place_of(&f->pieces, set->strokes[i].piece)];
        if (f->job->drawn[i] && set->strokes[i].hidden_by == 0)
            body->seen = true;
        else if (f->job->drawn[i])
            widen(f, body, &set->strokes[i]);
    }
    for (uint32_t i = 0; i < f->count; i++) {
        ranked_run *r = &f->runs[i];
        r->run.feature = first_of(f->sets, i);
        /* A feature is of the body that its first run is of. */
        const stroke *s = &set->strokes[f->runs[r->run.feature].run.first];
        r->run.body = place_of(&f->pieces, s->piece);
        r->run.part = place_of(&f->part_ids, s->part);
        r->feature = &f->features[r->run.feature];
        r->body = &f->bodies[r->run.body];
        r->part = &f->parts[r->run.part];
        r->run.seen = r->body->seen;
        r->run.extent = hypotf(r->body->high[0] - r->body->low[0], r->body->high[1] - r->body->low[1]);
        add_to(&f->features[r->run.feature], r);
        add_to(&f->bodies[r->run.body], r);
        add_to(&f->parts[r->run.part], r);
    }
}

/* --- order ----------------------------------------------------------------------------------------------- */

static int compare_groups(const group *a, const group *b, bool kinds)
{
    float p = a->length > 0 ? roundf(a->depth / a->length) : 0, q = b->length > 0 ? roundf(b->depth / b->length) : 0;
    if (p != q)
        return p < q ? -1 : 1;
    if (kinds && a->kind != b->kind)
        return a->kind < b->kind ? -1 : 1;
    if (a->length != b->length)
        return a->length > b->length ? -1 : 1;
    return 0;
}

/* The more important group first; of those that are alike the lower number. */
static int compare_members(const group *a, const group *b, uint32_t number_a, uint32_t number_b, bool kinds)
{
    int order = number_a == number_b ? 0 : compare_groups(a, b, kinds);
    return order ? order : number_a < number_b ? -1 : number_a > number_b;
}

static int compare_runs(const void *a, const void *b)
{
    const ranked_run *p = a, *q = b;
    int               order = compare_members(p->part, q->part, p->run.part, q->run.part, false);
    if (order == 0)
        order = compare_members(p->body, q->body, p->run.body, q->run.body, false);
    if (order == 0)
        order = compare_members(p->feature, q->feature, p->run.feature, q->run.feature, true);
    return order ? order : p->run.first < q->run.first ? -1 : p->run.first > q->run.first;
}

bool hidden_runs_find(hidden_runs *out, const ribbon_job *job)
{
    size_t         count = job->strokes->stroke_count + 1;
    feature_finder f = {.job = job};
    *out = (hidden_runs){.items = mem_calloc(count, sizeof *out->items)};
    f.runs = mem_calloc(count, sizeof *f.runs);
    f.sets = mem_calloc(count, sizeof *f.sets);
    f.ends = mem_calloc(2 * count, sizeof *f.ends);
    f.pieces.items = mem_calloc(count, sizeof *f.pieces.items);
    f.part_ids.items = mem_calloc(count, sizeof *f.part_ids.items);
    f.parts = mem_calloc(count, sizeof *f.parts);
    f.features = mem_calloc(count, sizeof *f.features);
    f.bodies = mem_calloc(count, sizeof *f.bodies);
    bool good = out->items && f.runs && f.sets && f.ends && f.pieces.items && f.part_ids.items && f.parts &&
                f.features && f.bodies;
    if (good) {
        find_runs(&f);
        find_features(&f);
        find_bodies(&f);
        qsort(f.runs, f.count, sizeof *f.runs, compare_runs);
        out->count = f.count;
        for (size_t i = 0; i < f.count; i++)
            out->items[i] = f.runs[i].run;
    }
    mem_free(f.runs);
    mem_free(f.sets);
    mem_free(f.ends);
    mem_free(f.pieces.items);
    mem_free(f.part_ids.items);
    mem_free(f.parts);
    mem_free(f.features);
    mem_free(f.bodies);
    return good;
}
