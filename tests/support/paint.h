/* Colours laid over each other on the CPU, as compositions should. */
#ifndef TRUTH_PAINT_H
#define TRUTH_PAINT_H

#include <math.h>

#include "picture.h"
#include "shot.h"

typedef struct paint {
    double r, g, b, a; /* as shown, straight */
} paint;

static inline paint paint_of(const uint8_t srgb[3], double alpha)
{
    return (paint){picture_shown(srgb[0]), picture_shown(srgb[1]), picture_shown(srgb[2]), alpha};
}

static inline void put_over(paint *under, paint p)
{
    under->r = p.r * p.a + under->r * (1 - p.a);
    under->g = p.g * p.a + under->g * (1 - p.a);
    under->b = p.b * p.a + under->b * (1 - p.a);
}

static inline int levels_off(const uint8_t *drawn, paint wanted)
{
    double off = fmax(fabs(drawn[0] - picture_level(wanted.r)),
                      fmax(fabs(drawn[1] - picture_level(wanted.g)), fabs(drawn[2] - picture_level(wanted.b))));
    return (int)ceil(off - 0.5);
}

/* Ink of an edge map's pixel when all classes have one colour. */
static inline double ink_of(const uint8_t *edge)
{
    return 1 - edge[0] / 255.0 * (edge[1] / 255.0) * (edge[3] / 255.0);
}

static inline double largest_ink(const shot *s, int i)
{
    double most = 0;
    for (int k = 0; k < s->layer_count; k++)
        most = fmax(most, ink_of(&s->layers[k].edge[4 * i]));
    return most;
}

#endif
