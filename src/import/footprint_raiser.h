/* Inside the import folder: what the makers of walls (footprint.c) and roofs (footprint_roof.c) share. */
#ifndef LIMNER_IMPORT_FOOTPRINT_RAISER_H
#define LIMNER_IMPORT_FOOTPRINT_RAISER_H

#include "import/footprint.h"

typedef struct raiser {
    city_shape       *shape;
    footprint_points *points;
    const footprint  *how;
    const double (*positions)[2];
    const size_t *counts;
    size_t        rings, corners;
    uint32_t      base, eaves; /* the first corner's points */
    uint8_t       ground, wall, roof;
    bool          good; /* false: memory is gone */
} raiser;

uint32_t raiser_put(raiser *r, double x, double y, double z);
/* A corner of the face that is open, and its end. */
void raiser_corner(raiser *r, uint32_t point);
void raiser_end_ring(raiser *r);
void raiser_end_face(raiser *r, uint8_t word);
/* The wall below an edge up to the eaves, which stays open above: its corners are put, without an end. */
void raiser_begin_wall(raiser *r, uint32_t edge, uint32_t end);

/* Slopes over all edges, with a knee or without, and walls. ROOF_MADE_FLAT: nothing was added. */
roof_made footprint_slopes(raiser *r, roof_form form);

#endif
