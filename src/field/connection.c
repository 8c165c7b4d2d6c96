/* Groups of nodes that grow pair by pair, and a solution from the coarsest of them down to the nodes. */
#include "field/connection.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"

enum { LEVELS_MAX = 40, COARSEST = 24, SWEEPS = 6, SWEEPS_OF_COARSEST = 60 };

static const uint32_t alone = UINT32_MAX;

/* A level: nodes, and for each the group of the next level that it is in with the turn from the group's frame. */
typedef struct level {
    connection      own;
    uint32_t       *groups;
    complex_number *turns;
} level;

void connection_release(connection *c)
{
    mem_free(c->starts);
    mem_free(c->links);
    mem_free(c->links_hold);
    mem_free(c->hold);
    mem_free(c->source);
    memset(c, 0, sizeof *c);
}

static void relax_node(const connection *c, complex_number *u, uint32_t i)
{
    complex_number sum = c->source[i];
    for (uint32_t k = c->starts[i]; k < c->starts[i + 1]; k++) {
        complex_number p = c->links[k].pull, o = u[c->links[k].other];
        sum.re += p.re * o.re - p.im * o.im;
        sum.im += p.re * o.im + p.im * o.re;
    }
    float whole = c->links_hold[i] + c->hold[i];
    if (whole > 0)
        u[i] = (complex_number){sum.re / whole, sum.im / whole};
}

/* Forwards and backwards in turn, so that neither end of the order is favoured. */
void connection_relax(const connection *c, complex_number *u, const bool *fixed, int sweeps)
{
    for (int s = 0; s < sweeps; s++)
        for (uint32_t k = 0; k < c->count; k++) {
            uint32_t i = s % 2 ? c->count - 1 - k : k;
            if (!fixed || !fixed[i])
                relax_node(c, u, i);
        }
}

/* --- groups --------------------------------------------------------------------------------------------- */

static float strength(complex_number pull)
{
    return pull.re * pull.re + pull.im * pull.im;
}

/* The link of a node that pulls most, among those to nodes without a group, or to those with one. */
static const connection_link *strongest(const connection *c, const uint32_t *groups, uint32_t i, bool grouped)
{
    const connection_link *best = NULL;
    float                  most = 0;
    for (uint32_t k = c->starts[i]; k < c->starts[i + 1]; k++) {
        const connection_link *l = &c->links[k];
        if (l->other == i || (groups[l->other] != alone) != grouped)
            continue;
        float s = strength(l->pull);
        if (s > most) {
            most = s;
            best = l;
        }
    }
    return best;
}

static complex_number unit_of(complex_number a)
{
    float l = sqrtf(a.re * a.re + a.im * a.im);
    return l > 0 ? (complex_number){a.re / l, a.im / l} : (complex_number){1, 0};
}

/* Pairs nodes; one whose neighbours are all taken joins one of theirs, or groups around nodes with many neighbours
 * would grow by one node a level. Returns how many groups there are. */
static uint32_t group_nodes(level *l)
{
    const connection *c = &l->own;
    uint32_t          count = 0;
    for (uint32_t i = 0; i < c->count; i++)
        l->groups[i] = alone;
    for (uint32_t i = 0; i < c->count; i++) {
        if (l->groups[i] != alone)
            continue;
        const connection_link *to = strongest(c, l->groups, i, false);
        if (to) {
            l->groups[i] = l->groups[to->other] = count++;
            l->turns[i] = (complex_number){1, 0};
            l->turns[to->other] = complex_conjugate(unit_of(to->pull));
            continue;
        }
        to = strongest(c, l->groups, i, true);
        l->groups[i] = to ? l->groups[to->other] : count++;
        l->turns[i] = to ? complex_product(unit_of(to->pull), l->turns[to->other]) : (complex_number){1, 0};
    }
    return count;
}

/* Nodes in the order of their groups. */
static void list_members(const level *l, uint32_t groups, uint32_t *starts, uint32_t *members)
{
    memset(starts, 0, ((size_t)groups + 2) * sizeof *starts);
    for (uint32_t i = 0; i < l->own.count; i++)
        starts[l->groups[i] + 2]++;
    for (uint32_t g = 0; g < groups; g++)
        starts[g + 2] += starts[g + 1];
    for (uint32_t i = 0; i < l->own.count; i++)
        members[starts[l->groups[i] + 1]++] = i;
}

/* Adds a node's links to the row of its group; `where` says at which link of the row a group already is. */
static void add_links(const level *fine, connection *coarse, uint32_t i, uint32_t g, uint32_t *end, uint32_t *where)
{
    const connection *c = &fine->own;
    complex_number    back = complex_conjugate(fine->turns[i]);
    coarse->hold[g] += c->hold[i];
    coarse->links_hold[g] += c->links_hold[i];
    complex_number source = complex_product(back, c->source[i]);
    coarse->source[g].re += source.re;
    coarse->source[g].im += source.im;
    for (uint32_t k = c->starts[i]; k < c->starts[i + 1]; k++) {
        uint32_t       other = c->links[k].other, to = fine->groups[other];
        complex_number pull = complex_product(complex_product(back, c->links[k].pull), fine->turns[other]);
        if (to == g) {
            coarse->links_hold[g] -= pull.re;
            continue;
        }
        if (where[to] == alone || where[to] < coarse->starts[g] || coarse->links[where[to]].other != to) {
            where[to] = *end;
            coarse->links[(*end)++] = (connection_link){to, {0, 0}};
        }
        coarse->links[where[to]].pull.re += pull.re;
        coarse->links[where[to]].pull.im += pull.im;
    }
}

/* Groups that all have one value are stiffer than a surface: as many links lie between two as their border is long,
 * and their middles are that much farther apart, which nobody has counted. */
static void loosen(connection *c, float factor)
{
    for (uint32_t i = 0; i < c->count; i++)
        c->links_hold[i] = fmaxf(factor * c->links_hold[i], 1e-12f); /* rounding must not leave less than nothing */
    for (uint32_t k = 0; k < c->starts[c->count]; k++) {
        c->links[k].pull.re *= factor;
        c->links[k].pull.im *= factor;
    }
}

/* What the minimum is over groups, all of whose nodes have what the group has, turned. */
static bool coarsen(level *fine, level *coarse)
{
    const connection *c = &fine->own;
    fine->groups = mem_alloc((size_t)c->count * sizeof *fine->groups);
    fine->turns = mem_alloc((size_t)c->count * sizeof *fine->turns);
    if (!fine->groups || !fine->turns)
        return false;
    uint32_t    groups = group_nodes(fine), end = 0;
    connection *out = &coarse->own;
    *out = (connection){.count = groups};
    out->starts = mem_alloc(((size_t)groups + 2) * sizeof *out->starts);
    out->hold = mem_calloc(groups, sizeof *out->hold);
    out->links_hold = mem_calloc(groups, sizeof *out->links_hold);
    out->source = mem_calloc(groups, sizeof *out->source);
    out->links = mem_alloc((size_t)c->starts[c->count] * sizeof *out->links + sizeof *out->links);
    uint32_t *starts = mem_alloc(((size_t)groups + 2) * sizeof *starts),
             *members = mem_alloc((size_t)c->count * sizeof *members),
             *where = mem_alloc((size_t)groups * sizeof *where);
    bool good = out->starts && out->hold && out->links_hold && out->source && out->links && starts && members && where;
    if (good) {
        list_members(fine, groups, starts, members);
        memset(where, 0xFF, (size_t)groups * sizeof *where);
        for (uint32_t g = 0; g < groups; g++) {
            out->starts[g] = end;
            for (uint32_t k = starts[g]; k < starts[g + 1]; k++)
                add_links(fine, out, members[k], g, &end, where);
        }
        out->starts[groups] = end;
        loosen(out, sqrtf((float)groups / (float)c->count));
    }
    mem_free(starts);
    mem_free(members);
    mem_free(where);
    return good;
}

/* --- from coarse to fine -------------------------------------------------------------------------------- */

/* Fills u of a level from that of the next one, and frees the latter. */
static bool refine(const level *fine, complex_number **u)
{
    complex_number *out = mem_alloc((size_t)fine->own.count * sizeof *out);
    for (uint32_t i = 0; out && i < fine->own.count; i++)
        out[i] = complex_product(fine->turns[i], (*u)[fine->groups[i]]);
    mem_free(*u);
    *u = out;
    return out != NULL;
}

static bool solve_levels(level *levels, complex_number *u)
{
    int  count = 1;
    bool good = true;
    while (good && count < LEVELS_MAX && levels[count - 1].own.count > COARSEST) {
        good = !work_stopped() && coarsen(&levels[count - 1], &levels[count]);
        count++;
        if (good && levels[count - 1].own.count == levels[count - 2].own.count)
            break;
    }
    const connection *last = &levels[count - 1].own;
    complex_number   *values = good ? mem_calloc(last->count, sizeof *values) : NULL;
    good = values != NULL;
    if (good)
        connection_relax(last, values, NULL, SWEEPS_OF_COARSEST);
    for (int l = count - 2; l >= 0 && good; l--) {
        good = !work_stopped() && refine(&levels[l], &values);
        if (good)
            connection_relax(&levels[l].own, values, NULL, SWEEPS);
    }
    if (good && levels[0].own.count)
        memcpy(u, values, (size_t)levels[0].own.count * sizeof *u);
    mem_free(values);
    return good;
}

bool connection_solve(const connection *c, complex_number *u)
{
    level levels[LEVELS_MAX + 1] = {{.own = *c}};
    bool  good = solve_levels(levels, u);
    for (int l = 0; l <= LEVELS_MAX; l++) {
        mem_free(levels[l].groups);
        mem_free(levels[l].turns);
        if (l > 0)
            connection_release(&levels[l].own);
    }
    return good;
}
