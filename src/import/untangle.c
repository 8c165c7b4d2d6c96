#include "import/untangle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "import/ring.h"

enum { CORNERS_MOST = 8192 }; /* larger rings stay as they are: pairs of edges are looked at */

#define LEAST_AREA 1e-4 /* m², of loops */

bool ring_list_begin(ring_list *l)
{
    if (!mem_grow((void **)&l->counts, &l->ring_capacity, l->ring_count + 1, sizeof *l->counts))
        return false;
    l->counts[l->ring_count++] = 0;
    return true;
}

bool ring_list_add(ring_list *l, const double at[2])
{
    if (!mem_grow((void **)&l->positions, &l->position_capacity, l->position_count + 1, sizeof *l->positions))
        return false;
    memcpy(l->positions[l->position_count++], at, sizeof *l->positions);
    l->counts[l->ring_count - 1]++;
    return true;
}

void ring_list_release(ring_list *l)
{
    mem_free(l->positions);
    mem_free(l->counts);
    *l = (ring_list){.positions = NULL};
}

static double side_of(const double a[2], const double b[2], const double p[2])
{
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/* Do two edges cross within both of them? Touching is not crossing. */
static bool edges_cross(const double a[2], const double b[2], const double c[2], const double d[2], double out[2])
{
    if (fmax(a[0], b[0]) < fmin(c[0], d[0]) || fmax(c[0], d[0]) < fmin(a[0], b[0]) ||
        fmax(a[1], b[1]) < fmin(c[1], d[1]) || fmax(c[1], d[1]) < fmin(a[1], b[1]))
        return false;
    double from = side_of(c, d, a), to = side_of(c, d, b);
    if (!(from * to < 0) || !(side_of(a, b, c) * side_of(a, b, d) < 0))
        return false;
    for (int k = 0; k < 2; k++)
        out[k] = a[k] + from / (from - to) * (b[k] - a[k]);
    return true;
}

static bool rings_cross(const double (*a)[2], size_t m, const double (*b)[2], size_t n)
{
    double at[2];
    for (size_t i = 0; i < m && m * n <= (size_t)CORNERS_MOST * CORNERS_MOST; i++)
        for (size_t j = 0; j < n; j++)
            if (edges_cross(a[i], a[(i + 1) % m], b[j], b[(j + 1) % n], at))
                return true;
    return false;
}

static double area_of(const double (*p)[2], size_t count)
{
    double area = 0;
    for (size_t i = 1; i + 1 < count; i++)
        area += side_of(p[0], p[i], p[i + 1]) / 2;
    return area;
}

static bool add_ring(ring_list *l, const double (*p)[2], size_t count, bool anticlockwise)
{
    bool good = ring_list_begin(l), turned = (area_of(p, count) > 0) != anticlockwise;
    for (size_t i = 0; i < count && good; i++)
        good = ring_list_add(l, p[turned ? count - 1 - i : i]);
    return good;
}

/* What comes on a ring: its corners, and where its edges cross others. */
typedef struct ring_stop {
    size_t edge; /* that it lies on, or that begins there */
    double along, at[2];
    size_t crossing; /* a number that two stops share; NO_CROSSING: a corner */
} ring_stop;

typedef struct stop_list {
    ring_stop *items;
    size_t     count, capacity;
} stop_list;

enum { CROSSINGS_MOST = 4096 };
#define NO_CROSSING SIZE_MAX

static bool add_stop(stop_list *l, size_t edge, double along, const double at[2], size_t crossing)
{
    if (!mem_grow((void **)&l->items, &l->capacity, l->count + 1, sizeof *l->items))
        return false;
    l->items[l->count++] = (ring_stop){edge, along, {at[0], at[1]}, crossing};
    return true;
}

static int by_way(const void *a, const void *b)
{
    const ring_stop *one = a, *other = b;
    if (one->edge != other->edge)
        return one->edge < other->edge ? -1 : 1;
    return one->along != other->along ? (one->along < other->along ? -1 : 1)
                                      : (one->crossing > other->crossing) - (one->crossing < other->crossing);
}

/* All stops in their order. */
static bool find_stops(stop_list *l, const double (*p)[2], size_t count, size_t *crossings)
{
    bool good = true;
    *crossings = 0;
    for (size_t i = 0; i < count && good; i++) {
        good = add_stop(l, i, -1, p[i], NO_CROSSING);
        for (size_t j = i + 2; j < count && good && count <= CORNERS_MOST && *crossings < CROSSINGS_MOST; j++) {
            const double *a = p[i], *b = p[i + 1], *c = p[j], *d = p[(j + 1) % count];
            double        at[2];
            if (!edges_cross(a, b, c, d, at))
                continue;
            good = add_stop(l, i, hypot(at[0] - a[0], at[1] - a[1]), at, *crossings) &&
                   add_stop(l, j, hypot(at[0] - c[0], at[1] - c[1]), at, *crossings);
            ++*crossings;
        }
    }
    if (*crossings)
        qsort(l->items, l->count, sizeof *l->items, by_way);
    return good;
}

/* Where two edges cross, each goes on as the other one: what comes of it are loops that cross nothing (Seifert). */
static bool follow(ring_list *out, const stop_list *l, size_t crossings)
{
    size_t *next = mem_alloc((l->count + crossings) * sizeof *next), *twin = next ? next + l->count : NULL;
    bool    good = next != NULL;
    for (size_t k = 0; k < crossings && good; k++)
        twin[k] = NO_CROSSING;
    for (size_t i = 0; i < l->count && good; i++)
        next[i] = (i + 1) % l->count;
    for (size_t i = 0; i < l->count && good; i++) {
        size_t crossing = l->items[i].crossing;
        if (crossing == NO_CROSSING)
            continue;
        if (twin[crossing] == NO_CROSSING) {
            twin[crossing] = i;
            continue;
        }
        size_t kept = next[i];
        next[i] = next[twin[crossing]];
        next[twin[crossing]] = kept;
    }
    for (size_t begin = 0; begin < l->count && good; begin++) {
        if (next[begin] == NO_CROSSING)
            continue;
        good = ring_list_begin(out);
        for (size_t at = begin; good && next[at] != NO_CROSSING;) {
            size_t then = next[at];
            good = ring_list_add(out, l->items[at].at);
            next[at] = NO_CROSSING;
            at = then;
        }
    }
    mem_free(next);
    return good;
}

/* The loops of one ring. */
static bool take_apart(untangled *u, const double (*p)[2], size_t count)
{
    stop_list l = {.items = NULL};
    size_t    crossings;
    u->loops.ring_count = u->loops.position_count = 0;
    bool good = find_stops(&l, p, count, &crossings) && follow(&u->loops, &l, crossings);
    u->crossing += crossings > 0;
    mem_free(l.items);
    return good;
}

/* Does a loop lie in another one of its ring? */
static bool is_nested(const ring_list *l, size_t loop, size_t begin)
{
    for (size_t k = 0, at = 0; k < l->ring_count; at += l->counts[k], k++) {
        const double *a = l->positions[begin], *b = l->positions[begin + 1];
        const double  middle[2] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
        if (k != loop && ring_has((const double(*)[2])l->positions + at, l->counts[k], middle))
            return true;
    }
    return false;
}

static bool add_outlines(untangled *u, const double (*p)[2], size_t count)
{
    const ring_list *l = &u->loops;
    bool             good = take_apart(u, p, count);
    for (size_t k = 0, at = 0; k < l->ring_count && good; at += l->counts[k], k++) {
        const double(*own)[2] = (const double(*)[2])l->positions + at;
        if (l->ring_count > 1 && (fabs(area_of(own, l->counts[k])) < LEAST_AREA || is_nested(l, k, at)))
            continue;
        good = mem_grow((void **)&u->polygons, &u->capacity, u->count + 1, sizeof *u->polygons);
        if (good)
            u->polygons[u->count++] = (untangled_polygon){u->rings.ring_count, 1, u->rings.position_count};
        good = good && add_ring(&u->rings, own, l->counts[k], true);
    }
    return good;
}

/* Can a hole lie in the polygon that was begun last? */
static bool takes_hole(const untangled *u, const untangled_polygon *to, const double (*hole)[2], size_t count)
{
    size_t at = to->position;
    for (size_t k = 0; k < to->rings; at += u->rings.counts[to->first + k], k++) {
        const double(*ring)[2] = (const double(*)[2])u->rings.positions + at;
        size_t own = u->rings.counts[to->first + k];
        if (ring_has(ring, own, hole[0]) != (k == 0) || (k > 0 && ring_has(hole, count, ring[0])) ||
            rings_cross(ring, own, hole, count))
            return false;
    }
    return true;
}

/* Holes of one polygon, behind its outline, which is the last ring. */
static bool add_holes_of(untangled *u, untangled_polygon *to, const double (*positions)[2], const size_t *counts,
                         size_t rings)
{
    bool good = true;
    for (size_t k = 1, at = counts[0]; k < rings && good; at += counts[k], k++) {
        if (counts[k] < 3 || !takes_hole(u, to, positions + at, counts[k]))
            continue;
        good = add_ring(&u->rings, positions + at, counts[k], false);
        to->rings++;
    }
    return good;
}

/* Where there are several outlines, which lie one behind the other, the rings are put anew, each with its holes. */
static bool add_holes(untangled *u, const double (*positions)[2], const size_t *counts, size_t rings)
{
    if (u->count < 2 || rings < 2)
        return u->count == 0 || add_holes_of(u, &u->polygons[0], positions, counts, rings);
    ring_list outlines = u->rings;
    bool      good = true;
    u->rings = (ring_list){.positions = NULL};
    for (size_t p = 0; p < u->count && good; p++) {
        untangled_polygon *to = &u->polygons[p];
        const double(*own)[2] = (const double(*)[2])outlines.positions + to->position;
        size_t count = outlines.counts[to->first];
        *to = (untangled_polygon){u->rings.ring_count, 1, u->rings.position_count};
        good = add_ring(&u->rings, own, count, true) && add_holes_of(u, to, positions, counts, rings);
    }
    ring_list_release(&outlines);
    return good;
}

bool untangle(untangled *u, const double (*positions)[2], const size_t *counts, size_t rings)
{
    size_t taken = 0;
    u->count = u->rings.ring_count = u->rings.position_count = 0;
    bool good = add_outlines(u, positions, counts[0]) && add_holes(u, positions, counts, rings);
    for (size_t p = 0; p < u->count; p++)
        taken += u->polygons[p].rings - 1;
    u->stray_holes += good && rings - 1 > taken ? rings - 1 - taken : 0;
    return good;
}

void untangle_release(untangled *u)
{
    ring_list_release(&u->rings);
    ring_list_release(&u->loops);
    mem_free(u->polygons);
    *u = (untangled){.polygons = NULL};
}
