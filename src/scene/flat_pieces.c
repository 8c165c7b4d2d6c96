#include "scene/flat_pieces.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "base/work.h"

static const double even = 0.99998; /* cosine of 0.36 degrees: normals of a piece differ from the first by no more */
/* A neighbour of more than this share of a piece's area is like it; a piece with such ones along more than this share
 * of its rim is a facet. */
static const double alike = 1.0 / 6, beside_alike = 0.35;
/* A single triangle or quadrangle, as coarse round things consist of, only if there are hardly any. */
static const double beside_alike_small = 0.05;
enum { SMALL_PIECE = 2 };

typedef struct sized_triangle {
    double   area;
    uint32_t triangle;
} sized_triangle;

static int by_area(const void *a, const void *b)
{
    const sized_triangle *one = a, *other = b;
    if (one->area != other->area)
        return one->area > other->area ? -1 : 1;
    return one->triangle < other->triangle ? -1 : one->triangle > other->triangle;
}

/* Triangles, the largest first; NULL when memory is gone. */
static sized_triangle *sort_triangles(const flat_triangles *t)
{
    sized_triangle *sorted = mem_alloc(t->count * sizeof *sorted);
    for (uint32_t i = 0; sorted && i < t->count; i++)
        sorted[i] = (sized_triangle){t->areas[i], i};
    if (sorted && t->count)
        qsort(sorted, t->count, sizeof *sorted, by_area);
    return sorted;
}

/* From the largest triangle that is left: all that hang together with it and lie as it does. */
static void collect(flat_pieces *to, const flat_triangles *t, uint32_t seed, uint32_t begin)
{
    flat_piece *out = &to->items[to->count];
    uint32_t    number = (uint32_t)to->count, end = begin;
    *out = (flat_piece){.first = begin};
    vector3_copy(out->normal, t->normals[seed]);
    to->of[seed] = number;
    to->members[end++] = seed;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t own = to->members[i];
        out->area += t->areas[own];
        for (uint32_t h = 3 * own; h < 3 * own + 3; h++) {
            uint32_t other = t->opposite[h] == UINT32_MAX ? UINT32_MAX : t->opposite[h] / 3;
            if (other == UINT32_MAX || to->of[other] != UINT32_MAX)
                continue;
            const double *n = t->normals[other];
            if (vector3_dot(n, n) > 0 && vector3_dot(n, out->normal) < even)
                continue;
            to->of[other] = number;
            to->members[end++] = other;
        }
    }
    out->count = end - begin;
}

static bool collect_all(flat_pieces *to, const flat_triangles *t)
{
    uint32_t        end = 0;
    sized_triangle *sorted = sort_triangles(t);
    bool            good = sorted != NULL;
    memset(to->of, 0xFF, t->count * sizeof *to->of);
    for (uint32_t i = 0; i < t->count && good; i++) {
        if (to->of[sorted[i].triangle] != UINT32_MAX)
            continue;
        good = !work_stopped() && mem_grow((void **)&to->items, &to->capacity, to->count + 1, sizeof *to->items);
        if (!good)
            break;
        collect(to, t, sorted[i].triangle, end);
        end += to->items[to->count++].count;
    }
    mem_free(sorted);
    return good;
}

static void measure_rims(flat_pieces *to, const flat_triangles *t)
{
    for (uint32_t h = 0; h < 3 * t->count; h++) {
        flat_piece *piece = &to->items[to->of[h / 3]];
        uint32_t    beside = t->opposite[h] == UINT32_MAX ? UINT32_MAX : to->of[t->opposite[h] / 3];
        if (beside == to->of[h / 3])
            continue;
        piece->rim += t->lengths[h];
        if (beside != UINT32_MAX && to->items[beside].area > alike * piece->area)
            piece->beside += t->lengths[h];
    }
}

bool flat_pieces_find(flat_pieces *out, const flat_triangles *t)
{
    *out = (flat_pieces){.of = mem_alloc(t->count * sizeof *out->of + 1),
                         .members = mem_alloc(t->count * sizeof *out->members + 1)};
    if (!out->of || !out->members || !collect_all(out, t))
        return false;
    measure_rims(out, t);
    return true;
}

void flat_pieces_release(flat_pieces *p)
{
    mem_free(p->of);
    mem_free(p->members);
    mem_free(p->items);
    *p = (flat_pieces){0};
}

bool flat_piece_is_plane(const flat_piece *piece)
{
    double most = piece->count <= SMALL_PIECE ? beside_alike_small : beside_alike;
    return piece->area > 0 && vector3_dot(piece->normal, piece->normal) > 0 && piece->beside <= most * piece->rim &&
           piece->rim > 0;
}
