/* Inside the scene folder: growing one patch and laying it flat. */
#ifndef LIMNER_FIELD_LAPPED_PRIVATE_H
#define LIMNER_FIELD_LAPPED_PRIVATE_H

#include "field/direction_field_private.h"
#include "field/lapped.h"

#define STRETCH_MAX 1.5

typedef struct flat_position {
    double x, y;
} flat_position;

/* An element of the surface in a patch. */
typedef struct patch_vertex {
    uint32_t      element;
    bool          settled;
    flat_position position;
    point3        axis; /* the unit tangent that x runs along */
    flat_position sum;  /* while relaxing */
    double        weight;
} patch_vertex;

/* An edge of a triangle in a patch: what lies from one end to the other when it is laid flat. */
typedef struct patch_edge {
    uint32_t      from, to;
    flat_position direction;
    double        weight;
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

    patch_vertex  *vertices;
    patch_edge    *edges;
    uint32_t      *triangles; /* of the patch; the first is the seed */
    flat_position *kept;
    flat_position  middle; /* where in the seed 0 is */
    double         radius;
    size_t vertex_count, vertex_capacity, edge_count, edge_capacity, triangle_count, triangle_capacity, kept_capacity;
    near_queue near;
} patch_ground;

/* Grows a patch around a position in a triangle (as fractions of its second and third corner) and lays it flat, the
 * position at 0; false when memory is gone. patch_clear makes ready for the next. */
bool patch_grow(patch_ground *g, uint32_t seed, flat_position middle, double radius);
void patch_clear(patch_ground *g);

/* Of a triangle as it lies now: the greater of its greatest stretch and the inverse of the least; INFINITY when it
 * is turned over. */
double patch_stretch(const patch_ground *g, uint32_t triangle);
/* Where its corners lie. */
void patch_positions(const patch_ground *g, uint32_t triangle, flat_position out[3]);

/* The outline of one patch, with what is the same at all angles. */
typedef struct outline {
    double        radius;
    flat_position third, seventh; /* cosine and sine of how far its waves are turned */
} outline;

outline outline_of(uint32_t patch, double radius);

/* How a triangle lies to an outline. */
bool outline_holds(const outline *o, const flat_position corners[3]);   /* all of it is inside for certain */
bool outline_touches(const outline *o, const flat_position corners[3]); /* some of it may be inside */

#endif
