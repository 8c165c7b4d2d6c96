/* Chains: lines found in a picture, as points in order with their length along the line. Image-space edges have no
 * identity; tracing gives them one. No GL, only arrays. */
#ifndef LIMNER_LINES_CHAIN_H
#define LIMNER_LINES_CHAIN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A point in the middle of the line's ink, smoothed. */
typedef struct trace_point {
    float    x, y;  /* pixels; centres are whole numbers */
    float    along; /* length of the chain up to here */
    uint32_t pixel; /* that it was found at: y · width + x */
} trace_point;

typedef struct chain {
    size_t first, count; /* of its points */
    float  length;       /* of closed ones with the way back to the first point */
    bool   closed;
    bool   broad;     /* runs through an area of ink rather than along a line */
    bool   joined[2]; /* does it begin, and end, at a junction or a corner? Else the line just stops there */
} chain;

typedef struct chain_set {
    trace_point *points;
    chain       *chains;
    size_t       point_count, chain_count;
    size_t       point_capacity, chain_capacity;
} chain_set;

/* The chains of the ink (not 0 = ink), in the order in which they are met by rows. They part at junctions and at
 * corners; short side branches of at most `spur` pixels, which thinning leaves, are taken off. Every pixel of the
 * thinned ink is in some chain. False when memory is gone; then there are none. */
bool chains_trace(chain_set *out, const uint8_t *ink, int width, int height, float spur);
void chains_release(chain_set *c);

#endif
