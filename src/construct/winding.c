/* How often contours run round a position. Edges are kept by horizontal strips, because a set operation asks for many
 * positions. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "construct/construct_private.h"

/* An edge lies in all strips that it goes through; on average in no more than this many. */
#define STRIPS_OF_EDGE 8
#define STRIPS_MAX     16384

static size_t strip_of(const edge_strips *s, double y)
{
    double strip = floor((y - s->low) * s->scale);
    return strip <= 0 ? 0 : strip >= (double)(s->strip_count - 1) ? s->strip_count - 1 : (size_t)strip;
}

static void choose_strips(edge_strips *s)
{
    double high = -INFINITY, climbed = 0;
    s->low = INFINITY;
    for (size_t i = 0; i < s->edge_count; i++) {
        const wound_edge *e = &s->edges[i];
        s->low = fmin(s->low, fmin(e->from.y, e->to.y));
        high = fmax(high, fmax(e->from.y, e->to.y));
        climbed += fabs(e->to.y - e->from.y);
    }
    s->strip_count = 1;
    s->scale = 0;
    if (!(high > s->low) || !(climbed > 0))
        return;
    double count = fmin(STRIPS_MAX, STRIPS_OF_EDGE * (double)s->edge_count * (high - s->low) / climbed);
    s->strip_count = (size_t)fmax(1, fmin(count, (double)s->edge_count));
    s->scale = (double)s->strip_count / (high - s->low);
}

/* Calls for each strip of each edge; without entries they are only counted, at the position after the next one's
 * beginning. */
static void visit_strips(edge_strips *s, bool count_only)
{
    for (size_t i = 0; i < s->edge_count; i++) {
        const wound_edge *e = &s->edges[i];
        size_t            last = strip_of(s, fmax(e->from.y, e->to.y));
        for (size_t k = strip_of(s, fmin(e->from.y, e->to.y)); k <= last; k++) {
            if (count_only)
                s->starts[k + 2]++;
            else
                s->entries[s->starts[k + 1]++] = (uint32_t)i;
        }
    }
}

bool edge_strips_make(edge_strips *s, wound_edge *edges, size_t count)
{
    *s = (edge_strips){.edges = edges, .edge_count = count};
    choose_strips(s);
    s->starts = mem_calloc(s->strip_count + 2, sizeof *s->starts);
    if (!s->starts)
        return false;
    visit_strips(s, true);
    for (size_t k = 2; k < s->strip_count + 2; k++)
        s->starts[k] += s->starts[k - 1];
    s->entries = mem_calloc(s->starts[s->strip_count + 1], sizeof *s->entries);
    if (!s->entries)
        return false;
    visit_strips(s, false);
    return true;
}

void edge_strips_release(edge_strips *s)
{
    mem_free(s->edges);
    mem_free(s->starts);
    mem_free(s->entries);
    *s = (edge_strips){0};
}

void edge_strips_wind(const edge_strips *s, double x, double y, int *windings)
{
    size_t strip = strip_of(s, y);
    for (size_t i = s->starts[strip]; i < s->starts[strip + 1]; i++) {
        const wound_edge *e = &s->edges[s->entries[i]];
        bool              up = e->to.y > y;
        if ((e->from.y > y) == up)
            continue;
        double side = (e->to.x - e->from.x) * (y - e->from.y) - (e->to.y - e->from.y) * (x - e->from.x);
        if (up ? side > 0 : side < 0)
            windings[e->operand] += up ? 1 : -1;
    }
}
