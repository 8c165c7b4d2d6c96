/* Vertices that were one before somebody rounded them: poles of spheres whose sines are 1e-17 and not 0, seams that two
 * programs computed. A mesh is torn there, and its outlines too. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "scene/mesh.h"

#define FREE UINT32_MAX
enum { BLOCK = 32 };

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

static uint32_t find_in(const near_table *t, vec3 p, size_t slot)
{
    enum { MOST = 64 }; /* so many share a slot only in meshes that are made to be slow */
    int left = MOST;
    for (uint32_t i = t->heads[slot]; i != FREE && left-- > 0; i = t->nexts[i]) {
        vec3   q = t->positions[i];
        double x = (double)q.x - p.x, y = (double)q.y - p.y, z = (double)q.z - p.z;
        if (x * x + y * y + z * z <= t->tolerance * t->tolerance)
            return i;
    }
    return FREE;
}

/* Where a vertex is looked up. Most lie far from their cell's borders. */
typedef struct near_place {
    double sides[2][3]; /* cells of the vertex moved by the tolerance either way along each axis */
    size_t slot;        /* of its own cell */
    bool   at_border;   /* these differ */
} near_place;

static size_t slot_beside(const near_table *t, const near_place *p, int corner)
{
    const double cell[3] = {p->sides[corner & 1][0], p->sides[corner >> 1 & 1][1], p->sides[corner >> 2 & 1][2]};
    return cell_hash(cell) & t->mask;
}

/* Is it the same cell as that of an earlier corner? Along an axis where both sides are one, the second one repeats it.
 */
static bool is_repeated(const near_place *p, int corner)
{
    for (int k = 0; k < 3; k++)
        if (corner >> k & 1 && p->sides[0][k] == p->sides[1][k])
            return true;
    return false;
}

static near_place place_of(const near_table *t, vec3 p)
{
    near_place out;
    double     own[3];
    cell_of(t, p, 0, own);
    cell_of(t, p, -1, out.sides[0]);
    cell_of(t, p, 1, out.sides[1]);
    out.slot = cell_hash(own) & t->mask;
    out.at_border = memcmp(out.sides[0], out.sides[1], sizeof own) != 0;
    return out;
}

/* An earlier vertex that lies so near. */
static uint32_t find_near(const near_table *t, vec3 p, const near_place *place)
{
    uint32_t found = find_in(t, p, place->slot);
    for (int corner = 0; corner < 8 && found == FREE && place->at_border; corner++) {
        const size_t slot = slot_beside(t, place, corner);
        if (slot != place->slot && !is_repeated(place, corner))
            found = find_in(t, p, slot);
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

/* Vertices from `begin` to `end`. What they are looked up by is asked for ahead, as on large meshes each would wait for
 * it. */
static void weld_block(near_table *t, uint32_t *ids, uint32_t begin, uint32_t end)
{
    near_place places[BLOCK];
    for (uint32_t i = begin; i < end; i++) {
        const near_place *p = &places[i - begin];
        places[i - begin] = place_of(t, t->positions[i]);
        __builtin_prefetch(&t->heads[p->slot]);
        for (int corner = 0; corner < 8 && p->at_border; corner++)
            if (!is_repeated(p, corner))
                __builtin_prefetch(&t->heads[slot_beside(t, p, corner)]);
    }
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t likely = t->heads[places[i - begin].slot];
        if (likely == FREE)
            continue;
        __builtin_prefetch(&t->positions[likely]);
        __builtin_prefetch(&t->nexts[likely]);
    }
    for (uint32_t i = begin; i < end; i++) {
        const vec3        p = t->positions[i];
        const near_place *place = &places[i - begin];
        if (ids[i] != i || !(fabsf(p.x) + fabsf(p.y) + fabsf(p.z) < INFINITY))
            continue;
        const uint32_t found = find_near(t, p, place);
        if (found != FREE) {
            ids[i] = found;
            continue;
        }
        t->nexts[i] = t->heads[place->slot];
        t->heads[place->slot] = i;
    }
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
    for (size_t begin = 0; good && begin < count; begin += BLOCK)
        weld_block(&t, ids, (uint32_t)begin, (uint32_t)(count - begin < BLOCK ? count : begin + BLOCK));
    mem_free(t.heads);
    mem_free(t.nexts);
    return good;
}
