/* Boxes around boxes: sorted along a curve that stays near where it is (Morton order), then split where the curve
 * changes most. */
#include "stroke/stroke_private.h"

#include <string.h>

#include "base/memory.h"

enum { LEAF = 4, CURVE_BITS = 10, RADIX_BITS = 10, RADIX = 1 << RADIX_BITS, DEPTH_MAX = 96 };
/* So many boxes at one place of the curve get a finer one of their own. */
enum { CROWD = 64 };

typedef struct curve_key {
    uint32_t position, member;
} curve_key;

/* Spreads ten bits so that two others fit between each pair. */
static uint32_t spread(uint32_t x)
{
    x = (x | x << 16) & 0x030000FFu;
    x = (x | x << 8) & 0x0300F00Fu;
    x = (x | x << 4) & 0x030C30C3u;
    return (x | x << 2) & 0x09249249u;
}

static uint32_t step_along(float at, float low, float scale)
{
    float step = (at - low) * scale;
    return step > 0 ? step < (1 << CURVE_BITS) - 1 ? (uint32_t)step : (1 << CURVE_BITS) - 1 : 0;
}

/* Along a curve through the box around all members of the keys. */
static void position_on_curve(curve_key *keys, const box3 *boxes, uint32_t count)
{
    box3 all = box3_empty();
    for (uint32_t i = 0; i < count; i++)
        all = box3_union(all, boxes[keys[i].member]);
    const float side = 1 << CURVE_BITS;
    vec3        size = {all.max.x - all.min.x, all.max.y - all.min.y, all.max.z - all.min.z};
    vec3 scale = {size.x > 0 ? side / size.x : 0, size.y > 0 ? side / size.y : 0, size.z > 0 ? side / size.z : 0};
    for (uint32_t i = 0; i < count; i++) {
        const box3 *b = &boxes[keys[i].member];
        uint32_t    x = step_along(0.5f * (b->min.x + b->max.x), all.min.x, scale.x),
                 y = step_along(0.5f * (b->min.y + b->max.y), all.min.y, scale.y),
                 z = step_along(0.5f * (b->min.z + b->max.z), all.min.z, scale.z);
        keys[i].position = spread(x) | spread(y) << 1 | spread(z) << 2;
    }
}

static void sort_keys(curve_key *keys, curve_key *other, uint32_t count)
{
    for (unsigned shift = 0; shift < 3 * CURVE_BITS; shift += RADIX_BITS) {
        uint32_t starts[RADIX + 1] = {0};
        for (uint32_t i = 0; i < count; i++)
            starts[(keys[i].position >> shift & (RADIX - 1)) + 1]++;
        for (int k = 0; k < RADIX; k++)
            starts[k + 1] += starts[k];
        for (uint32_t i = 0; i < count; i++)
            other[starts[keys[i].position >> shift & (RADIX - 1)]++] = keys[i];
        memcpy(keys, other, count * sizeof *keys);
    }
}

/* Where a run of keys is split: at the highest bit in which its ends differ, or in the middle. */
static uint32_t split_of(const curve_key *keys, uint32_t begin, uint32_t end)
{
    uint32_t differ = keys[begin].position ^ keys[end - 1].position;
    if (!differ)
        return begin + (end - begin) / 2;
    uint32_t bit = 31u - (uint32_t)__builtin_clz(differ), low = begin, high = end - 1;
    while (high - low > 1) { /* the bit is 0 at `low` and 1 at `high` */
        uint32_t middle = low + (high - low) / 2;
        if (keys[middle].position >> bit & 1)
            high = middle;
        else
            low = middle;
    }
    return high;
}

typedef struct run {
    uint32_t node, begin, end;
} run;

/* Nodes from the root on; children lie side by side, behind their parent. */
static void make_nodes(hierarchy *h, const box3 *boxes, curve_key *keys, curve_key *other)
{
    run stack[DEPTH_MAX];
    int depth = 0;
    stack[depth++] = (run){0, 0, h->member_count};
    h->node_count = 1;
    while (depth > 0) {
        run r = stack[--depth];
        if (r.end - r.begin <= LEAF || depth + 2 > DEPTH_MAX) {
            h->nodes[r.node] =
                (hierarchy_node){box3_empty(), r.begin, r.end - r.begin, {KIN_MIXED, KIN_MIXED, KIN_MIXED}, 0};
            continue;
        }
        if (r.end - r.begin > CROWD && keys[r.begin].position == keys[r.end - 1].position) {
            position_on_curve(keys + r.begin, boxes, r.end - r.begin);
            sort_keys(keys + r.begin, other, r.end - r.begin);
        }
        uint32_t split = split_of(keys, r.begin, r.end), left = h->node_count;
        h->node_count += 2;
        h->nodes[r.node] = (hierarchy_node){box3_empty(), left, 0, {KIN_MIXED, KIN_MIXED, KIN_MIXED}, 0};
        stack[depth++] = (run){left + 1, split, r.end};
        stack[depth++] = (run){left, r.begin, split};
    }
}

static void make_boxes(hierarchy *h, const box3 *boxes, hierarchy_kin kin)
{
    for (uint32_t i = h->node_count; i-- > 0;) {
        hierarchy_node *n = &h->nodes[i];
        if (n->count == 0) {
            const hierarchy_node *left = &h->nodes[n->first], *right = left + 1;
            n->box = box3_union(left->box, right->box);
            n->size = box3_diagonal(n->box);
            for (int way = 0; way < KIN_WAYS; way++)
                n->kin[way] = left->kin[way] == right->kin[way] ? left->kin[way] : KIN_MIXED;
            continue;
        }
        for (uint32_t k = 0; k < n->count; k++) {
            uint32_t member = h->members[n->first + k];
            n->box = box3_union(n->box, boxes[member]);
            for (int way = 0; way < KIN_WAYS; way++) {
                uint32_t own = kin.of[way] ? kin.of[way][member] : KIN_MIXED;
                n->kin[way] = k == 0 || own == n->kin[way] ? own : KIN_MIXED;
            }
        }
        n->size = box3_diagonal(n->box);
    }
}

lmn_status hierarchy_build(hierarchy *out, const box3 *boxes, hierarchy_kin kin, uint32_t count, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    if (count == 0)
        return LMN_OK;
    curve_key *keys = mem_alloc(2 * (size_t)count * sizeof *keys);
    out->members = mem_alloc(count * sizeof *out->members);
    out->nodes = mem_alloc(2 * (size_t)count * sizeof *out->nodes);
    lmn_status status = LMN_OK;
    if (keys && out->members && out->nodes) {
        for (uint32_t i = 0; i < count; i++)
            keys[i].member = i;
        position_on_curve(keys, boxes, count);
        sort_keys(keys, keys + count, count);
        out->member_count = count;
        make_nodes(out, boxes, keys, keys + count);
        for (uint32_t i = 0; i < count; i++)
            out->members[i] = keys[i].member;
        make_boxes(out, boxes, kin);
    } else {
        hierarchy_release(out);
        status = error_memory(error);
    }
    mem_free(keys);
    return status;
}

void hierarchy_release(hierarchy *h)
{
    mem_free(h->nodes);
    mem_free(h->members);
    memset(h, 0, sizeof *h);
}

/* --- pairs ---------------------------------------------------------------------------------------------- */

static bool meet(const box3 *a, const box3 *b)
{
    return a->min.x <= b->max.x && b->min.x <= a->max.x && a->min.y <= b->max.y && b->min.y <= a->max.y &&
           a->min.z <= b->max.z && b->min.z <= a->max.z;
}

typedef struct pair_search {
    const hierarchy *h;
    const box3      *boxes;
    hierarchy_kin    kin;
    hierarchy_pair   pair;
    void            *user;
} pair_search;

static bool are_kin(const pair_search *s, uint32_t p, uint32_t q)
{
    for (int way = 0; way < KIN_WAYS; way++)
        if (s->kin.of[way] && s->kin.of[way][p] == s->kin.of[way][q] && s->kin.of[way][p] != KIN_MIXED)
            return true;
    return false;
}

/* All members of one node and of another one, or the same. */
static bool are_nodes_kin(const hierarchy_node *a, const hierarchy_node *b)
{
    for (int way = 0; way < KIN_WAYS; way++)
        if (a->kin[way] == b->kin[way] && a->kin[way] != KIN_MIXED)
            return true;
    return false;
}

static bool pairs_of_leaves(const pair_search *s, const hierarchy_node *a, const hierarchy_node *b)
{
    for (uint32_t i = 0; i < a->count; i++)
        for (uint32_t k = a == b ? i + 1 : 0; k < b->count; k++) {
            uint32_t p = s->h->members[a->first + i], q = s->h->members[b->first + k];
            if (!are_kin(s, p, q) && meet(&s->boxes[p], &s->boxes[q]) && !s->pair(s->user, p, q))
                return false;
        }
    return true;
}

static bool pairs_between(const pair_search *s, uint32_t first, uint32_t second)
{
    const hierarchy_node *a = &s->h->nodes[first], *b = &s->h->nodes[second];
    if (are_nodes_kin(a, b) || !meet(&a->box, &b->box))
        return true;
    if (a->count && b->count)
        return pairs_of_leaves(s, a, b);
    if (b->count || (!a->count && a->size > b->size))
        return pairs_between(s, a->first, second) && pairs_between(s, a->first + 1, second);
    return pairs_between(s, first, b->first) && pairs_between(s, first, b->first + 1);
}

bool hierarchy_pairs(const hierarchy *h, const box3 *boxes, hierarchy_kin kin, hierarchy_pair pair, void *user)
{
    pair_search s = {h, boxes, kin, pair, user};
    for (uint32_t i = 0; i < h->node_count; i++) {
        const hierarchy_node *n = &h->nodes[i];
        if (are_nodes_kin(n, n))
            continue;
        if (n->count ? !pairs_of_leaves(&s, n, n) : !pairs_between(&s, n->first, n->first + 1))
            return false;
    }
    return true;
}
