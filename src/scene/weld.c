/* Finding equal positions. An open-addressing table of vertex numbers; lookups are made in blocks whose memory is
 * asked for ahead, because on large meshes each would otherwise wait for it. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "scene/mesh.h"

enum { BLOCK = 32 };
#define FREE UINT32_MAX

typedef struct position_table {
    uint32_t *slots; /* vertex numbers, FREE when empty */
    size_t    mask, used;
} position_table;

typedef struct bits3 {
    uint32_t x, y, z;
} bits3;

/* −0 + 0 is +0, so that both zeros have the same bits. */
static bits3 position_bits(vec3 p)
{
    vec3  sum = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
    bits3 bits;
    memcpy(&bits, &sum, sizeof bits);
    return bits;
}

static uint64_t hash_bits(bits3 b)
{
    uint64_t h = (b.x | (uint64_t)b.y << 32) * UINT64_C(0xBF58476D1CE4E5B9);
    h ^= h >> 32;
    h = (h + b.z) * UINT64_C(0x94D049BB133111EB);
    h ^= h >> 29;
    h *= UINT64_C(0x9E3779B97F4A7C15);
    return h >> 20;
}

static bool same_position(vec3 a, vec3 b)
{
    bits3 p = position_bits(a), q = position_bits(b);
    return p.x == q.x && p.y == q.y && p.z == q.z;
}

static bool table_make(position_table *t, size_t slots)
{
    size_t bytes;
    t->slots = size_mul(slots, sizeof *t->slots, &bytes) ? mem_alloc(bytes) : NULL;
    if (!t->slots)
        return false;
    memset(t->slots, 0xFF, bytes);
    t->mask = slots - 1;
    t->used = 0;
    return true;
}

static bool table_grow(position_table *t, const vec3 *positions)
{
    position_table bigger;
    if (!table_make(&bigger, (t->mask + 1) * 4))
        return false;
    for (size_t i = 0; i <= t->mask; i++) {
        uint32_t vertex = t->slots[i];
        if (vertex == FREE)
            continue;
        size_t slot = hash_bits(position_bits(positions[vertex])) & bigger.mask;
        while (bigger.slots[slot] != FREE)
            slot = (slot + 1) & bigger.mask;
        bigger.slots[slot] = vertex;
    }
    bigger.used = t->used;
    mem_free(t->slots);
    *t = bigger;
    return true;
}

/* The vertex in the table at this position; `vertex` itself when it is new. */
static uint32_t table_put(position_table *t, uint64_t hash, const vec3 *positions, uint32_t vertex)
{
    size_t slot = hash & t->mask;
    while (t->slots[slot] != FREE) {
        if (same_position(positions[t->slots[slot]], positions[vertex]))
            return t->slots[slot];
        slot = (slot + 1) & t->mask;
    }
    t->slots[slot] = vertex;
    t->used++;
    return vertex;
}

/* Fills ids[v] with the first vertex at v's position. */
static bool find_first(const vec3 *positions, uint32_t count, uint32_t *ids)
{
    position_table table;
    size_t         slots = 64;
    while (slots < count / 2)
        slots *= 2;
    if (!table_make(&table, slots))
        return false;
    uint64_t hashes[BLOCK];
    for (uint32_t begin = 0; begin < count; begin += BLOCK) {
        uint32_t size = count - begin < BLOCK ? count - begin : BLOCK;
        if (table.used + BLOCK > table.mask / 2 && !table_grow(&table, positions)) {
            mem_free(table.slots);
            return false;
        }
        for (uint32_t i = 0; i < size; i++) {
            hashes[i] = hash_bits(position_bits(positions[begin + i]));
            __builtin_prefetch(&table.slots[hashes[i] & table.mask]);
        }
        for (uint32_t i = 0; i < size; i++) {
            uint32_t likely = table.slots[hashes[i] & table.mask];
            if (likely != FREE)
                __builtin_prefetch(&positions[likely]);
        }
        for (uint32_t i = 0; i < size; i++)
            ids[begin + i] = table_put(&table, hashes[i], positions, begin + i);
    }
    mem_free(table.slots);
    return true;
}

uint32_t *mesh_position_ids(const primitive *p)
{
    uint32_t *ids = mem_alloc((size_t)p->vertex_count * sizeof *ids);
    if (ids && !find_first(p->positions, p->vertex_count, ids)) {
        mem_free(ids);
        return NULL;
    }
    return ids;
}

lmn_status mesh_weld_positions(primitive *p, lmn_error *error)
{
    uint32_t *positions = mesh_position_ids(p);
    if (!positions)
        return error_memory(error);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        /* Earlier entries already hold new positions; the first at a position gets the next one. */
        if (positions[i] != i) {
            positions[i] = positions[positions[i]];
            continue;
        }
        p->positions[kept] = p->positions[i];
        positions[i] = kept++;
    }
    if (!p->indices) {
        p->indices = positions;
        p->index_count = p->vertex_count;
    } else {
        for (uint32_t i = 0; i < p->index_count; i++)
            p->indices[i] = positions[p->indices[i]];
        mem_free(positions);
    }
    p->vertex_count = kept;
    p->welded = true;
    vec3 *smaller = mem_realloc(p->positions, (size_t)kept * sizeof *smaller);
    if (smaller)
        p->positions = smaller;
    return LMN_OK;
}
