/* From the edges of faces side by side to the contours around them all. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "construct/construct_private.h"

int compare_positions(const void *a, const void *b)
{
    const point2 *p = a, *q = b;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return (p->y > q->y) - (p->y < q->y);
}

int compare_plane_edges(const void *a, const void *b)
{
    const plane_edge *p = a, *q = b;
    int               order = compare_positions(&p->from, &q->from);
    return order ? order : compare_positions(&p->to, &q->to);
}

#define NOWHERE SIZE_MAX

/* A walk along the border, the inside on its left. A vertex is known by its first edge. */
typedef struct walk {
    plane_edge     *edges; /* sorted by where they begin */
    size_t          count;
    bool           *used;
    size_t         *position; /* of a vertex on the way; NOWHERE when it is not on it */
    size_t         *path;     /* vertices */
    size_t          path_length;
    point2         *points; /* room for one contour */
    region_builder *b;
} walk;

/* The first edge that begins here. */
static size_t find_vertex(const walk *w, point2 at)
{
    size_t low = 0, high = w->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (compare_positions(&w->edges[middle].from, &at) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool begins_at(const walk *w, size_t edge, size_t vertex)
{
    return edge < w->count && compare_positions(&w->edges[edge].from, &w->edges[vertex].from) == 0;
}

/* Do contours touch here? */
static bool is_shared(const walk *w, size_t vertex)
{
    return begins_at(w, vertex + 1, vertex);
}

/* How far to turn clockwise from the way back until this edge, (0, 2 pi]. */
static double turn_to(const plane_edge *back, const plane_edge *edge)
{
    double rx = back->from.x - back->to.x, ry = back->from.y - back->to.y;
    double ex = edge->to.x - edge->from.x, ey = edge->to.y - edge->from.y;
    double angle = -atan2(rx * ey - ry * ex, rx * ex + ry * ey);
    return angle > 0 ? angle : angle + 2 * PI;
}

/* The way on is the first edge clockwise from the way back: nothing but inside lies between them. */
static size_t choose_next(const walk *w, size_t vertex, const plane_edge *arrived)
{
    size_t best = NOWHERE;
    double least = INFINITY;
    for (size_t i = vertex; begins_at(w, i, vertex); i++) {
        double angle = w->used[i] ? INFINITY : arrived ? turn_to(arrived, &w->edges[i]) : 0;
        if (angle < least) {
            least = angle;
            best = i;
        }
    }
    return best;
}

/* Leaves out points on the straight line between their neighbours, and spikes; until none is left. Where another
 * contour touches the line the point stays: without it the touching would be found again later, and not by all in
 * the same way. */
static size_t drop_straight(const walk *w, point2 *points, size_t count)
{
    size_t before = count + 1;
    while (count >= 3 && count < before) {
        before = count;
        size_t kept = 0;
        for (size_t i = 0; i < before; i++) {
            point2 a = points[kept > 0 ? kept - 1 : before - 1], b = points[i],
                   next = points[i + 1 < before ? i + 1 : 0];
            bool straight = (b.x - a.x) * (next.y - b.y) == (b.y - a.y) * (next.x - b.x);
            if (!straight || is_shared(w, find_vertex(w, b)))
                points[kept++] = b;
        }
        count = kept;
    }
    return count;
}

/* The way from this position on has come back to where it was: it is a contour. */
static void take_loop(walk *w, size_t from)
{
    size_t count = w->path_length - from;
    for (size_t i = 0; i < count; i++) {
        w->points[i] = w->edges[w->path[from + i]].from;
        w->position[w->path[from + i]] = NOWHERE;
    }
    w->path_length = from;
    count = drop_straight(w, w->points, count);
    if (contour_area2(w->points, count) == 0)
        return;
    builder_contour(w->b);
    for (size_t i = 0; i < count; i++)
        builder_set_position(w->b, w->points[i].x, w->points[i].y);
    builder_end_contour(w->b);
}

static void walk_from(walk *w, size_t edge)
{
    const plane_edge *arrived = NULL;
    size_t            vertex = find_vertex(w, w->edges[edge].from);
    for (;;) {
        if (w->position[vertex] != NOWHERE) {
            take_loop(w, w->position[vertex]);
            if (w->path_length == 0)
                return;
        }
        size_t next = arrived ? choose_next(w, vertex, arrived) : edge;
        if (next == NOWHERE)
            break; /* cannot be: as many edges end at a position as begin there */
        w->used[next] = true;
        w->position[vertex] = w->path_length;
        w->path[w->path_length++] = vertex;
        arrived = &w->edges[next];
        vertex = find_vertex(w, arrived->to);
        if (vertex == w->count)
            break;
    }
    for (size_t i = 0; i < w->path_length; i++)
        w->position[w->path[i]] = NOWHERE;
    w->path_length = 0;
}

/* Sorts, and leaves out edges between two faces, which are there in both directions. */
static size_t cancel_inner(plane_edge *edges, size_t count, bool *inner)
{
    qsort(edges, count, sizeof *edges, compare_plane_edges);
    for (size_t i = 0; i < count; i++) {
        plane_edge back = {edges[i].to, edges[i].from};
        inner[i] = bsearch(&back, edges, count, sizeof back, compare_plane_edges) != NULL;
    }
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (!inner[i])
            edges[kept++] = edges[i];
    return kept;
}

bool edges_trace(region *out, plane_edge *edges, size_t count)
{
    region_builder b = {0};
    walk           w = {.edges = edges, .b = &b};
    *out = (region){0};
    w.used = mem_calloc(count, sizeof *w.used);
    w.position = mem_calloc(count, sizeof *w.position);
    w.path = mem_calloc(count, sizeof *w.path);
    w.points = mem_calloc(count, sizeof *w.points);
    b.failed = !w.used || !w.position || !w.path || !w.points;
    if (!b.failed) {
        w.count = cancel_inner(edges, count, w.used);
        memset(w.used, 0, count * sizeof *w.used);
        memset(w.position, 0xFF, count * sizeof *w.position);
    }
    for (size_t i = 0; i < w.count && !b.failed; i++)
        if (!w.used[i])
            walk_from(&w, i);
    mem_free(w.used);
    mem_free(w.position);
    mem_free(w.path);
    mem_free(w.points);
    return region_builder_finish(&b, out, NULL) == LMN_OK;
}
