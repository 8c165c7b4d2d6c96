/* A heap of positions by distance. */
#include "base/memory.h"
#include "field/direction_field_private.h"

/* Nearer first; among equally near ones the lower number, so that the order is the same everywhere. */
static bool before(near_position a, near_position b)
{
    return a.distance != b.distance ? a.distance < b.distance : a.element < b.element;
}

bool near_push(near_queue *q, double distance, uint32_t element)
{
    if (!mem_grow((void **)&q->items, &q->capacity, q->count + 1, sizeof *q->items))
        return false;
    near_position p = {distance, element};
    size_t        i = q->count++;
    for (; i > 0 && before(p, q->items[(i - 1) / 2]); i = (i - 1) / 2)
        q->items[i] = q->items[(i - 1) / 2];
    q->items[i] = p;
    return true;
}

near_position near_pop(near_queue *q)
{
    near_position top = q->items[0], last = q->items[--q->count];
    size_t        i = 0;
    for (;;) {
        size_t child = 2 * i + 1;
        if (child >= q->count)
            break;
        if (child + 1 < q->count && before(q->items[child + 1], q->items[child]))
            child++;
        if (!before(q->items[child], last))
            break;
        q->items[i] = q->items[child];
        i = child;
    }
    q->items[i] = last;
    return top;
}
