/* Vertices that were one before somebody rounded them: poles of spheres whose sines are 1e-17 and not 0, seams that two
 * programs computed. A mesh is torn there, and its outlines too. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "scene/mesh.h"

#define FREE UINT32_MAX

typedef struct near_table {
    const vec3 *positions;
    double      cell; /* some tolerances wide, so that most positions lie far from their cell's borders */
    double      tolerance;
    size_t      mask;
    uint32_t   *heads, *nexts;
} near_table;

/* Numbers of cells stay doubles: far positions over a fine tolerance leave the range of every integer. */
static size_t cell_hash(const double cell[3])
{
    uint64_t bits[3];
    memcpy(bits, cell, sizeof bits);
    uint64_t h = bits[0] * UINT64_C(0x9E3779B97F4A7C15) ^ bits[1] * UINT64_C(0xC2B2AE3D27D4EB4F) ^
                 bits[2] * UINT64_C(0x165667B19E3779F9);
    h = (h ^ h >> 32) *
        UINT64_C(0xD6E8FEB86659FD93); /* doubles of small whole numbers differ in their high bits alone */
    return (size_t)(h ^ h >> 32);
}

/* Where a coordinate moved by so many tolerances lies. */
static double cell_along(const near_table *t, float at, double aside)
{
    return floor(((double)at + aside * t->tolerance) / t->cell) + 0.0; /* no zero with a sign */
}

static void cell_of(const near_table *t, vec3 p, double aside, double cell[3])
{
    cell[0] = cell_along(t, p.x, aside);
    cell[1] = cell_along(t, p.y, aside);
    cell[2] = cell_along(t, p.z, aside);
}

static uint32_t find_in(const near_table *t, vec3 p, const double cell[3])
{
    enum { MOST = 64 }; /* so many share a slot only in meshes that are made to be slow */
    int left = MOST;
    for (uint32_t i = t->heads[cell_hash(cell) & t->mask]; i != FREE && left-- > 0; i = t->nexts[i]) {
        vec3   q = t->positions[i];
        double x = (double)q.x - p.x, y = (double)q.y - p.y, z = (double)q.z - p.z;
        if (x * x + y * y + z * z <= t->tolerance * t->tolerance)
            return i;
    }
    return FREE;
}

/* An earlier vertex that lies so near; `own`: the vertex's cell. Most lie far from their cell's borders. */
static uint32_t find_near(const near_table *t, vec3 p, const double own[3])
{
    double   sides[2][3];
    uint32_t found = find_in(t, p, own);
    cell_of(t, p, -1, sides[0]);
    cell_of(t, p, 1, sides[1]);
    if (memcmp(sides[0], own, sizeof sides[0]) == 0 && memcmp(sides[1], own, sizeof sides[1]) == 0)
        return found;
    for (int corner = 0; corner < 8 && found == FREE; corner++) {
        const double cell[3] = {sides[corner & 1][0], sides[corner >> 1 & 1][1], sides[corner >> 2 & 1][2]};
        if (cell[0] != own[0] || cell[1] != own[1] || cell[2] != own[2])
            found = find_in(t, p, cell);
    }
    return found;
}

double mesh_near(const vec3 *positions, size_t count)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < count; i++)
        box = box3_with_point(box, positions[i]);
    double size = count ? box3_diagonal(box) : 0;
    return isfinite(size) ? size * 1e-6 : 0;
}

bool mesh_weld_near(const vec3 *positions, uint32_t *ids, size_t count, double tolerance)
{
    near_table t = {.positions = positions, .cell = 8 * tolerance, .tolerance = tolerance};
    size_t     slots = 64;
    while (slots < count)
        slots *= 2;
    if (!(tolerance > 0))
        return true;
    t.mask = slots - 1;
    t.heads = mem_alloc(slots * sizeof *t.heads);
    t.nexts = mem_alloc((count + 1) * sizeof *t.nexts);
    bool good = t.heads && t.nexts;
    for (size_t i = 0; good && i < slots; i++)
        t.heads[i] = FREE;
    for (uint32_t i = 0; good && i < count; i++) {
        vec3 p = positions[i];
        if (ids[i] != i || !(fabsf(p.x) + fabsf(p.y) + fabsf(p.z) < INFINITY))
            continue;
        double cell[3];
        cell_of(&t, p, 0, cell);
        uint32_t found = find_near(&t, p, cell);
        if (found != FREE) {
            ids[i] = found;
            continue;
        }
        uint32_t *head = &t.heads[cell_hash(cell) & t.mask];
        t.nexts[i] = *head;
        *head = i;
    }
    mem_free(t.heads);
    mem_free(t.nexts);
    return good;
}
