/* Which half-edge lies on the other side of each. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/mesh.h"

/* A half-edge in the bucket of its lower vertex. */
typedef struct half_edge {
    uint32_t high, index;
} half_edge;

enum { INSERTION_MAX = 24 };

static int compare(const void *a, const void *b)
{
    const half_edge *p = a, *q = b;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    return p->index < q->index ? -1 : p->index > q->index;
}

/* Sorts by the higher vertex, equal ones in the order of the half-edges. */
static void sort_bucket(half_edge *edges, size_t count)
{
    if (count > INSERTION_MAX) {
        qsort(edges, count, sizeof *edges, compare);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        half_edge moved = edges[i];
        size_t    k = i;
        for (; k > 0 && edges[k - 1].high > moved.high; k--)
            edges[k] = edges[k - 1];
        edges[k] = moved;
    }
}

static void edge_ends(const primitive *p, const uint32_t *ids, uint32_t h, uint32_t *low, uint32_t *high)
{
    uint32_t next = h % 3 == 2 ? h - 2 : h + 1;
    uint32_t a = ids[p->indices[h]], b = ids[p->indices[next]];
    *low = a < b ? a : b;
    *high = a < b ? b : a;
}

/* starts[v] … starts[v + 1] becomes the range of vertex v's bucket. */
static void count_buckets(const primitive *p, const uint32_t *ids, uint32_t *starts)
{
    uint32_t low, high;
    for (uint32_t h = 0; h < p->index_count; h++) {
        edge_ends(p, ids, h, &low, &high);
        starts[low + 1]++;
    }
    for (uint32_t v = 0; v < p->vertex_count; v++)
        starts[v + 1] += starts[v];
}

static void pair_bucket(const half_edge *edges, size_t count, uint32_t vertex, uint32_t *opposite)
{
    for (size_t i = 0; i + 1 < count; i++)
        if (edges[i].high == edges[i + 1].high && edges[i].high != vertex) {
            opposite[edges[i].index] = edges[i + 1].index;
            opposite[edges[i + 1].index] = edges[i].index;
            i++;
        }
}

uint32_t *mesh_adjacency(const primitive *p)
{
    size_t     edge_count = p->index_count;
    uint32_t  *ids = mesh_position_ids(p);
    uint32_t  *opposite = mem_alloc(edge_count * sizeof *opposite);
    uint32_t  *starts = mem_calloc((size_t)p->vertex_count + 2, sizeof *starts);
    half_edge *edges = mem_alloc(edge_count * sizeof *edges);
    if (ids && opposite && starts && edges) {
        memset(opposite, 0xFF, edge_count * sizeof *opposite);
        count_buckets(p, ids, starts);
        for (uint32_t h = 0; h < p->index_count; h++) {
            uint32_t low, high;
            edge_ends(p, ids, h, &low, &high);
            edges[starts[low]++] = (half_edge){high, h};
        }
        /* Filling moved each start to the bucket's end, which is where the next one began. */
        for (uint32_t v = 0, begin = 0; v < p->vertex_count; v++) {
            uint32_t end = starts[v];
            sort_bucket(edges + begin, end - begin);
            pair_bucket(edges + begin, end - begin, v, opposite);
            begin = end;
        }
    } else {
        mem_free(opposite);
        opposite = NULL;
    }
    mem_free(ids);
    mem_free(starts);
    mem_free(edges);
    return opposite;
}
