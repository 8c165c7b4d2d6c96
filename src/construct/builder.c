/* Growing polyhedra, and making points at the same position one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "construct/construct_private.h"

void builder_point(solid_builder *b, double x, double y, double z)
{
    if (b->failed || !mem_grow((void **)&b->points, &b->point_capacity, b->point_count + 1, sizeof *b->points)) {
        b->failed = true;
        return;
    }
    /* -0 + 0 is +0: both zeros are one position. */
    b->points[b->point_count++] = (point3){x + 0.0, y + 0.0, z + 0.0};
}

void builder_triangle(solid_builder *b, uint32_t i, uint32_t j, uint32_t k)
{
    if (i == j || j == k || k == i)
        return;
    size_t corners = b->triangle_count * 3;
    if (b->failed || !mem_grow((void **)&b->triangles, &b->triangle_capacity, corners + 3, sizeof *b->triangles)) {
        b->failed = true;
        return;
    }
    b->triangles[corners] = i;
    b->triangles[corners + 1] = j;
    b->triangles[corners + 2] = k;
    b->triangle_count++;
}

void builder_quad(solid_builder *b, uint32_t i, uint32_t j, uint32_t k, uint32_t l)
{
    builder_triangle(b, i, j, k);
    builder_triangle(b, i, k, l);
}

void builder_release(solid_builder *b)
{
    mem_free(b->points);
    mem_free(b->triangles);
    *b = (solid_builder){0};
}

/* --- points at the same position --------------------------------------------------------------------------- */

static uint64_t hash_point(const point3 *p)
{
    uint64_t bits[3];
    memcpy(bits, p, sizeof bits);
    uint64_t h = bits[0] * UINT64_C(0xBF58476D1CE4E5B9);
    h = ((h ^ h >> 32) + bits[1]) * UINT64_C(0x94D049BB133111EB);
    h = ((h ^ h >> 29) + bits[2]) * UINT64_C(0x9E3779B97F4A7C15);
    return h ^ h >> 31;
}

/* Fills positions[i] with the number of the first point where point i is; positions has room for all. */
static bool find_positions(const point3 *points, size_t count, uint32_t *positions)
{
    size_t slots = 16, bytes;
    while (slots < count * 2)
        slots *= 2;
    uint32_t *table = size_mul(slots, sizeof *table, &bytes) ? mem_alloc(bytes) : NULL;
    if (!table)
        return false;
    memset(table, 0xFF, bytes);
    for (size_t i = 0; i < count; i++) {
        size_t slot = (size_t)hash_point(&points[i]) & (slots - 1);
        while (table[slot] != UINT32_MAX && memcmp(&points[table[slot]], &points[i], sizeof *points) != 0)
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == UINT32_MAX)
            table[slot] = (uint32_t)i;
        positions[i] = table[slot];
    }
    mem_free(table);
    return true;
}

/* Rewrites the triangles to the first points, leaves out those that have become edges, and marks what is used. */
static void use_positions(solid_builder *b, const uint32_t *positions, uint8_t *used)
{
    size_t kept = 0;
    for (size_t i = 0; i < b->triangle_count; i++) {
        const uint32_t *t = &b->triangles[i * 3];
        uint32_t        at[3] = {positions[t[0]], positions[t[1]], positions[t[2]]};
        if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0])
            continue;
        for (int k = 0; k < 3; k++) {
            b->triangles[kept * 3 + (size_t)k] = at[k];
            used[at[k]] = 1;
        }
        kept++;
    }
    b->triangle_count = kept;
}

/* Leaves out points that no triangle has. */
static void drop_unused(solid_builder *b, uint32_t *numbers, const uint8_t *used)
{
    size_t kept = 0;
    for (size_t i = 0; i < b->point_count; i++)
        if (used[i]) {
            b->points[kept] = b->points[i];
            numbers[i] = (uint32_t)kept++;
        }
    b->point_count = kept;
    for (size_t i = 0; i < b->triangle_count * 3; i++)
        b->triangles[i] = numbers[b->triangles[i]];
}

static bool weld(solid_builder *b)
{
    uint32_t *positions = mem_calloc(b->point_count, sizeof *positions);
    uint8_t  *used = mem_calloc(b->point_count, 1);
    bool      done = positions && used && find_positions(b->points, b->point_count, positions);
    if (done) {
        use_positions(b, positions, used);
        drop_unused(b, positions, used);
    }
    mem_free(positions);
    mem_free(used);
    return done;
}

lmn_status builder_finish(solid_builder *b, polyhedron *out, lmn_error *error)
{
    *out = (polyhedron){0};
    if (b->failed || !weld(b)) {
        builder_release(b);
        return error_memory(error);
    }
    if (b->triangle_count == 0) {
        builder_release(b);
        return LMN_OK;
    }
    *out = (polyhedron){b->points, b->point_count, b->triangles, b->triangle_count, false};
    *b = (solid_builder){0};
    if (polyhedron_volume(out) < 0)
        polyhedron_turn_round(out);
    return LMN_OK;
}

/* --- questions ------------------------------------------------------------------------------------------ */

double polyhedron_volume(const polyhedron *p)
{
    if (p->triangle_count == 0)
        return 0;
    /* Seen from one of its points, what cancels is small. */
    point3 o = p->points[0];
    double sum = 0;
    for (size_t i = 0; i < p->triangle_count; i++) {
        double v[3][3];
        for (int k = 0; k < 3; k++) {
            const point3 *q = &p->points[p->triangles[i * 3 + (size_t)k]];
            v[k][0] = q->x - o.x;
            v[k][1] = q->y - o.y;
            v[k][2] = q->z - o.z;
        }
        sum += v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) + v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
               v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
    }
    return sum / 6;
}

void polyhedron_turn_round(polyhedron *p)
{
    for (size_t i = 0; i < p->triangle_count; i++) {
        uint32_t corner = p->triangles[i * 3 + 1];
        p->triangles[i * 3 + 1] = p->triangles[i * 3 + 2];
        p->triangles[i * 3 + 2] = corner;
    }
}

static int compare_edges(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

bool polyhedron_is_closed(const polyhedron *p, bool *failed)
{
    size_t    count = p->triangle_count * 3;
    uint64_t *edges = mem_calloc(count * 2, sizeof *edges), *back = edges ? edges + count : NULL;
    *failed = !edges;
    if (!edges)
        return false;
    for (size_t i = 0; i < count; i++) {
        uint64_t from = p->triangles[i], to = p->triangles[i % 3 == 2 ? i - 2 : i + 1];
        edges[i] = from << 32 | to;
        back[i] = to << 32 | from;
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    qsort(back, count, sizeof *back, compare_edges);
    bool closed = memcmp(edges, back, count * sizeof *edges) == 0;
    mem_free(edges);
    return closed;
}

lmn_status check_numbers(const char *shape, const double *numbers, size_t count, lmn_error *error)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(numbers[i]))
            return error_set(error, LMN_FORMAT, "%s: %g is no number that a shape can have", shape, numbers[i]);
    return LMN_OK;
}

lmn_status check_point_count(const char *shape, double count, lmn_error *error)
{
    if (count <= (double)LIMIT_SHAPE_POINTS)
        return LMN_OK;
    error_set(error, LMN_LIMIT, "%s: %.0f points are more than the %zu that one shape may have", shape, count,
              LIMIT_SHAPE_POINTS);
    error_hint(error, "choose a smaller $fn, or a larger $fa or $fs");
    return LMN_LIMIT;
}
