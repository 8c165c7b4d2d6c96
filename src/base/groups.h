/* What hangs together: each thing is linked to another one of its group, the group's first one to itself (disjoint
 * sets). */
#ifndef LIMNER_BASE_GROUPS_H
#define LIMNER_BASE_GROUPS_H

#include <stdint.h>

/* The first one of a thing's group; ways there are shortened. */
static inline uint32_t group_root(uint32_t *links, uint32_t i)
{
    while (links[i] != i) {
        links[i] = links[links[i]];
        i = links[i];
    }
    return i;
}

/* Makes one group of two. */
static inline void group_join(uint32_t *links, uint32_t a, uint32_t b)
{
    a = group_root(links, a);
    b = group_root(links, b);
    if (a < b)
        links[b] = a;
    else
        links[a] = b;
}

#endif
