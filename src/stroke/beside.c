/* Pieces that nearly coincide: their faces change places all over, and where they cross says nothing. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Crossings that hang together over their ends. */
typedef struct web {
    const crossing_list *list;
    uint32_t            *parents, *slots; /* per crossing; hash table of ends: 2 · crossing + end */
    size_t               mask;
    double *lengths, *plain; /* of a whole web, at its root: all, and where two surfaces meet beyond doubt */
} web;

static uint32_t root_of(web *w, uint32_t i)
{
    while (w->parents[i] != i)
        i = w->parents[i] = w->parents[w->parents[i]];
    return i;
}

/* Joins a crossing with the one that has an end at the same position. */
static void join_end(web *w, uint32_t crossing, uint32_t end)
{
    const double3 p = w->list->crossings[crossing].ends[end];
    uint64_t      bits[3];
    memcpy(bits, &p, sizeof bits);
    size_t slot = line_id(line_id(bits[0], bits[1]), bits[2]) & w->mask;
    for (; w->slots[slot] != NO_VERTEX; slot = (slot + 1) & w->mask) {
        uint32_t other = w->slots[slot];
        if (memcmp(&w->list->crossings[other / 2].ends[other % 2], &p, sizeof p) == 0) {
            w->parents[root_of(w, crossing)] = root_of(w, other / 2);
            return;
        }
    }
    w->slots[slot] = 2 * crossing + end;
}

static bool weave(web *w, const crossing_list *list)
{
    size_t slots = 64;
    while (slots < 4 * list->count)
        slots *= 2;
    *w = (web){.list = list, .mask = slots - 1};
    w->parents = mem_alloc((list->count + 1) * sizeof *w->parents);
    w->slots = mem_alloc(slots * sizeof *w->slots);
    w->lengths = mem_calloc(list->count + 1, sizeof *w->lengths);
    w->plain = mem_calloc(list->count + 1, sizeof *w->plain);
    if (!w->parents || !w->slots || !w->lengths || !w->plain)
        return false;
    memset(w->slots, 0xFF, slots * sizeof *w->slots);
    for (uint32_t i = 0; i < list->count; i++)
        w->parents[i] = i;
    for (uint32_t i = 0; i < list->count; i++) {
        join_end(w, i, 0);
        join_end(w, i, 1);
    }
    for (uint32_t i = 0; i < list->count; i++) {
        const face_crossing *c = &list->crossings[i];
        double3              d = double3_minus(c->ends[1], c->ends[0]);
        double               length = sqrt(double3_dot(d, d));
        uint32_t             root = root_of(w, i);
        w->lengths[root] += length;
        w->plain[root] += c->one_surface ? 0 : length;
    }
    return true;
}

static int compare_pairs(const void *a, const void *b)
{
    const uint32_t *p = a, *q = b;
    return p[0] != q[0] ? (p[0] < q[0] ? -1 : 1) : p[1] < q[1] ? -1 : p[1] > q[1];
}

static bool put_beside(crossing_list *l, const uint32_t pieces[2])
{
    const uint32_t pairs[2][2] = {{pieces[0], pieces[1]}, {pieces[1], pieces[0]}};
    if (l->beside_count && memcmp(l->beside[l->beside_count - 2], pairs, sizeof pairs) == 0)
        return true;
    if (!mem_grow((void **)&l->beside, &l->beside_capacity, l->beside_count + 2, sizeof *l->beside))
        return false;
    memcpy(l->beside + l->beside_count, pairs, sizeof pairs);
    l->beside_count += 2;
    return true;
}

/* Each once, in order. */
static void sort_beside(crossing_list *c)
{
    size_t kept = 0;
    if (c->beside_count)
        qsort(c->beside, c->beside_count, sizeof *c->beside, compare_pairs);
    for (size_t i = 0; i < c->beside_count; i++)
        if (kept == 0 || compare_pairs(c->beside[kept - 1], c->beside[i]) != 0)
            memmove(c->beside[kept++], c->beside[i], sizeof *c->beside);
    c->beside_count = kept;
}

bool crossings_settle(crossing_list *list)
{
    size_t doubtful = 0, kept = 0;
    web    w;
    for (size_t i = 0; i < list->count; i++)
        doubtful += list->crossings[i].one_surface;
    if (!doubtful)
        return true;
    bool good = weave(&w, list);
    /* Of roots no more is asked once crossings move. */
    for (uint32_t i = 0; i < list->count && good; i++)
        w.parents[i] = root_of(&w, i);
    for (uint32_t i = 0; i < list->count && good; i++) {
        const face_crossing c = list->crossings[i];
        if (w.plain[w.parents[i]] >= 0.5 * w.lengths[w.parents[i]])
            list->crossings[kept++] = c;
        else if (c.one_surface)
            good = put_beside(list, c.pieces);
    }
    list->count = good ? kept : list->count;
    sort_beside(list);
    mem_free(w.parents);
    mem_free(w.slots);
    mem_free(w.lengths);
    mem_free(w.plain);
    return good;
}

/* The first of all pairs of a piece, or where it would be. */
static size_t first_beside(const crossing_list *c, uint32_t piece)
{
    size_t low = 0, high = c->beside_count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (c->beside[middle][0] < piece)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool beside_link(view_lines *out, const stroke_view *v, const crossing_list *c)
{
    if (!c->beside_count)
        return true;
    out->beside = mem_alloc(c->beside_count * sizeof *out->beside);
    for (size_t i = 0; i < c->beside_count && out->beside; i++)
        out->beside[i] = c->beside[i][1];
    for (size_t i = 0; i < out->count && out->beside; i++) {
        window_segment *s = &out->segments[i];
        if (s->faces[0] == EDGE_NO_FACE)
            continue;
        uint32_t piece = v->face_pieces[s->faces[0]];
        size_t   first = first_beside(c, piece);
        s->beside = out->beside + first;
        s->beside_count = (uint32_t)(first_beside(c, piece + 1) - first);
    }
    return out->beside != NULL;
}
