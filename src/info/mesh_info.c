#include "info/mesh_info.h"

#include <stdlib.h>

#include "base/memory.h"
#include "stroke/edges.h"

typedef struct edge_counts {
    json_int_t edges, borders, non_manifold;
} edge_counts;

static int by_value(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Edges by how many faces have them: one, two, or more. */
static bool count_edges(edge_counts *out, const edge_mesh *m)
{
    size_t    count = 3 * (size_t)m->face_count;
    uint64_t *pairs = mem_alloc(count * sizeof *pairs);
    if (!pairs)
        return false;
    for (size_t i = 0; i < count; i++) {
        uint32_t a = m->faces[i / 3][i % 3], b = m->faces[i / 3][(i + 1) % 3];
        pairs[i] = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    }
    qsort(pairs, count, sizeof *pairs, by_value);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && pairs[end] == pairs[i];)
            end++;
        out->edges++;
        out->borders += end - i == 1;
        out->non_manifold += end - i > 2;
    }
    mem_free(pairs);
    return true;
}

json_t *mesh_info_json(const mesh *m)
{
    const double RIGHT_ANGLE = 1.5707963267948966; /* creases are of no interest */
    edge_mesh    edges;
    edge_counts  counts = {0};
    json_t      *out = NULL;
    if (edge_mesh_create(&edges, m, NULL, RIGHT_ANGLE, NULL) != LMN_OK)
        return NULL;
    if (edges.face_count && count_edges(&counts, &edges)) {
        json_int_t bodies = (json_int_t)edges.piece_count - (edges.line_count > 0), closed = 0;
        for (json_int_t i = 0; i < bodies; i++)
            closed += edges.closed[i];
        out = json_pack("{s:I,s:I,s:I,s:I,s:I}", "edges", counts.edges, "borders", counts.borders, "non_manifold",
                        counts.non_manifold, "bodies", bodies, "closed_bodies", closed);
    }
    edge_mesh_release(&edges);
    return out;
}
