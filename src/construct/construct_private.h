/* What the files of src/construct share. */
#ifndef LIMNER_CONSTRUCT_CONSTRUCT_PRIVATE_H
#define LIMNER_CONSTRUCT_CONSTRUCT_PRIVATE_H

#include "construct/construct.h"
#include "construct/triangulate.h"

#define PI 3.14159265358979323846

/* OpenSCAD takes lengths below this as zero. */
#define LENGTH_TINY 0.00000095367431640625

/* Sine and cosine of degrees, exact at multiples of 30 and 90 and with the same value in all quadrants: what is
 * symmetric stays so, and a full turn ends where it began. */
double sine_of_degrees(double degrees);
double cosine_of_degrees(double degrees);

/* A polyhedron that grows. Zero-initialise; the first failure to get memory sticks in `failed`. */
typedef struct solid_builder {
    point3   *points;
    size_t    point_count, point_capacity;
    uint32_t *triangles;
    size_t    triangle_count, triangle_capacity; /* the capacity counts corners */
    bool      failed;
} solid_builder;

void builder_point(solid_builder *b, double x, double y, double z);
/* A triangle, anticlockwise seen from outside; those with a corner twice are left out. */
void builder_triangle(solid_builder *b, uint32_t i, uint32_t j, uint32_t k);
/* Two triangles; the corners are in order, the first diagonal runs from the first corner to the third. */
void builder_quad(solid_builder *b, uint32_t i, uint32_t j, uint32_t k, uint32_t l);
void builder_release(solid_builder *b);
/* Hands over what was built: points at the same position made one, unused ones left out, turned round where its volume
 * is negative. The builder is empty afterwards, also on failure. */
lmn_status builder_finish(solid_builder *b, polyhedron *out, lmn_error *error);

/* Signed: positive when anticlockwise seen from outside. */
double polyhedron_volume(const polyhedron *p);
void   polyhedron_turn_round(polyhedron *p);
/* Has each directed edge as many opposite ones? False when memory is gone, and then *failed is set. */
bool polyhedron_is_closed(const polyhedron *p, bool *failed);

/* LMN_FORMAT and LMN_LIMIT with a message that names the shape. */
lmn_status check_numbers(const char *shape, const double *numbers, size_t count, lmn_error *error);
lmn_status check_point_count(const char *shape, double count, lmn_error *error);

/* --- regions -------------------------------------------------------------------------------------------- */

/* OpenSCAD's operations on regions work on whole multiples of this. What is not one is cut off towards zero, as
 * there. */
#define GRID (1.0 / 65536)
double grid_position(double value);

/* A region that grows contour by contour. Zero-initialise; the first failure to get memory sticks in `failed`. The
 * last contour grows; one of fewer than three points is taken back when it is ended. */
typedef struct region_builder {
    contour *contours;
    size_t   count, capacity, point_capacity;
    bool     failed;
} region_builder;

void       builder_contour(region_builder *b);
void       builder_set_position(region_builder *b, double x, double y);
void       builder_end_contour(region_builder *b);
void       region_builder_release(region_builder *b);
lmn_status region_builder_finish(region_builder *b, region *out, lmn_error *error);

/* Twice the signed area. */
double contour_area2(const point2 *points, size_t count);
size_t region_point_count(const region *r);
/* Point by point and contour by contour. */
lmn_status region_copy(region *out, const region *r, lmn_error *error);
lmn_status check_region(const char *shape, const region *r, lmn_error *error);

typedef struct plane_edge {
    point2 from, to;
} plane_edge;
/* By x, then y; by where they begin, then where they end. */
int compare_positions(const void *a, const void *b);
int compare_plane_edges(const void *a, const void *b);
/* The contours around faces that lie side by side, from the edges of all of them, the inside on the left: none
 * crosses another, none touches itself, none has corners on straight lines where no other touches it. Sorts the
 * edges. False when memory is gone. */
bool edges_trace(region *out, plane_edge *edges, size_t count);

/* An edge of a contour of an operand. */
typedef struct wound_edge {
    point2 from, to;
    size_t operand;
} wound_edge;
typedef struct edge_strips {
    wound_edge *edges;
    size_t      edge_count, strip_count;
    double      low, scale; /* a strip is scale times the height above low */
    size_t     *starts;     /* of each strip's entries, and their end */
    uint32_t   *entries;    /* numbers of edges */
} edge_strips;
/* Owns the edges from now on, on failure too: release it in any case. False when memory is gone. */
bool edge_strips_make(edge_strips *s, wound_edge *edges, size_t count);
void edge_strips_release(edge_strips *s);
/* Adds to each operand's number how often its contours run anticlockwise round the position: edges that cross the ray
 * to the right. */
void edge_strips_wind(const edge_strips *s, double x, double y, int *windings);

/* Which positions are inside, by how often the contours of each operand run round them. ODD and POSITIVE have one
 * operand. */
typedef enum cover_rule { COVER_ODD, COVER_POSITIVE, COVER_UNION, COVER_INTERSECTION, COVER_DIFFERENCE } cover_rule;
/* Contours of any kind on the grid to a region without crossings and without corners on straight lines. */
lmn_status region_cover(region *out, const region *operands, size_t count, cover_rule rule, lmn_error *error);
/* The union of simple anticlockwise polygons, one a contour; for very many of them. */
lmn_status region_unite_polygons(region *out, const region *polygons, lmn_error *error);

#endif
