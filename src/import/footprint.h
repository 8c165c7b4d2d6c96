/* Inside the import folder: bodies of buildings from their footprints. Nienhaus 2005, section 4.8: block models,
 * extruded from ground polygons to given heights; row C01. */
#ifndef LIMNER_IMPORT_FOOTPRINT_H
#define LIMNER_IMPORT_FOOTPRINT_H

#include "import/city.h"

typedef enum roof_form {
    ROOF_FLAT,
    ROOF_GABLED,       /* slopes, and upright walls at the ends of the ridges */
    ROOF_HIPPED,       /* slopes over all edges */
    ROOF_PYRAMIDAL,    /* up to one point */
    ROOF_MANSARD,      /* steep below and gentle above, over all edges */
    ROOF_MANSARD_FLAT, /* steep below and level above */
    ROOF_GAMBREL,      /* steep below and gentle above, with upright walls at the ends */
    ROOF_SKILLION,     /* one slope */
    ROOF_DOME,         /* round, up to one point */
    ROOF_ONION,        /* a bulb, up to one point */
    ROOF_FORMS
} roof_form;

typedef struct footprint {
    roof_form roof;
    double    base, eaves, ridge; /* heights; ridge: as high as the roof goes, eaves where it is flat */
    bool      has_direction;      /* where a skillion falls to; else across the longest edge */
    double    direction;          /* radians from north, clockwise */
} footprint;

/* What became of a roof. */
typedef enum roof_made {
    ROOF_AS_ASKED,
    ROOF_OTHERWISE, /* hips where no end can stand upright, or where no point sees all of the outline */
    ROOF_MADE_FLAT  /* an outline that crosses itself or is too large */
} roof_made;

/* Points of one object at a time. */
typedef struct footprint_points {
    vec3  *items;
    size_t count, capacity;
} footprint_points;
bool footprint_add_point(footprint_points *p, double x, double y, double z);

/* Adds a closed body on a polygon with holes: `rings` many, ring k of counts[k] positions (x, y), the first
 * anticlockwise and holes clockwise, one ring behind the other, no position twice in a row. The faces say what they
 * are: ground, wall, roof. False when memory is gone. */
bool footprint_raise(city_shape *shape, footprint_points *points, const footprint *how, const double (*positions)[2],
                     const size_t *counts, size_t rings, roof_made *made);

/* The strip that is this wide around a line, mitred, at a height. */
bool footprint_strip(city_shape *shape, footprint_points *points, const double (*positions)[2], size_t count,
                     double width, double height);

#endif
