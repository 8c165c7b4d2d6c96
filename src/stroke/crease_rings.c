#include "stroke/crease_rings.h"

#include <math.h>

#include "base/memory.h"

/* The least turn of a ring is at least this fraction of the greatest. */
#define EVEN 0.6
/* Edges go on as one another when they turn by less: cosine. */
#define STRAIGHT 0.7
enum { EDGES_LEAST = 3 };
#define NO_EDGE UINT32_MAX

typedef struct ring_finder {
    const edge_mesh *m;
    const uint32_t  *starts, *edges;
    uint8_t         *states;
    uint8_t         *ends; /* per vertex: a line is there */
    uint8_t         *seen; /* per edge */
    uint32_t        *chain;
    size_t           count;
} ring_finder;

static void direction_of(const edge_mesh *m, const mesh_edge *e, uint32_t from, double out[3])
{
    bool   forward = e->vertex[0] == from;
    vec3   a = m->positions[e->vertex[forward ? 0 : 1]], b = m->positions[e->vertex[forward ? 1 : 0]];
    double way[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z};
    double length = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    for (int k = 0; k < 3; k++)
        out[k] = length > 0 ? way[k] / length : 0;
}

static double cosine_of(const edge_mesh *m, const mesh_edge *e)
{
    vec3 n = m->normals[e->face[0]], o = m->normals[e->face[1]];
    return fmax(fmin((double)n.x * o.x + (double)n.y * o.y + (double)n.z * o.z, 1), -1);
}

/* What a chain goes on as at a vertex; NO_EDGE: nothing. */
static uint32_t next_of(const ring_finder *r, uint32_t vertex, uint32_t edge)
{
    double   own[3], least = -STRAIGHT;
    uint32_t found = NO_EDGE;
    direction_of(r->m, &r->m->edges[edge], vertex, own);
    for (uint32_t i = r->starts[vertex]; i < r->starts[vertex + 1]; i++) {
        uint32_t other = r->edges[i];
        double   way[3];
        if (other == edge || r->states[other] != RING_MAY)
            continue;
        direction_of(r->m, &r->m->edges[other], vertex, way);
        double cosine = own[0] * way[0] + own[1] * way[1] + own[2] * way[2];
        if (cosine < least) {
            least = cosine;
            found = other;
        }
    }
    return found;
}

/* Goes along from an end of an edge; whether a line is at the end, or the way is back at `start`. */
static bool walk(ring_finder *r, uint32_t start, int end)
{
    const edge_mesh *m = r->m;
    uint32_t         edge = start, vertex = m->edges[start].vertex[end];
    while (!r->ends[vertex]) {
        uint32_t next = next_of(r, vertex, edge);
        if (next == start)
            return true;
        if (next == NO_EDGE || r->seen[next])
            return false;
        r->seen[next] = 1;
        r->chain[r->count++] = edge = next;
        vertex = m->edges[edge].vertex[0] == vertex ? m->edges[edge].vertex[1] : m->edges[edge].vertex[0];
    }
    return true;
}

static bool turns_alike(const ring_finder *r)
{
    double least = INFINITY, most = 0;
    for (size_t i = 0; i < r->count; i++) {
        double turn = acos(cosine_of(r->m, &r->m->edges[r->chain[i]]));
        least = fmin(least, turn);
        most = fmax(most, turn);
    }
    return least >= EVEN * most;
}

static void try_ring(ring_finder *r, uint32_t start)
{
    r->seen[start] = 1;
    r->chain[0] = start;
    r->count = 1;
    bool   whole = walk(r, start, 0);
    size_t first = r->count;
    /* What has come round is whole; else the other end is looked at, too. */
    bool round = whole && first > 1 && !r->ends[r->m->edges[start].vertex[0]] &&
                 next_of(r, r->m->edges[start].vertex[1], start) == r->chain[first - 1];
    if (whole && !round)
        whole = walk(r, start, 1);
    if (!whole || r->count < EDGES_LEAST || !turns_alike(r))
        return;
    for (size_t i = 0; i < r->count; i++)
        r->states[r->chain[i]] = RING_LINE;
}

bool crease_rings_close(const edge_mesh *m, const uint32_t *starts, const uint32_t *edges, uint8_t *states)
{
    ring_finder r = {.m = m, .starts = starts, .edges = edges, .states = states};
    r.ends = mem_calloc((size_t)m->vertex_count + 1, 1);
    r.seen = mem_calloc((size_t)m->edge_count + 1, 1);
    r.chain = mem_alloc(((size_t)m->edge_count + 1) * sizeof *r.chain);
    bool good = r.ends && r.seen && r.chain;
    for (uint32_t i = 0; good && i < m->edge_count; i++)
        for (int k = 0; k < 2; k++)
            if (states[i] == RING_LINE || (m->edges[i].flags & (EDGE_BORDER | EDGE_MATERIAL)))
                r.ends[m->edges[i].vertex[k]] = 1;
    for (uint32_t i = 0; good && i < m->edge_count; i++)
        if (states[i] == RING_MAY && !r.seen[i])
            try_ring(&r, i);
    mem_free(r.ends);
    mem_free(r.seen);
    mem_free(r.chain);
    return good;
}
