/* What the tests of shapes from numbers share: is a surface closed, and has it the numbers that it should have? */
#ifndef TESTS_CONSTRUCT_SHAPES_H
#define TESTS_CONSTRUCT_SHAPES_H

#include "import_support.h"

#include <math.h>

#include "base/limits.h"
#include "construct/construct.h"
#include "construct/construct_private.h"

static const facets plain = {0, 12, 2}; /* OpenSCAD's defaults */

static inline int compare_test_edges(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* No point twice, no triangle without three corners, each directed edge once and once the other way. */
static inline void assert_watertight(const polyhedron *p)
{
    size_t    count = p->triangle_count * 3;
    uint64_t *edges = mem_alloc(2 * count * sizeof *edges + 1), *back = edges + count;
    assert_non_null(edges);
    for (size_t i = 0; i < count; i++) {
        uint64_t from = p->triangles[i], to = p->triangles[i % 3 == 2 ? i - 2 : i + 1];
        assert_true(from < p->point_count && from != to);
        edges[i] = from << 32 | to;
        back[i] = to << 32 | from;
    }
    qsort(edges, count, sizeof *edges, compare_test_edges);
    qsort(back, count, sizeof *back, compare_test_edges);
    for (size_t i = 0; i < count; i++) {
        assert_true(i == 0 || edges[i] != edges[i - 1]);
        assert_true(edges[i] == back[i]);
    }
    mem_free(edges);
    assert_true(p->triangle_count == 0 || polyhedron_volume(p) > 0);
}

static inline void assert_close(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance))
        print_error("%.12g, wanted %.12g\n", value, wanted);
    assert_true(fabs(value - wanted) <= tolerance);
}

static inline void assert_bounds(const polyhedron *p, point3 low, point3 high, double tolerance)
{
    point3 a, b;
    assert_true(polyhedron_bounds(p, &a, &b));
    assert_close(a.x, low.x, tolerance);
    assert_close(a.y, low.y, tolerance);
    assert_close(a.z, low.z, tolerance);
    assert_close(b.x, high.x, tolerance);
    assert_close(b.y, high.y, tolerance);
    assert_close(b.z, high.z, tolerance);
}

/* Watertight, with this many points and triangles and this volume; released. */
static inline void assert_shape(polyhedron *p, size_t points, size_t triangles, double volume)
{
    assert_watertight(p);
    assert_int_equal(p->point_count, points);
    assert_int_equal(p->triangle_count, triangles);
    assert_close(polyhedron_volume(p), volume, 1e-5 * (fabs(volume) + 1));
    polyhedron_release(p);
}

static inline void assert_empty(polyhedron *p)
{
    assert_int_equal(p->triangle_count, 0);
    assert_int_equal(p->point_count, 0);
    assert_null(p->points);
}

static inline double region_area(const region *r)
{
    double sum = 0;
    for (size_t i = 0; i < r->count; i++)
        sum += contour_area2(r->contours[i].points, r->contours[i].count) / 2;
    return sum;
}

/* So many contours and points, and this area; the region stays. */
static inline void assert_region(const region *r, size_t contours, size_t points, double area)
{
    assert_int_equal(r->count, contours);
    assert_int_equal(region_point_count(r), points);
    assert_close(region_area(r), area, 1e-5 * (fabs(area) + 1));
}

static inline bool region_has_point(const region *r, double x, double y)
{
    for (size_t i = 0; i < r->count; i++)
        for (size_t k = 0; k < r->contours[i].count; k++)
            if (fabs(r->contours[i].points[k].x - x) < 2e-5 && fabs(r->contours[i].points[k].y - y) < 2e-5)
                return true;
    return false;
}

static inline region test_square(double x, double y, double size)
{
    region square, moved;
    assert_int_equal(construct_square(&square, (double[]){size, size}, false, NULL), LMN_OK);
    assert_int_equal(region_transform(&moved, &square, (double[]){1, 0, 0, 1, x, y}, NULL), LMN_OK);
    region_release(&square);
    return moved;
}

static inline region test_circle(double x, double y, double radius, double fn)
{
    region circle, moved;
    assert_int_equal(construct_circle(&circle, radius, (facets){fn, 12, 2}, NULL), LMN_OK);
    assert_int_equal(region_transform(&moved, &circle, (double[]){1, 0, 0, 1, x, y}, NULL), LMN_OK);
    region_release(&circle);
    return moved;
}

/* One path through all points. */
static inline region test_polygon(const double *numbers, uint32_t count)
{
    uint32_t corners[64];
    point2   points[64];
    region   r;
    for (uint32_t i = 0; i < count; i++) {
        corners[i] = i;
        points[i] = (point2){numbers[i * 2], numbers[i * 2 + 1]};
    }
    assert_int_equal(construct_polygon(&r, points, count, corners, &count, 1, NULL), LMN_OK);
    return r;
}

/* The square with a notch that reaches in from above. */
static inline region test_notched(void)
{
    return test_polygon((const double[]){0, 0, 10, 0, 10, 10, 5, 3, 0, 10}, 5);
}

#endif
