/* Inside the import folder: bodies of buildings from their footprints. Nienhaus 2005, section 4.8: block models,
 * extruded from ground polygons to given heights; row C01. */
#ifndef LIMNER_IMPORT_FOOTPRINT_H
#define LIMNER_IMPORT_FOOTPRINT_H

#include "import/city.h"

typedef enum roof_form { ROOF_FLAT, ROOF_GABLED, ROOF_HIPPED, ROOF_PYRAMIDAL, ROOF_MANSARD } roof_form;

typedef struct footprint {
    roof_form roof;
    double    base, eaves, ridge; /* heights; ridge: as high as the roof goes, eaves where it is flat */
} footprint;

/* Points of one object at a time. */
typedef struct footprint_points {
    vec3  *items;
    size_t count, capacity;
} footprint_points;
bool footprint_add_point(footprint_points *p, double x, double y, double z);

/* Adds a closed body on a polygon: `rings` many, ring k of counts[k] positions (x, y), one ring behind the other, none
 * of them twice. The faces say what they are: ground, wall, roof. Roofs that do not fit are flat: *fits says whether it
 * did. Pyramids and mansards fit on convex outlines without holes, gables and hips on such with four corners. False
 * when memory is gone. */
bool footprint_raise(city_shape *shape, footprint_points *points, const footprint *how, const double (*positions)[2],
                     const size_t *counts, size_t rings, bool *fits);

/* The strip that is this wide around a line, mitred, at a height. */
bool footprint_strip(city_shape *shape, footprint_points *points, const double (*positions)[2], size_t count,
                     double width, double height);

#endif
