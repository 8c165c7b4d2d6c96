/* All surfaces behind each pixel, nearest first: what depth layers must hold. Found by rays in double precision. */
#ifndef TRUTH_STACK_H
#define TRUTH_STACK_H

#include "trace.h"

enum { STACK_MAX = 300 };

/* One surface on a ray. Surfaces are ordered by depth, then part, then front-facing first; coincident surfaces of
 * one part with the same facing are one. */
typedef struct stack_hit {
    double   depth;    /* eye depth */
    dvec     normal;   /* unit, eye space, interpolated, as the surface has it */
    uint32_t triangle; /* the first of those that coincide */
    float    u, v;     /* weights of its corners 1 and 2 */
    uint16_t id;       /* part index + 1 */
    bool     front;    /* seen from the side from which its corners run anticlockwise */
    bool     tied;     /* so close behind the hit before it that a rasteriser's floats may order the two either way */
} stack_hit;

/* The surfaces on the ray through a position of the picture (pixels, row 0 on top), between the clip planes. */
size_t stack_trace(const tracer *t, const shot *view, double x, double y, stack_hit out[STACK_MAX]);

/* The stacks of all pixel centres. A pixel is sharp when rays a hundredth of a pixel around its centre meet the
 * same surfaces in the same order: rasterisers position corners on a grid of 1/256 px, so only there is the answer
 * sure. */
typedef struct stack_map {
    int        width, height;
    size_t    *first; /* hits of pixel i: hits[first[i]] … hits[first[i + 1] − 1] */
    stack_hit *hits;
    bool      *sharp;
    size_t     sharp_count, most, most_sharp; /* the largest number of hits, of all pixels and of sharp ones */
} stack_map;

void stack_map_make(stack_map *out, const tracer *t, const shot *view);
void stack_map_release(stack_map *m);

static inline size_t stack_count(const stack_map *m, int pixel)
{
    return m->first[pixel + 1] - m->first[pixel];
}

static inline const stack_hit *stack_at(const stack_map *m, int pixel)
{
    return m->hits + m->first[pixel];
}

/* How many pixels have more than k surfaces. */
size_t stack_covered(const stack_map *m, size_t k);

/* A drawing's layers against the stacks. */
typedef struct stack_score {
    size_t pixels, sharp; /* of the picture, and those whose answer is sure */
    size_t right,
        right_sharp;    /* pixels at which every layer is the surface that the ray finds, and none is missing or more */
    size_t hits, drawn; /* surfaces of the sharp pixels: by rays, and in the layers */
    size_t wrong_count, wrong_id, wrong_depth, wrong_normal, holes; /* sharp pixels, by the first thing that is wrong */
    double depth_error, normal_error; /* the largest where count and ids are right, sharp pixels only */
    int    x, y, layer;               /* the first wrong sharp pixel, −1 when none */
} stack_score;

/* `drawn`: how many layers the drawing should have at most (0: all). */
stack_score stack_compare(const stack_map *m, const tracer *t, const shot *s, size_t drawn);

#endif
