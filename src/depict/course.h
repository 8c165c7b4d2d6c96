/* Places along a line of points, by how far they are from its beginning. */
#ifndef LIMNER_DEPICT_COURSE_H
#define LIMNER_DEPICT_COURSE_H

#include <math.h>
#include <stddef.h>

#include "base/vector3.h"

/* Lent; two points at least. */
typedef struct course {
    const double (*points)[3];
    const double *lengths; /* up to each point */
    size_t        count;
} course;

static inline double course_end(const course *c)
{
    return c->lengths[c->count - 1];
}

/* The first point behind the first one that is as far along, or the last one. */
static inline size_t course_behind(const course *c, double length)
{
    size_t low = 1, high = c->count - 1;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (c->lengths[middle] < length)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static inline void course_at(const course *c, double length, double out[3])
{
    const size_t i = course_behind(c, length);
    const double piece = c->lengths[i] - c->lengths[i - 1], f = piece > 0 ? (length - c->lengths[i - 1]) / piece : 0;
    vector3_mix(out, c->points[i - 1], c->points[i], fmin(fmax(f, 0), 1));
}

#endif
