/* Which span drives which property at which time. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "behaviour/schedule.h"

static int compare_property(animation_path a, int32_t a_target, animation_path b, int32_t b_target)
{
    animated_thing x = animation_thing_of(a), y = animation_thing_of(b);
    if (x != y)
        return x < y ? -1 : 1;
    if (a_target != b_target)
        return a_target < b_target ? -1 : 1;
    return (a > b) - (a < b);
}

/* A span with what it drives, to be sorted by that. */
typedef struct driven {
    animation_path path;
    int32_t        target;
    size_t         span;
} driven;

static int compare_driven(const void *a, const void *b)
{
    const driven *x = a, *y = b;
    int           by = compare_property(x->path, x->target, y->path, y->target);
    return by ? by : (x->span > y->span) - (x->span < y->span);
}

static int compare_times(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static size_t index_of_time(const behaviour_property *p, double t)
{
    const double *at = bsearch(&t, p->times, p->time_count, sizeof *p->times, compare_times);
    return (size_t)(at - p->times);
}

/* The next slot from here on that nobody has yet; paths are halved on the way. */
static size_t next_free(size_t *next, size_t slot)
{
    while (next[slot] != slot)
        slot = next[slot] = next[next[slot]];
    return slot;
}

static void paint(const schedule *s, behaviour_property *p, size_t *next)
{
    size_t slots = 2 * p->time_count + 1;
    for (size_t i = 0; i < slots; i++)
        p->drivers[i] = NONE;
    for (size_t i = 0; i <= slots; i++)
        next[i] = i;
    for (size_t i = p->span_count; i-- > 0;) {
        size_t                index = s->of_property[p->first_span + i];
        const behaviour_span *span = &s->spans[index];
        size_t                from = 2 * index_of_time(p, span->from) + 1 + span->open_from;
        size_t                to = 2 * index_of_time(p, span->to) + 1 - span->open_to;
        for (size_t at = next_free(next, from); at <= to; at = next_free(next, at)) {
            p->drivers[at] = (int32_t)index;
            next[at] = at + 1;
        }
    }
    for (size_t i = 1; i < slots; i++) /* what has ended stays */
        if (p->drivers[i] == NONE)
            p->drivers[i] = p->drivers[i - 1];
}

static bool find_slots(const schedule *s, behaviour_property *p)
{
    p->times = mem_calloc(2 * p->span_count, sizeof *p->times);
    if (!p->times)
        return false;
    for (size_t i = 0; i < p->span_count; i++) {
        const behaviour_span *span = &s->spans[s->of_property[p->first_span + i]];
        p->times[2 * i] = span->from;
        p->times[2 * i + 1] = span->to;
    }
    qsort(p->times, 2 * p->span_count, sizeof *p->times, compare_times);
    for (size_t i = 0; i < 2 * p->span_count; i++)
        if (i == 0 || p->times[i] > p->times[p->time_count - 1])
            p->times[p->time_count++] = p->times[i];
    p->drivers = mem_calloc(2 * p->time_count + 1, sizeof *p->drivers);
    size_t *next = mem_calloc(2 * p->time_count + 2, sizeof *next);
    if (p->drivers && next)
        paint(s, p, next);
    mem_free(next);
    return p->drivers && next;
}

static driven driven_by(const schedule *s, size_t index)
{
    const animation_channel *c = span_channel(s, &s->spans[index]);
    const behaviour_node    *n = &s->nodes[s->spans[index].node];
    return c ? (driven){c->path, c->target, index} : (driven){n->path, n->target, index};
}

static bool collect(schedule *s, driven *list, size_t count)
{
    s->of_property = mem_calloc(count, sizeof *s->of_property);
    s->properties = mem_calloc(count, sizeof *s->properties);
    for (size_t i = 0; s->of_property && s->properties && i < count; i++) {
        behaviour_property *p = s->property_count ? &s->properties[s->property_count - 1] : NULL;
        if (!p || compare_property(p->path, p->target, list[i].path, list[i].target) != 0) {
            p = &s->properties[s->property_count++];
            const animation_channel *c = span_channel(s, &s->spans[list[i].span]);
            *p = (behaviour_property){.path = list[i].path, .target = list[i].target, .first_span = i};
            p->components = behaviour_components(s->scene, p->path, p->target);
            if (c && c->components > p->components)
                p->components = c->components;
        }
        p->span_count++;
        s->of_property[i] = list[i].span;
        s->spans[list[i].span].property = (int32_t)s->property_count - 1;
    }
    return s->of_property && s->properties;
}

lmn_status schedule_find_drivers(schedule *s, lmn_error *error)
{
    driven *list = mem_calloc(s->span_count, sizeof *list);
    size_t  count = 0;
    for (size_t i = 0; list && i < s->span_count; i++)
        if (s->nodes[s->spans[i].node].kind != BEHAVIOUR_EVENT)
            list[count++] = driven_by(s, i);
    if (list)
        qsort(list, count, sizeof *list, compare_driven);
    bool good = list && collect(s, list, count);
    for (size_t i = 0; i < s->property_count && good; i++)
        good = find_slots(s, &s->properties[i]);
    mem_free(list);
    return good ? LMN_OK : error_memory(error);
}

int32_t schedule_property(const schedule *s, animation_path path, int32_t target)
{
    size_t low = 0, high = s->property_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        int    by = compare_property(s->properties[middle].path, s->properties[middle].target, path, target);
        if (by == 0)
            return (int32_t)middle;
        *(by < 0 ? &low : &high) = by < 0 ? middle + 1 : middle;
    }
    return NONE;
}
