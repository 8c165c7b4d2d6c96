/* Rays against triangles in double precision: what is seen at each pixel centre, and what hides a point. */
#ifndef TRUTH_TRACE_H
#define TRUTH_TRACE_H

#include "shape.h"
#include "shot.h"

typedef struct trace_triangle {
    dvec     p[3], n[3]; /* corners and their normals; without normals the flat one three times */
    dvec     flat;       /* unit, by winding */
    uint32_t part;       /* index in the shape */
} trace_triangle;

typedef struct tracer tracer;

typedef struct trace_hit {
    double   t; /* in lengths of the direction */
    uint32_t triangle;
    double   u, v; /* weights of corners 1 and 2 */
} trace_hit;

enum { TRACE_NONE = -1 };

tracer *tracer_create(const shape *s);
/* Only the parts whose names begin with the prefix, or only the others; they keep their numbers. */
tracer *tracer_of_parts(const shape *s, const char *prefix, bool with);
/* Takes the triangles over. */
tracer               *tracer_of_triangles(trace_triangle *triangles, size_t count);
void                  tracer_destroy(tracer *t);
const trace_triangle *tracer_triangles(const tracer *t, size_t *count);

/* The first hit with low < t < high that is on neither of the two triangles `skip` (TRACE_NONE: nothing left out). */
bool tracer_hit(const tracer *t, dvec origin, dvec direction, double low, double high, const int64_t skip[2],
                trace_hit *out);

/* Does anything lie in between? `last` is the triangle that did for a ray like this one, tried first, and is kept
 * up; to begin with UINT32_MAX. */
bool tracer_blocked(const tracer *t, dvec origin, dvec direction, double low, double high, uint32_t *last);

/* Every triangle hit with low < t < high, nearest first; at most `capacity` are written, the number of all is returned.
 */
size_t tracer_hits(const tracer *t, dvec origin, dvec direction, double low, double high, trace_hit *out,
                   size_t capacity);

/* What a perfect renderer sees at the pixel centres of a shot. */
typedef struct trace_map {
    int       width, height;
    double   *depth;  /* eye depth, INFINITY where empty */
    dvec     *normal; /* unit, eye space, interpolated */
    uint16_t *id;     /* part index + 1 */
} trace_map;

void trace_map_make(trace_map *out, const tracer *t, const shot *view);
/* How far a pixel's normal is from the truth. Rasterisers position corners on a grid of 1/256 px, so on the line
 * between two facets either facet's normal will do. */
double trace_normal_error(const tracer *t, const shot *view, int x, int y, dvec normal);
void   trace_map_release(trace_map *m);

/* Does the map change within the 3x3 pixels around this one: another part, empty against full, or a depth step of
 * more than `fraction` of the depth? Rasterisers place a border within a fraction of a pixel, so such pixels may
 * differ. */
bool trace_map_border(const trace_map *m, int x, int y, double fraction);

#endif
