/* Farthest next on the torus: each item goes where most room is left, so that every beginning of the order is
 * evenly spread. A grid of cells keeps the points that a new item can bring nearer together, a heap the distances;
 * both make it n log n. */
#include "stroke_texture/strokes_private.h"

#include "base/memory.h"

enum { CELLS_MAX = 512 };

/* Exactly the farthest one each time would halve the widest gaps again and again, and the pattern would become a
 * lattice. So every item's room counts a little less than it is, by a fraction of its own. */
static const double least_weight = 0.72;

/* No two positions of the torus are farther apart. */
static const double farthest = 0.70710678118654757;

typedef struct spread {
    const spread_point *points;
    size_t              point_count, item_count;
    int                 cells;      /* a side */
    size_t             *cell_start; /* where a cell's points begin in cell_points; one more at the end */
    size_t             *cell_points;
    size_t             *item_start; /* the same for items, in points */
    float              *near;       /* of each point: distance to the nearest placed one */
    double             *room;       /* of each item: sum of its points' distances; below 0: placed */
    size_t             *heap;       /* items; the heap's keys may be too large, never too small */
    double             *key;
    size_t             *rank;   /* who comes first among equals */
    float              *weight; /* of an item's room */
    size_t              heap_count;
} spread;

static size_t cell_of(const spread *s, const spread_point *p)
{
    double u = (double)p->u - floor((double)p->u), v = (double)p->v - floor((double)p->v);
    int    column = (int)(u * s->cells), row = (int)(v * s->cells);
    column = column < s->cells ? column : s->cells - 1;
    row = row < s->cells ? row : s->cells - 1;
    return (size_t)row * (size_t)s->cells + (size_t)column;
}

static bool allocate(spread *s)
{
    s->cells = (int)(sqrt((double)s->point_count) * 0.7);
    s->cells = s->cells < 1 ? 1 : s->cells > CELLS_MAX ? CELLS_MAX : s->cells;
    s->cell_start = mem_calloc((size_t)s->cells * (size_t)s->cells + 1, sizeof *s->cell_start);
    s->cell_points = mem_calloc(s->point_count, sizeof *s->cell_points);
    s->item_start = mem_calloc(s->item_count + 1, sizeof *s->item_start);
    s->near = mem_calloc(s->point_count, sizeof *s->near);
    s->room = mem_calloc(s->item_count, sizeof *s->room);
    s->heap = mem_calloc(s->item_count, sizeof *s->heap);
    s->key = mem_calloc(s->item_count, sizeof *s->key);
    s->rank = mem_calloc(s->item_count, sizeof *s->rank);
    s->weight = mem_calloc(s->item_count, sizeof *s->weight);
    return s->cell_start && s->cell_points && s->item_start && s->near && s->room && s->heap && s->key && s->rank &&
           s->weight;
}

static void release(spread *s)
{
    mem_free(s->cell_start);
    mem_free(s->cell_points);
    mem_free(s->item_start);
    mem_free(s->near);
    mem_free(s->room);
    mem_free(s->heap);
    mem_free(s->key);
    mem_free(s->rank);
    mem_free(s->weight);
}

static void sort_into_cells(spread *s)
{
    size_t cells = (size_t)s->cells * (size_t)s->cells;
    for (size_t i = 0; i < s->point_count; i++)
        s->cell_start[cell_of(s, &s->points[i])]++;
    size_t sum = 0;
    for (size_t c = 0; c <= cells; c++) {
        sum += s->cell_start[c];
        s->cell_start[c] = sum;
    }
    /* Filling from the end leaves each start where it belongs. */
    for (size_t i = s->point_count; i > 0; i--)
        s->cell_points[--s->cell_start[cell_of(s, &s->points[i - 1])]] = i - 1;
}

static double shortest(double offset)
{
    offset = fabs(offset);
    offset -= floor(offset);
    return offset > 0.5 ? 1 - offset : offset;
}

static double distance_between(const spread_point *a, const spread_point *b)
{
    double du = shortest((double)a->u - (double)b->u), dv = shortest((double)a->v - (double)b->v);
    return sqrt(du * du + dv * dv);
}

/* The most that any point of what is left is away from what is placed. Distances only shrink, so an old answer is
 * never too small. */
static double farthest_point(const spread *s)
{
    float most = 0;
    for (size_t i = 0; i < s->point_count; i++)
        if (s->room[s->points[i].item] >= 0 && s->near[i] > most)
            most = s->near[i];
    return (double)most;
}

static void count_points(spread *s)
{
    for (size_t i = 0; i < s->point_count; i++)
        s->item_start[s->points[i].item + 1]++;
    for (size_t i = 0; i < s->item_count; i++)
        s->item_start[i + 1] += s->item_start[i];
}

static double weighed_room(const spread *s, size_t item)
{
    return (double)s->weight[item] * s->room[item] / (double)(s->item_start[item + 1] - s->item_start[item]);
}

static bool comes_first(const spread *s, size_t a, size_t b)
{
    return s->key[a] != s->key[b] ? s->key[a] > s->key[b] : s->rank[a] < s->rank[b];
}

static void sift_down(spread *s, size_t at)
{
    size_t item = s->heap[at];
    for (;;) {
        size_t child = 2 * at + 1;
        if (child >= s->heap_count)
            break;
        if (child + 1 < s->heap_count && comes_first(s, s->heap[child + 1], s->heap[child]))
            child++;
        if (!comes_first(s, s->heap[child], item))
            break;
        s->heap[at] = s->heap[child];
        at = child;
    }
    s->heap[at] = item;
}

/* The item with most room. Keys that have become too large are put right on the way. */
static size_t take_farthest(spread *s)
{
    for (;;) {
        size_t item = s->heap[0];
        double room = weighed_room(s, item);
        if (room >= s->key[item])
            break;
        s->key[item] = room;
        sift_down(s, 0);
    }
    size_t item = s->heap[0];
    s->heap[0] = s->heap[--s->heap_count];
    if (s->heap_count > 0)
        sift_down(s, 0);
    s->room[item] = -1;
    return item;
}

static void near_cell(spread *s, size_t cell, const spread_point *to)
{
    for (size_t k = s->cell_start[cell]; k < s->cell_start[cell + 1]; k++) {
        size_t              i = s->cell_points[k];
        const spread_point *p = &s->points[i];
        if (s->room[p->item] < 0)
            continue;
        float distance = (float)distance_between(p, to);
        if (distance < s->near[i]) {
            s->room[p->item] -= (double)(s->near[i] - distance);
            /* Differences of floats add up with errors; below 0 would mean placed. */
            if (s->room[p->item] < 0)
                s->room[p->item] = 0;
            s->near[i] = distance;
        }
    }
}

static void bring_near(spread *s, const spread_point *to, double radius)
{
    int n = s->cells, reach = (int)(radius * n) + 1, first = -reach, last = reach;
    if (2 * reach + 1 >= n) {
        first = 0;
        last = n - 1;
    }
    size_t cell = cell_of(s, to);
    int    column = (int)(cell % (size_t)n), row = (int)(cell / (size_t)n);
    for (int y = first; y <= last; y++)
        for (int x = first; x <= last; x++) {
            int wrapped_y = (row + y + n) % n, wrapped_x = (column + x + n) % n;
            near_cell(s, (size_t)wrapped_y * (size_t)n + (size_t)wrapped_x, to);
        }
}

static void begin(spread *s, uint32_t seed)
{
    random_source chance = random_start(seed, 0x5B4D);
    sort_into_cells(s);
    count_points(s);
    for (size_t i = 0; i < s->point_count; i++)
        s->near[i] = (float)farthest;
    for (size_t i = 0; i < s->item_count; i++) {
        s->heap[i] = i;
        s->room[i] = (double)(float)farthest * (double)(s->item_start[i + 1] - s->item_start[i]);
        s->key[i] = farthest;
    }
    random_shuffle(&chance, s->heap, s->item_count);
    for (size_t i = 0; i < s->item_count; i++)
        s->rank[s->heap[i]] = i;
    for (size_t i = 0; i < s->item_count; i++)
        s->weight[i] = (float)(least_weight + (1 - least_weight) * random_unit(&chance));
    s->heap_count = s->item_count;
}

bool spread_order(size_t *order, size_t wanted, const spread_point *points, size_t point_count, size_t item_count,
                  uint32_t seed)
{
    spread s = {.points = points, .point_count = point_count, .item_count = item_count};
    double radius = farthest;
    size_t measured = 0;
    bool   good = allocate(&s);
    if (good)
        begin(&s, seed);
    for (size_t k = 0; good && k < wanted && k < item_count; k++) {
        order[k] = take_farthest(&s);
        for (size_t i = s.item_start[order[k]]; i < s.item_start[order[k] + 1]; i++)
            bring_near(&s, &points[i], radius);
        /* Now and then it is worth to look how near all has come. */
        if (k >= measured + measured / 4) {
            radius = farthest_point(&s);
            measured = k + 1;
        }
    }
    release(&s);
    return good;
}
