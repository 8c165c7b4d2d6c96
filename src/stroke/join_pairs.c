/* The cheapest pair of all first, each end once, without a list of all pairs. Costs put pairs in one order, and then
 * the same pairs come of any two ends that are each other's cheapest: a chain goes from an end to its cheapest one, and
 * on, until two point at each other; these are a pair, and the chain goes on from what is left of it (the
 * nearest-neighbour chain of hierarchical clustering). So few searches more are made than there are ends.
 *
 * The cheapest partner is found in a tree of boxes (k-d tree) over positions and directions: of what meets in one place
 * only those are looked at that lead straight on. */
#include "stroke/join_pairs.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

enum { AXES = 3, LEAF = 8, NO_NODE = UINT32_MAX };
#define HALF_TURN 3.14159265f
/* What costs and angles may be off by, which are of single precision. */
#define ROUNDING 1e-5f

typedef struct member {
    float    at[AXES]; /* x, y, angle */
    uint32_t end;
    bool     anywhere;
} member;

typedef struct pair_node {
    float    low[AXES], high[AXES];
    uint32_t begin, end, left, parent; /* left: the first of two children, NO_NODE of a leaf */
    uint32_t free;                     /* members that have no partner yet */
    int32_t  axis;                     /* that it is split along */
    float    split;
} pair_node;

typedef struct waiting_end {
    uint32_t end;
    float    cost; /* of the pair with the one that waits before it */
} waiting_end;

typedef struct pairing {
    const end_rules *rules;
    const end_place *places;
    uint32_t        *partners;
    member          *members;
    pair_node       *nodes;
    uint32_t        *leaves, *roots; /* per end */
    bool            *gone;           /* per end: it has a partner, or can have none */
    waiting_end     *waiting;
    size_t           count, member_count;
    uint32_t         node_count;
    uint64_t         compared;
} pairing;

struct end_search {
    pairing *p;
    uint32_t end, other; /* other: the cheapest so far */
    float    cost, x, y, opposite;
    bool     anywhere;
};

/* fminf and fmaxf are calls. */
static inline float smaller(float a, float b)
{
    return a < b ? a : b;
}

static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

/* --- the tree ------------------------------------------------------------------------------------------- */

static void bound_node(pairing *p, pair_node *n)
{
    for (int k = 0; k < AXES; k++) {
        n->low[k] = INFINITY;
        n->high[k] = -INFINITY;
    }
    for (uint32_t i = n->begin; i < n->end; i++)
        for (int k = 0; k < AXES; k++) {
            const member *m = &p->members[i];
            const bool    all = k == 2 && m->anywhere;
            n->low[k] = smaller(n->low[k], all ? -HALF_TURN : m->at[k]);
            n->high[k] = larger(n->high[k], all ? HALF_TURN : m->at[k]);
        }
}

/* In which direction ends differ most, by what it costs. */
static int widest_axis(const pairing *p, const pair_node *n)
{
    const float scales[AXES] = {1 / p->rules->reach, 1 / p->rules->reach, 0.5f};
    int         widest = 0;
    for (int k = 1; k < AXES; k++)
        if ((n->high[k] - n->low[k]) * scales[k] > (n->high[widest] - n->low[widest]) * scales[widest])
            widest = k;
    return widest;
}

/* Those before the middle one are no farther along the axis, those behind it no less far. */
static void part_members(member *m, ptrdiff_t count, int axis)
{
    ptrdiff_t low = 0, high = count - 1, middle = count / 2;
    while (low < high) {
        const float pivot = m[middle].at[axis];
        ptrdiff_t   i = low, k = high;
        while (i <= k) {
            while (m[i].at[axis] < pivot)
                i++;
            while (m[k].at[axis] > pivot)
                k--;
            if (i > k)
                break;
            member moved = m[i];
            m[i++] = m[k];
            m[k--] = moved;
        }
        low = k < middle ? i : low;
        high = middle < i ? k : high;
    }
}

/* Children lie behind their parents, so that nodes are made in one go. */
static void make_tree(pairing *p, uint32_t begin, uint32_t end)
{
    const uint32_t root = p->node_count;
    p->nodes[p->node_count++] = (pair_node){.begin = begin, .end = end, .parent = NO_NODE};
    for (uint32_t at = root; at < p->node_count; at++) {
        pair_node *n = &p->nodes[at];
        bound_node(p, n);
        n->free = n->end - n->begin;
        n->left = NO_NODE;
        if (n->free <= LEAF) {
            for (uint32_t i = n->begin; i < n->end; i++) {
                p->leaves[p->members[i].end] = at;
                p->roots[p->members[i].end] = root;
            }
            continue;
        }
        uint32_t middle = n->begin + n->free / 2;
        n->axis = widest_axis(p, n);
        part_members(p->members + n->begin, (ptrdiff_t)n->free, n->axis);
        n->split = p->members[middle].at[n->axis];
        n->left = p->node_count;
        p->nodes[p->node_count++] = (pair_node){.begin = n->begin, .end = middle, .parent = at};
        p->nodes[p->node_count++] = (pair_node){.begin = middle, .end = n->end, .parent = at};
    }
}

typedef struct group_key {
    uint32_t group, end;
} group_key;

static int compare_groups(const void *a, const void *b)
{
    const group_key *p = a, *q = b;
    return p->group != q->group ? (p->group < q->group ? -1 : 1) : (p->end > q->end) - (p->end < q->end);
}

static member member_of(const end_place *place, uint32_t end)
{
    const bool anywhere = isnan(place->angle);
    return (member){{place->x, place->y, anywhere ? 0 : place->angle}, end, anywhere};
}

/* A tree for each group. */
static bool make_trees(pairing *p)
{
    group_key *keys = mem_alloc((p->count + 1) * sizeof *keys);
    bool       mixed = false;
    for (uint32_t i = 0; i < p->count && keys; i++) {
        if (p->places[i].group == END_OF_NONE)
            continue;
        keys[p->member_count++] = (group_key){p->places[i].group, i};
        mixed = mixed || keys[p->member_count - 1].group != keys[0].group;
    }
    if (keys && mixed)
        qsort(keys, p->member_count, sizeof *keys, compare_groups);
    for (size_t i = 0; i < p->member_count && keys; i++)
        p->members[i] = member_of(&p->places[keys[i].end], keys[i].end);
    for (size_t begin = 0, end = 0; begin < p->member_count && keys; begin = end) {
        while (end < p->member_count && keys[end].group == keys[begin].group)
            end++;
        make_tree(p, (uint32_t)begin, (uint32_t)end);
    }
    mem_free(keys);
    return keys != NULL;
}

/* --- the search ----------------------------------------------------------------------------------------- */

static bool comes_before(const end_search *s, float cost, uint32_t other)
{
    if (cost != s->cost || s->other == END_OF_NONE)
        return cost < s->cost;
    uint32_t low = s->end < other ? s->end : other, high = s->end < other ? other : s->end,
             best_low = s->end < s->other ? s->end : s->other, best_high = s->end < s->other ? s->other : s->end;
    return low != best_low ? low < best_low : high < best_high;
}

void end_search_offer(end_search *s, uint32_t other)
{
    pairing *p = s->p;
    if (other == s->end || p->gone[other])
        return;
    p->compared++;
    float cost =
        s->end < other ? p->rules->cost(p->rules->user, s->end, other) : p->rules->cost(p->rules->user, other, s->end);
    if (cost >= 0 && comes_before(s, cost, other)) {
        s->cost = cost;
        s->other = other;
    }
}

static inline float outside(float at, float low, float high)
{
    return larger(larger(low - at, at - high), 0);
}

/* Does a pair with an end that is so far away and turned so far cost no more than the best one? */
static inline bool may_be_best(const end_search *s, float x, float y, float turn)
{
    /* 1 − cos t is no less than t² / 2 − t⁴ / 24 */
    const float square = turn * turn, left = s->cost + ROUNDING - square * (0.5f - square / 96);
    const float most = (1 + ROUNDING) * s->p->rules->reach * smaller(left, 1);
    return left >= 0 && x * x + y * y <= most * most;
}

/* By how much, at least, the turn to an end of a box differs from none. */
static inline float turn_to(const end_search *s, float low, float high)
{
    float turn = outside(s->opposite, low, high);
    turn = smaller(turn, outside(s->opposite - 2 * HALF_TURN, low, high));
    return s->anywhere ? 0 : smaller(turn, outside(s->opposite + 2 * HALF_TURN, low, high));
}

static bool is_worth(const end_search *s, const pair_node *n)
{
    return n->free && may_be_best(s, outside(s->x, n->low[0], n->high[0]), outside(s->y, n->low[1], n->high[1]),
                                  turn_to(s, n->low[2], n->high[2]));
}

static void search_leaf(end_search *s, const pair_node *n)
{
    for (uint32_t i = n->begin; i < n->end; i++) {
        const member *m = &s->p->members[i];
        const float   turn = m->anywhere ? 0 : turn_to(s, m->at[2], m->at[2]);
        if (may_be_best(s, m->at[0] - s->x, m->at[1] - s->y, turn))
            end_search_offer(s, m->end);
    }
}

/* Which half of a node is nearer: the end's own, mostly. */
static uint32_t nearer_half(const end_search *s, const pair_node *n)
{
    const float at[AXES] = {s->x, s->y, s->opposite};
    return at[n->axis] > n->split;
}

static void search_node(end_search *s, uint32_t number)
{
    const pair_node *n = &s->p->nodes[number];
    if (n->left == NO_NODE) {
        search_leaf(s, n);
        return;
    }
    const uint32_t first = nearer_half(s, n);
    for (uint32_t k = 0; k < 2; k++)
        if (is_worth(s, &s->p->nodes[n->left + (first ^ k)]))
            search_node(s, n->left + (first ^ k));
}

/* The cheapest partner of the last one that waits: the one before it, if there is none better. */
static end_search search_for(pairing *p, size_t depth)
{
    const waiting_end *w = &p->waiting[depth - 1];
    const end_place   *place = &p->places[w->end];
    end_search         s = {.p = p,
                            .end = w->end,
                            .other = depth > 1 ? w[-1].end : END_OF_NONE,
                            .cost = depth > 1 ? w->cost : p->rules->most,
                            .x = place->x,
                            .y = place->y,
                            .anywhere = isnan(place->angle)};
    s.opposite = s.anywhere ? 0 : place->angle > 0 ? place->angle - HALF_TURN : place->angle + HALF_TURN;
    p->rules->others(p->rules->user, w->end, &s);
    search_node(&s, p->roots[w->end]);
    return s;
}

static void remove_end(pairing *p, uint32_t end)
{
    p->gone[end] = true;
    for (uint32_t at = p->leaves[end]; at != NO_NODE; at = p->nodes[at].parent)
        p->nodes[at].free--;
}

static void pair_from(pairing *p, uint32_t end)
{
    size_t depth = 0;
    p->waiting[depth++] = (waiting_end){end, 0};
    while (depth > 0) {
        const uint32_t   from = p->waiting[depth - 1].end;
        const end_search s = search_for(p, depth);
        if (s.other == END_OF_NONE) {
            remove_end(p, from);
            depth--;
        } else if (depth > 1 && s.other == p->waiting[depth - 2].end) {
            p->partners[from] = s.other;
            p->partners[s.other] = from;
            remove_end(p, from);
            remove_end(p, s.other);
            depth -= 2;
        } else
            p->waiting[depth++] = (waiting_end){s.other, s.cost};
    }
}

bool ends_pair(uint32_t *partners, const end_place *places, size_t count, const end_rules *rules, uint64_t *compared)
{
    pairing p = {.rules = rules,
                 .places = places,
                 .partners = partners,
                 .count = count,
                 .members = mem_alloc((count + 1) * sizeof *p.members),
                 .nodes = mem_alloc((2 * count + 1) * sizeof *p.nodes),
                 .leaves = mem_alloc((count + 1) * sizeof *p.leaves),
                 .roots = mem_alloc((count + 1) * sizeof *p.roots),
                 .gone = mem_calloc(count + 1, sizeof *p.gone),
                 .waiting = mem_alloc((count + 1) * sizeof *p.waiting)};
    bool    good = p.members && p.nodes && p.leaves && p.roots && p.gone && p.waiting && make_trees(&p);
    for (uint32_t i = 0; i < count && good; i++) {
        partners[i] = END_OF_NONE;
        p.gone[i] = places[i].group == END_OF_NONE;
    }
    /* Pairs do not depend on the order; in this one what is looked at lies near what was looked at before. */
    for (size_t i = 0; i < p.member_count && good; i++)
        if (!p.gone[p.members[i].end])
            pair_from(&p, p.members[i].end);
    *compared = p.compared;
    mem_free(p.members);
    mem_free(p.nodes);
    mem_free(p.leaves);
    mem_free(p.roots);
    mem_free(p.gone);
    mem_free(p.waiting);
    return good;
}
