/* Outlines of a mesh that run past each other. Where a surface turns away, the edges of its outline jump from one row
 * of faces to the next, and for a few of them both rows are seen: two ends lie side by side, less than a pen apart,
 * each beside the other line, like a fork. A hand draws one line there: both are cut in the middle of the overlap,
 * where they meet, and joined later. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* On paper: how far ends may run past each other, and how far apart the lines may lie there. */
#define OVERLAP_MOST  ((float)(8 * PAPER_UNITS_PER_MM))
#define OVERLAP_LEAST 0.7f
#define APART_MOST    ((float)(0.6 * PAPER_UNITS_PER_MM))
/* They go on as each other: cosine. */
#define AGAINST 0.85f
/* Over so much on either side the lines bend to where they meet, if they are as long. */
#define BEND 5.0f
/* Half of what is left between them. */
#define CRUMB 0.04f
/* How much of a line says which way its end points. */
#define REACH 6.0f
/* Ends that are as near as this are one corner. */
#define CORNER 0.1f
/* Much farther behind lies something else: units. */
#define DEPTH_MOST 48.0
enum { NEAR_MOST = 64 /* ends of one cell that are looked at */ };

typedef struct loose_end {
    uint32_t number; /* 2 · stroke, + 1 for its last point */
    bool     loose;  /* of an outline, and no other line ends there */
    int32_t  column, row;
    float    x, y, depth, out_x, out_y;
} loose_end;

typedef struct end_pair {
    uint32_t a, b; /* in the list of ends */
    float    overlap, apart;
} end_pair;

typedef struct trimmer {
    stroke_set        *set;
    const stroke_view *v;
    loose_end         *ends; /* by cells */
    size_t             count;
    end_pair          *pairs;
    size_t             pair_count, pair_capacity, point_capacity;
} trimmer;

static const stroke_point *point_from(const stroke_set *set, uint32_t number, uint32_t i)
{
    const stroke *s = &set->strokes[number / 2];
    return &set->points[s->first + (number & 1 ? s->count - 1 - i : i)];
}

static loose_end end_of(const stroke_set *set, uint32_t number)
{
    const stroke_point *p = point_from(set, number, 0);
    loose_end           out = {.number = number, .x = p->x, .y = p->y, .depth = p->depth};
    float               x = 0, y = 0;
    for (uint32_t i = 1; i < set->strokes[number / 2].count && x * x + y * y < REACH * REACH; i++) {
        x = p->x - point_from(set, number, i)->x;
        y = p->y - point_from(set, number, i)->y;
    }
    float length = hypotf(x, y);
    out.out_x = length > 0 ? x / length : 0;
    out.out_y = length > 0 ? y / length : 0;
    out.column = (int32_t)floorf(p->x / OVERLAP_MOST);
    out.row = (int32_t)floorf(p->y / OVERLAP_MOST);
    return out;
}

static int compare_ends(const void *a, const void *b)
{
    const loose_end *p = a, *q = b;
    if (p->row != q->row)
        return p->row < q->row ? -1 : 1;
    if (p->column != q->column)
        return p->column < q->column ? -1 : 1;
    return p->number < q->number ? -1 : p->number > q->number;
}

static void gather_ends(trimmer *t)
{
    for (uint32_t i = 0; i < t->set->stroke_count; i++) {
        const stroke *s = &t->set->strokes[i];
        for (uint32_t k = 0; k < 2 && s->hidden_by == 0 && !s->closed && s->count > 1; k++)
            t->ends[t->count++] = end_of(t->set, 2 * i + k);
    }
    if (t->count)
        qsort(t->ends, t->count, sizeof *t->ends, compare_ends);
}

static float length_of(const stroke_set *set, uint32_t number)
{
    const stroke *s = &set->strokes[number / 2];
    return set->points[s->first + s->count - 1].arc - set->points[s->first].arc;
}

/* The first end of a cell. */
static size_t first_in(const trimmer *t, int32_t column, int32_t row)
{
    size_t low = 0, high = t->count;
    while (low < high) {
        size_t           middle = low + (high - low) / 2;
        const loose_end *e = &t->ends[middle];
        if (e->row < row || (e->row == row && e->column < column))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Outlines that end where another line does have a corner there, and are left as they are. */
static void find_loose(trimmer *t)
{
    for (size_t i = 0; i < t->count; i++) {
        loose_end *e = &t->ends[i];
        bool       loose = t->set->strokes[e->number / 2].kind == STROKE_CONTOUR;
        size_t     first = loose ? first_in(t, e->column, e->row) : t->count;
        for (size_t k = first; k < t->count && loose; k++) {
            const loose_end *o = &t->ends[k];
            if (o->column != e->column || o->row != e->row || k == first + NEAR_MOST)
                break;
            loose = k == i || fabsf(o->x - e->x) > CORNER || fabsf(o->y - e->y) > CORNER;
        }
        e->loose = loose;
    }
}

/* Do two ends run past each other side by side? */
static bool is_overlap(const trimmer *t, const loose_end *a, const loose_end *b, end_pair *out)
{
    const stroke *s = &t->set->strokes[a->number / 2], *o = &t->set->strokes[b->number / 2];
    float         x = a->x - b->x, y = a->y - b->y;
    out->overlap = x * a->out_x + y * a->out_y;
    out->apart = fabsf(x * a->out_y - y * a->out_x);
    if (s == o || !a->loose || !b->loose || s->piece != o->piece || s->smooth != o->smooth ||
        a->out_x * b->out_x + a->out_y * b->out_y > -AGAINST || !(out->overlap > OVERLAP_LEAST) ||
        out->overlap > OVERLAP_MOST || out->apart > APART_MOST)
        return false;
    float  least = out->overlap + BEND / 2;
    double scale = 0.5 * t->v->camera.height * fabs(t->v->camera.projection.m[5]);
    double deeper = fabs((double)a->depth - b->depth) * scale / (t->v->camera.orthographic ? 1 : (double)a->depth);
    return deeper <= DEPTH_MOST && length_of(t->set, a->number) > least && length_of(t->set, b->number) > least;
}

static bool find_pairs(trimmer *t)
{
    for (uint32_t a = 0; a < t->count; a++)
        for (int32_t cell = 0; cell < 9 && t->ends[a].loose; cell++) {
            const loose_end *e = &t->ends[a];
            int32_t          column = e->column + cell % 3 - 1, row = e->row + cell / 3 - 1;
            size_t           first = first_in(t, column, row);
            for (size_t b = first; b < t->count && b < first + NEAR_MOST; b++) {
                end_pair pair = {a, (uint32_t)b, 0, 0};
                if (t->ends[b].column != column || t->ends[b].row != row)
                    break;
                if (b <= a || !is_overlap(t, e, &t->ends[b], &pair))
                    continue;
                if (!mem_grow((void **)&t->pairs, &t->pair_capacity, t->pair_count + 1, sizeof *t->pairs))
                    return false;
                t->pairs[t->pair_count++] = pair;
            }
        }
    return true;
}

static int compare_pairs(const void *a, const void *b)
{
    const end_pair *p = a, *q = b;
    if (p->apart != q->apart)
        return p->apart < q->apart ? -1 : 1;
    return p->a != q->a ? (p->a < q->a ? -1 : 1) : p->b < q->b ? -1 : p->b > q->b;
}

/* The place so far along a stroke from one of its ends. */
static stroke_point place_at(const stroke_set *set, uint32_t number, float along)
{
    uint32_t last = set->strokes[number / 2].count - 1, i = 1;
    float    begin = point_from(set, number, 0)->arc;
    while (i < last && fabsf(point_from(set, number, i)->arc - begin) < along)
        i++;
    const stroke_point *p = point_from(set, number, i - 1), *q = point_from(set, number, i);
    float               length = fabsf(q->arc - p->arc), f = length > 0 ? (along - fabsf(p->arc - begin)) / length : 0;
    f = fminf(fmaxf(f, 0), 1);
    return (stroke_point){
        p->x + f * (q->x - p->x),
        p->y + f * (q->y - p->y),
        p->depth + f * (q->depth - p->depth),
        p->arc + f * (q->arc - p->arc),
        p->weight,
        {p->aside[0] + f * (q->aside[0] - p->aside[0]), p->aside[1] + f * (q->aside[1] - p->aside[1])}};
}

/* Takes off what is nearer to an end than that, and lets the stroke end elsewhere instead. It bends to there from
 * where `straight` is; NULL: from its next point on. */
static bool end_at(trimmer *t, uint32_t number, float cut, const stroke_point *place, const stroke_point *straight)
{
    stroke_set *set = t->set;
    stroke     *s = &set->strokes[number / 2];
    float       begin = point_from(set, number, 0)->arc;
    uint32_t    gone = 1, ends = straight ? 2 : 1;
    while (gone + 1 < s->count && fabsf(point_from(set, number, gone)->arc - begin) < cut)
        gone++;
    if (gone < ends) { /* there is no room where it is */
        if (!mem_grow((void **)&set->points, &t->point_capacity, set->point_count + s->count + 1, sizeof *set->points))
            return false;
        uint32_t first = (uint32_t)set->point_count + (number & 1 ? 0 : 1);
        memcpy(&set->points[first], &set->points[s->first], s->count * sizeof *set->points);
        s->first = first - (number & 1 ? 0 : 1);
        set->point_count += ++s->count;
    } else {
        s->first += number & 1 ? 0 : gone - ends;
        s->count -= gone - ends;
    }
    for (uint32_t i = 0; i < ends; i++)
        set->points[s->first + (number & 1 ? s->count - 1 - i : i)] = i ? *straight : *place;
    return true;
}

/* Ends a stroke at a place beside it, in the middle of an overlap. */
static bool bend_to(trimmer *t, uint32_t number, float overlap, const stroke_point *own, stroke_point place)
{
    stroke_point straight = place_at(t->set, number, overlap / 2 + BEND);
    bool         bends = length_of(t->set, number) > overlap / 2 + 2 * BEND;
    place.aside[0] = own->aside[0] + place.x - own->x;
    place.aside[1] = own->aside[1] + place.y - own->y;
    place.arc = own->arc;
    place.weight = own->weight;
    return end_at(t, number, overlap / 2 + BEND, &place, bends ? &straight : NULL);
}

/* The ends meet but for a crumb, so that each still says what line it stands for. */
static bool trim_pair(trimmer *t, const end_pair *pair)
{
    const loose_end *ends[2] = {&t->ends[pair->a], &t->ends[pair->b]};
    stroke_point     own[2], place;
    for (int k = 0; k < 2; k++)
        own[k] = place_at(t->set, ends[k]->number, pair->overlap / 2);
    bool good = true;
    for (int k = 0; k < 2 && good; k++) {
        place = own[k];
        place.x = 0.5f * (own[0].x + own[1].x) - CRUMB * ends[k]->out_x;
        place.y = 0.5f * (own[0].y + own[1].y) - CRUMB * ends[k]->out_y;
        good = bend_to(t, ends[k]->number, pair->overlap, &own[k], place);
    }
    return good;
}

/* Cuts both ends of each pair, the nearest first, each end once. */
static bool trim_pairs(trimmer *t, uint32_t (*cut)[2], size_t *count)
{
    uint8_t *taken = mem_calloc(t->count + 1, 1);
    bool     good = true;
    if (t->pair_count)
        qsort(t->pairs, t->pair_count, sizeof *t->pairs, compare_pairs);
    for (size_t i = 0; i < t->pair_count && taken && good; i++) {
        const end_pair *pair = &t->pairs[i];
        if (taken[pair->a] || taken[pair->b])
            continue;
        taken[pair->a] = taken[pair->b] = 1;
        cut[*count][0] = t->ends[pair->a].number;
        cut[(*count)++][1] = t->ends[pair->b].number;
        good = trim_pair(t, pair);
    }
    mem_free(taken);
    return taken && good;
}

lmn_status strokes_trim(stroke_set *set, const stroke_view *v, uint32_t (**cut)[2], size_t *count, lmn_error *error)
{
    trimmer t = {.set = set, .v = v, .ends = mem_alloc((2 * set->stroke_count + 1) * sizeof *t.ends)};
    bool    good = t.ends != NULL;
    *cut = NULL;
    *count = 0;
    if (good) {
        gather_ends(&t);
        find_loose(&t);
    }
    good =
        good && find_pairs(&t) && (*cut = mem_alloc((t.pair_count + 1) * sizeof **cut)) && trim_pairs(&t, *cut, count);
    mem_free(t.ends);
    mem_free(t.pairs);
    return good ? LMN_OK : error_memory(error);
}
