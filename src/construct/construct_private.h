/* What the files of src/construct share. */
#ifndef LIMNER_CONSTRUCT_CONSTRUCT_PRIVATE_H
#define LIMNER_CONSTRUCT_CONSTRUCT_PRIVATE_H

#include "construct/construct.h"

#define PI 3.14159265358979323846

/* OpenSCAD takes lengths below this as zero. */
#define LENGTH_TINY 0.00000095367431640625

/* Sine and cosine of degrees, exact at multiples of 30 and 90 and with the same value in all quadrants: what is symmetric
 * stays so, and a full turn ends where it began. */
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
/* Hands over what was built: points at the same place made one, unused ones left out, turned round where its volume is
 * negative. The builder is empty afterwards, also on failure. */
lmn_status builder_finish(solid_builder *b, polyhedron *out, lmn_error *error);

/* Signed: positive when anticlockwise seen from outside. */
double polyhedron_volume(const polyhedron *p);
void   polyhedron_turn_round(polyhedron *p);
/* Has each directed edge as many opposite ones? False when memory is gone, and then *failed is set. */
bool polyhedron_is_closed(const polyhedron *p, bool *failed);

/* LMN_FORMAT and LMN_LIMIT with a message that names the shape. */
lmn_status check_numbers(const char *shape, const double *numbers, size_t count, lmn_error *error);
lmn_status check_point_count(const char *shape, double count, lmn_error *error);

/* Triangulates outlines in the plane by their winding (GLU): anticlockwise ones enclose, clockwise ones leave out. The triangles'
 * corners are the numbers of the points, counted through all contours. No corner is added: *exact is false where edges cross
 * or touch and the triangles' border is not the contours. Three corners a triangle in *corners, which the caller frees. */
lmn_status contours_triangulate(const contour *contours, size_t count, uint32_t **corners, size_t *corner_count, bool *exact,
                                lmn_error *error);

#endif
