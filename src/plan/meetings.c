#include "plan/meetings.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* A box of the figure's, in the order of where they begin along x; `reached` is how far those up to it go. */
typedef struct own_box {
    box3  box;
    float reached;
} own_box;

static int compare_boxes(const void *a, const void *b)
{
    const float x = ((const own_box *)a)->box.min.x, y = ((const own_box *)b)->box.min.x;
    return (x > y) - (x < y);
}

/* Of those that begin before the box ends, from the last one back until none reaches it any more. */
static bool meets_some(const own_box *own, size_t count, box3 other)
{
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (own[middle].box.min.x <= other.max.x)
            low = middle + 1;
        else
            high = middle;
    }
    for (size_t i = low; i-- > 0 && own[i].reached >= other.min.x;)
        if (box3_overlap(own[i].box, other))
            return true;
    return false;
}

bool plan_find_meetings(const plan *p, const figure *f, bool *parts, bool *any)
{
    const box3 *boxes = p->pose->part_boxes;
    own_box    *own = mem_alloc((f->part_count + 1) * sizeof *own);
    size_t      count = 0;
    *any = false;
    if (!own)
        return false;
    for (size_t i = 0; i < p->part_count && count < f->part_count; i++)
        if (f->designated[i] && !p->scene->parts[i].ghost)
            own[count++] = (own_box){boxes[i], boxes[i].max.x};
    qsort(own, count, sizeof *own, compare_boxes);
    for (size_t i = 1; i < count; i++)
        own[i].reached = fmaxf(own[i].reached, own[i - 1].reached);
    for (size_t i = 0; i < p->part_count; i++) {
        parts[i] = p->opaque[i] && !f->designated[i] && !p->scene->parts[i].ghost && box3_overlap(f->box, boxes[i]) &&
                   meets_some(own, count, boxes[i]);
        *any = *any || parts[i];
    }
    mem_free(own);
    return true;
}
