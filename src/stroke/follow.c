/* From frame to frame: what repeats along a chain stays where it was. */
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "stroke/stroke.h"

static int compare_marks(const void *a, const void *b)
{
    const stroke_mark *p = a, *q = b;
    if (p->id != q->id)
        return p->id < q->id ? -1 : 1;
    return p->chain < q->chain ? -1 : p->chain > q->chain;
}

/* What is known of a chain. */
typedef struct chain_fact {
    float length, phase;
} chain_fact;

static chain_fact *gather_facts(const stroke_set *s)
{
    chain_fact *out = mem_calloc(s->chain_count + 1, sizeof *out);
    for (size_t i = 0; i < s->stroke_count && out; i++)
        out[s->strokes[i].chain] = (chain_fact){s->strokes[i].chain_length, s->strokes[i].phase};
    return out;
}

/* The first of the sorted marks with this id; NULL: there is none. */
static const stroke_mark *find_mark(const stroke_mark *marks, size_t count, uint64_t id)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (marks[middle].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && marks[low].id == id ? &marks[low] : NULL;
}

void stroke_follow(stroke_set *now, const stroke_set *before)
{
    stroke_mark *sorted = mem_copy(before->marks, before->mark_count * sizeof *sorted);
    chain_fact  *old = gather_facts(before), *next = mem_calloc(now->chain_count + 1, sizeof *next);
    if (sorted && old && next) {
        qsort(sorted, before->mark_count, sizeof *sorted, compare_marks);
        for (size_t i = 0; i < now->mark_count; i++) {
            const stroke_mark *own = &now->marks[i], *known = find_mark(sorted, before->mark_count, own->id);
            for (; known && known < sorted + before->mark_count && known->id == own->id; known++)
                if (old[known->chain].length > next[own->chain].length)
                    next[own->chain] =
                        (chain_fact){old[known->chain].length, old[known->chain].phase + known->arc - own->arc};
        }
        for (size_t i = 0; i < now->stroke_count; i++)
            now->strokes[i].phase = next[now->strokes[i].chain].phase;
    }
    mem_free(sorted);
    mem_free(old);
    mem_free(next);
}
