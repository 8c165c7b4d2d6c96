/* Which arm of its cross each element takes, where what the solution left are islands: places whose arms lie across
 * those of all around, so that strokes would end at their shore. An island goes over to what surrounds it when that
 * joins more than it costs in what its elements wish. */
#include <math.h>
#include <string.h>

#include "base/groups.h"
#include "base/memory.h"
#include "base/work.h"
#include "field/direction_field_private.h"

enum { ROUNDS = 12 };

typedef struct island {
    float    shore, wish; /* links to other islands; how much its elements hold on to the arms that they have */
    uint32_t count;
    bool     stays; /* it touches a smaller one: that one decides first */
} island;

typedef struct arms_work {
    const connection *graph;
    complex_number   *arms;
    uint32_t         *links; /* base/groups.h */
    island           *islands;
} arms_work;

/* How well an element's arm goes on at the other end of a link; below 0 it lies across. */
static float goes_on(const arms_work *w, uint32_t e, const connection_link *l)
{
    return (w->arms[e].re < 0) == (w->arms[l->other].re < 0) ? l->pull.re : -l->pull.re;
}

static void find_islands(arms_work *w)
{
    const connection *g = w->graph;
    memset(w->islands, 0, g->count * sizeof *w->islands);
    for (uint32_t e = 0; e < g->count; e++)
        w->links[e] = e;
    for (uint32_t e = 0; e < g->count; e++)
        for (uint32_t k = g->starts[e]; k < g->starts[e + 1]; k++)
            if (goes_on(w, e, &g->links[k]) >= 0)
                group_join(w->links, e, g->links[k].other);
    for (uint32_t e = 0; e < g->count; e++) {
        island *own = &w->islands[group_root(w->links, e)];
        own->count++;
        own->wish += w->arms[e].re < 0 ? -g->source[e].re : g->source[e].re;
        for (uint32_t k = g->starts[e]; k < g->starts[e + 1]; k++)
            if (group_root(w->links, g->links[k].other) != group_root(w->links, e))
                own->shore -= goes_on(w, e, &g->links[k]);
    }
}

static void find_smallest(arms_work *w)
{
    const connection *g = w->graph;
    for (uint32_t e = 0; e < g->count; e++)
        for (uint32_t k = g->starts[e]; k < g->starts[e + 1]; k++) {
            uint32_t a = group_root(w->links, e), b = group_root(w->links, g->links[k].other);
            if (a != b &&
                (w->islands[a].count > w->islands[b].count || (w->islands[a].count == w->islands[b].count && a > b)))
                w->islands[a].stays = true;
        }
}

bool field_join_arms(const connection *g, complex_number *arms)
{
    arms_work w = {.graph = g, .arms = arms};
    bool      changed = true;
    w.links = mem_alloc(g->count * sizeof *w.links);
    w.islands = mem_alloc(g->count * sizeof *w.islands);
    bool good = w.links && w.islands;
    for (int round = 0; round < ROUNDS && good && changed; round++) {
        find_islands(&w);
        find_smallest(&w);
        changed = false;
        for (uint32_t e = 0; e < g->count; e++) {
            const island *i = &w.islands[group_root(w.links, e)];
            if (i->stays || !(i->shore > i->wish))
                continue;
            arms[e].re = -arms[e].re;
            changed = true;
        }
        good = !work_stopped();
    }
    mem_free(w.links);
    mem_free(w.islands);
    return good;
}
