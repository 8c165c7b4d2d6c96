/* Inside the scene folder: growing one patch and laying it flat. */
#ifndef LIMNER_FIELD_LAPPED_PRIVATE_H
#define LIMNER_FIELD_LAPPED_PRIVATE_H

#include "field/direction_field_private.h"
#include "field/lapped.h"

#define STRETCH_MAX 1.5

typedef struct flat_place {
    double x, y;
} flat_place;

/* An element of the surface in a patch. */
typedef struct patch_vertex {
    uint32_t   element;
    bool       settled;
    flat_place place;
    point3     axis; /* the unit tangent that x runs along */
    flat_place sum;  /* while relaxing */
    double     weight;
} patch_vertex;

/* An edge of a triangle in a patch: what lies from one end to the other when it is laid flat. */
typedef struct patch_edge {
    uint32_t   from, to;
    flat_place way;
    double     weight;
} patch_edge;

/* What patches grow on, and the room that one after the other uses. */
typedef struct patch_ground {
    const field_surface *surface;
    point3              *axes;           /* per element: the field's direction, either way */
    float               *sure;           /* per element: how much it counts */
    bool                *covered;        /* per triangle */
    bool                 only_uncovered; /* grow over uncovered triangles alone */
    uint32_t            *local;          /* per element: its number in the patch, NOWHERE */
    uint32_t            *stamps;         /* per triangle: the last round in which it was met */
    uint32_t             round;

    patch_vertex *vertices;
    patch_edge   *edges;
    uint32_t     *triangles; /* of the patch; the first is the seed */
    flat_place   *kept;
    flat_place    middle; /* where in the seed 0 is */
    double        radius;
    size_t        vertex_count, vertex_room, edge_count, edge_room, triangle_count, triangle_room, kept_room;
    near_queue    near;
} patch_ground;

/* Grows a patch around a place in a triangle (as shares of its second and third corner) and lays it flat, the place
 * at 0; false when memory is gone. patch_clear makes ready for the next. */
bool patch_grow(patch_ground *g, uint32_t seed, flat_place middle, double radius);
void patch_clear(patch_ground *g);

/* Of a triangle as it lies now: the greater of its greatest stretch and the inverse of the least; INFINITY when it
 * is turned over. */
double patch_stretch(const patch_ground *g, uint32_t triangle);
/* Where its corners lie. */
void patch_places(const patch_ground *g, uint32_t triangle, flat_place out[3]);

/* The outline of one patch, with what is the same at all angles. */
typedef struct outline {
    double     radius;
    flat_place third, seventh; /* cosine and sine of how far its waves are turned */
} outline;

outline outline_of(uint32_t patch, double radius);

/* How a triangle lies to an outline. */
bool outline_holds(const outline *o, const flat_place corners[3]);   /* all of it is inside for certain */
bool outline_touches(const outline *o, const flat_place corners[3]); /* some of it may be inside */

#endif
