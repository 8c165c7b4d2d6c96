/* Inside the import folder: polygons whose rings cross themselves or each other as polygons whose rings do not. */
#ifndef LIMNER_IMPORT_UNTANGLE_H
#define LIMNER_IMPORT_UNTANGLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Rings behind each other. Zero-initialise. */
typedef struct ring_list {
    double (*positions)[2];
    size_t *counts; /* per ring: its positions */
    size_t  position_count, position_capacity, ring_count, ring_capacity;
} ring_list;

bool ring_list_begin(ring_list *l);
bool ring_list_add(ring_list *l, const double at[2]);
void ring_list_release(ring_list *l);

/* An outline and its holes, the rings from `first` on. */
typedef struct untangled_polygon {
    size_t first, rings, position;
} untangled_polygon;

/* Zero-initialise; used again and again. */
typedef struct untangled {
    ring_list          rings, loops;
    untangled_polygon *polygons;
    size_t             count, capacity;
    uint64_t           crossing, stray_holes; /* rings that were taken apart, holes that were left out: of all so far */
} untangled;

/* Of a polygon, an outline and holes: a ring that crosses itself becomes the loops that it goes around, and all that
 * the outline goes around is filled. Holes that lie outside of the outline or in another hole, or cross either, are
 * left out. Outlines go anticlockwise, holes clockwise. False when memory is gone. */
bool untangle(untangled *u, const double (*positions)[2], const size_t *counts, size_t rings);
void untangle_release(untangled *u);

#endif
