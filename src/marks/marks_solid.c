/* Is a surface closed, with normals that look out (marks/clusters.h)? Then what turns away from a viewer outside is
 * hidden. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "marks/clusters.h"
#include "marks/d3.h"

typedef struct corner {
    vec3     at;
    uint32_t part, vertex; /* vertex: as triangles count, 3 a triangle */
} corner;

typedef struct half_edge {
    uint32_t low, high; /* numbers of corners that are told apart */
    uint32_t triangle;
    bool     back; /* from high to low */
} half_edge;

static int by_place(const void *left, const void *right)
{
    const corner *a = left, *b = right;
    if (a->part != b->part)
        return a->part < b->part ? -1 : 1;
    const float x[3] = {a->at.x, a->at.y, a->at.z}, y[3] = {b->at.x, b->at.y, b->at.z};
    for (int k = 0; k < 3; k++)
        if (x[k] != y[k])
            return x[k] < y[k] ? -1 : 1;
    return 0;
}

static int by_ends(const void *left, const void *right)
{
    const half_edge *a = left, *b = right;
    if (a->low != b->low)
        return a->low < b->low ? -1 : 1;
    if (a->high != b->high)
        return a->high < b->high ? -1 : 1;
    return (int)a->back - (int)b->back;
}

static uint32_t root_of(uint32_t *parents, uint32_t i)
{
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/* Numbers corners so that those at one place of a part are one. False when memory is gone. */
static bool weld(uint32_t *numbers, const mark_surface *s, const uint32_t *parts)
{
    size_t  count = 3 * (size_t)s->triangle_count;
    corner *corners = mem_alloc(count * sizeof *corners);
    for (size_t i = 0; corners && i < count; i++)
        corners[i] = (corner){s->positions[s->indices[i]], parts ? parts[i / 3] : 0, (uint32_t)i};
    if (!corners)
        return false;
    qsort(corners, count, sizeof *corners, by_place);
    uint32_t number = 0;
    for (size_t i = 0; i < count; i++) {
        number += i > 0 && by_place(&corners[i - 1], &corners[i]) != 0;
        numbers[corners[i].vertex] = number;
    }
    mem_free(corners);
    return true;
}

static d3 point_of(const mark_surface *s, size_t i)
{
    return of(s->positions[s->indices[i]]);
}

/* Six times the signed volume of the triangle with the origin, and whether its corners go the other way round than its
 * normals say. */
static double volume_of(const mark_surface *s, uint32_t t, bool *turned)
{
    d3     a = point_of(s, 3 * (size_t)t), b = point_of(s, 3 * (size_t)t + 1), c = point_of(s, 3 * (size_t)t + 2);
    d3     n = cross(minus(b, a), minus(c, a));
    double look = 0;
    for (int k = 0; k < 3; k++) {
        look += dot(n, of(s->normals[s->indices[3 * (size_t)t + (size_t)k]]));
    }
    *turned = look < 0;
    return (*turned ? -1 : 1) * dot(a, n);
}

/* Each edge belongs to two triangles that run along it in opposite ways. Joins what hangs together. */
static bool edges_meet(half_edge *edges, size_t count, uint32_t *parents)
{
    bool meet = count % 2 == 0;
    qsort(edges, count, sizeof *edges, by_ends);
    for (size_t i = 0; meet && i < count; i += 2) {
        const half_edge *a = &edges[i], *b = &edges[i + 1];
        bool             again = i + 2 < count && edges[i + 2].low == a->low && edges[i + 2].high == a->high;
        meet = a->low == b->low && a->high == b->high && a->back != b->back && !again;
        parents[root_of(parents, a->triangle)] = root_of(parents, b->triangle);
    }
    return meet;
}

static size_t find_edges(half_edge *edges, double *volumes, const mark_surface *s, const uint32_t *numbers)
{
    size_t count = 0;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        const uint32_t *n = &numbers[3 * (size_t)t];
        bool            turned;
        volumes[t] = volume_of(s, t, &turned);
        if (n[0] == n[1] || n[1] == n[2] || n[2] == n[0]) {
            volumes[t] = NAN; /* no triangle: it has no edges, and hangs together with nothing */
            continue;
        }
        for (int k = 0; k < 3; k++) {
            uint32_t from = n[k], to = n[(k + 1) % 3];
            edges[count++] = (half_edge){from < to ? from : to, from < to ? to : from, t, (from > to) != turned};
        }
    }
    return count;
}

bool mark_surface_is_solid(const mark_surface *s, const uint32_t *parts)
{
    size_t     count = 3 * (size_t)s->triangle_count;
    uint32_t  *numbers = mem_alloc((count + 1) * sizeof *numbers), *parents = mem_alloc((count + 1) * sizeof *parents);
    half_edge *edges = mem_alloc((count + 1) * sizeof *edges);
    double    *volumes = mem_alloc((count + 1) * sizeof *volumes);
    bool       solid = numbers && parents && edges && volumes && count > 0 && weld(numbers, s, parts);
    if (solid) {
        for (uint32_t t = 0; t < s->triangle_count; t++)
            parents[t] = t;
        size_t found = find_edges(edges, volumes, s, numbers);
        solid = found > 0 && edges_meet(edges, found, parents);
    }
    for (uint32_t t = 0; solid && t < s->triangle_count; t++) {
        uint32_t root = root_of(parents, t);
        if (root != t) {
            volumes[root] += volumes[t];
            volumes[t] = NAN;
        }
    }
    for (uint32_t t = 0; solid && t < s->triangle_count; t++)
        solid = isnan(volumes[t]) || volumes[t] > 0;
    mem_free(numbers);
    mem_free(parents);
    mem_free(edges);
    mem_free(volumes);
    return solid;
}
