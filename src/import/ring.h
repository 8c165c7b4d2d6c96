/* Rings of corners on the ground. */
#ifndef LIMNER_IMPORT_RING_H
#define LIMNER_IMPORT_RING_H

#include <stdbool.h>
#include <stddef.h>

/* Does a ring go around a position, of which the first two numbers count? By even and odd crossings. */
static inline bool ring_has(const double (*ring)[2], size_t count, const double *at)
{
    bool inside = false;
    for (size_t i = 0, j = count - 1; i < count; j = i++)
        if ((ring[i][1] > at[1]) != (ring[j][1] > at[1]) &&
            at[0] < (ring[j][0] - ring[i][0]) * (at[1] - ring[i][1]) / (ring[j][1] - ring[i][1]) + ring[i][0])
            inside = !inside;
    return inside;
}

#endif
