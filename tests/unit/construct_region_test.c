/* Regions from numbers, set operations, offsets, extrusions. The counts, areas and coordinates are OpenSCAD
 * 2021.01's. */
#include "construct/triangulate.h"
#include "construct_shapes.h"

/* --- plain regions -------------------------------------------------------------------------------------- */

static void squares_and_circles(void **state)
{
    (void)state;
    region r;
    double low[2], high[2];
    assert_int_equal(construct_square(&r, (double[]){2, 3}, true, NULL), LMN_OK);
    assert_region(&r, 1, 4, 6);
    assert_true(region_bounds(&r, low, high) && low[0] == -1 && high[1] == 1.5);
    region_release(&r);
    assert_int_equal(construct_circle(&r, 5, plain, NULL), LMN_OK);
    assert_region(&r, 1, 16, 8 * 25 * sin(PI / 8));
    region_release(&r);
    assert_int_equal(construct_square(&r, (double[]){2, -3}, true, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    assert_false(region_bounds(&r, low, high));
    assert_int_equal(construct_circle(&r, 0, plain, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    assert_int_equal(construct_circle(&r, NAN, plain, NULL), LMN_FORMAT);
    assert_int_equal(construct_circle(&r, 1, (facets){1e8, 12, 2}, NULL), LMN_LIMIT);
    assert_int_equal(construct_square(&r, (double[]){INFINITY, 1}, true, NULL), LMN_FORMAT);
}

static void polygons_are_even_odd(void **state)
{
    (void)state;
    /* A star that crosses itself: five points, none in the middle. */
    double star[10];
    for (int i = 0; i < 5; i++) {
        star[i * 2] = 10 * cosine_of_degrees(144 * i);
        star[i * 2 + 1] = 10 * sine_of_degrees(144 * i);
    }
    region r = test_polygon(star, 5);
    assert_region(&r, 5, 15, 77.5675);
    assert_true(region_has_point(&r, 3.09016, -2.24513));
    region_release(&r);
    /* A butterfly; corners on straight lines and repeated ones are left out; nothing of a line is left. */
    r = test_polygon((const double[]){0, 0, 10, 10, 10, 0, 0, 10}, 4);
    assert_region(&r, 2, 6, 50);
    region_release(&r);
    r = test_polygon((const double[]){0, 0, 5, 0, 5, 0, 10, 0, 10, 10, 0, 0}, 6);
    assert_region(&r, 1, 3, 50);
    region_release(&r);
    r = test_polygon((const double[]){0, 0, 5, 5, 10, 10, 3, 3}, 4);
    assert_region(&r, 0, 0, 0);
    r = test_polygon((const double[]){0, 0, 5, 5}, 2);
    assert_region(&r, 0, 0, 0);
}

static void polygons_of_several_paths(void **state)
{
    (void)state;
    const point2 points[] = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {2, 2}, {4, 2},
                             {4, 4}, {2, 4},  {3, 3},   {6, 3},  {6, 6}, {3, 6}};
    uint32_t     corners[12];
    region       r;
    for (uint32_t i = 0; i < 12; i++)
        corners[i] = i;
    assert_int_equal(construct_polygon(&r, points, 12, corners, (uint32_t[]){4, 4, 4}, 3, NULL), LMN_OK);
    assert_close(region_area(&r), 100 - 4 - 9 + 2, 1e-9);
    region_release(&r);
    assert_int_equal(construct_polygon(&r, points, 11, corners, (uint32_t[]){4, 4, 4}, 3, NULL), LMN_FORMAT);
    assert_int_equal(construct_polygon(&r, points, 12, corners, NULL, 0, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    assert_int_equal(construct_polygon(&r, (point2[]){{0, 0}, {1, NAN}, {1, 1}}, 3, corners, (uint32_t[]){3}, 1, NULL),
                     LMN_FORMAT);
}

/* --- set operations ------------------------------------------------------------------------------------- */

static void set_operations_are_openscads(void **state)
{
    (void)state;
    region r, pair[2] = {test_circle(0, 0, 5, 7), test_square(1, 0.333333333, 3)};
    assert_int_equal(region_combine(&r, pair, 2, REGION_DIFFERENCE, NULL), LMN_OK);
    assert_region(&r, 1, 12, 59.79042);
    assert_true(region_has_point(&r, 4, 2.07651) && region_has_point(&r, 3.39474, 3.33333));
    region_release(&r);
    region_release(&pair[0]);
    region_release(&pair[1]);
    pair[0] = test_circle(0, 0, 5, 70);
    pair[1] = test_circle(1, 0.333333333, 4, 31);
    assert_int_equal(region_combine(&r, pair, 2, REGION_INTERSECTION, NULL), LMN_OK);
    assert_region(&r, 1, 35, 49.84495);
    region_release(&r);
    assert_int_equal(region_combine(&r, pair, 2, REGION_UNION, NULL), LMN_OK);
    assert_close(region_area(&r), region_area(&pair[0]) + region_area(&pair[1]) - 49.84495, 1e-3);
    region_release(&r);
    region_release(&pair[0]);
    region_release(&pair[1]);
}

static void set_operations_at_their_edges(void **state)
{
    (void)state;
    region r, pair[3] = {test_square(0, 0, 1), test_square(1, 0, 1), {0}};
    assert_int_equal(region_combine(&r, pair, 3, REGION_UNION, NULL), LMN_OK);
    assert_region(&r, 1, 4, 2); /* no corner where they met */
    region_release(&r);
    assert_int_equal(region_combine(&r, pair, 2, REGION_INTERSECTION, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    assert_int_equal(region_combine(&r, pair, 3, REGION_INTERSECTION, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    assert_int_equal(region_combine(&r, &pair[2], 1, REGION_UNION, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    assert_int_equal(region_combine(&r, NULL, 0, REGION_DIFFERENCE, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    region_release(&pair[1]);
    pair[1] = test_square(1, 1, 1);
    assert_int_equal(region_combine(&r, pair, 2, REGION_UNION, NULL), LMN_OK);
    assert_region(&r, 2, 8, 2); /* they touch at a corner */
    region_release(&r);
    assert_int_equal(region_combine(&r, (region[]){pair[0], pair[0]}, 2, REGION_DIFFERENCE, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    pair[1].contours[0].points[2].x = NAN;
    assert_int_equal(region_combine(&r, pair, 2, REGION_UNION, NULL), LMN_FORMAT);
    region_release(&pair[0]);
    region_release(&pair[1]);
}

static void a_hole_is_a_clockwise_contour(void **state)
{
    (void)state;
    region r, turned, pair[2] = {test_square(0, 0, 9), test_square(2, 3, 4)};
    assert_int_equal(region_combine(&r, pair, 2, REGION_DIFFERENCE, NULL), LMN_OK);
    assert_region(&r, 2, 8, 81 - 16);
    int holes = 0;
    for (size_t i = 0; i < 2; i++)
        holes += contour_area2(r.contours[i].points, 4) == -32;
    assert_int_equal(holes, 1);
    assert_int_equal(region_transform(&turned, &r, (double[]){-2, 0, 0, 1, 7, 0}, NULL), LMN_OK);
    assert_region(&turned, 2, 8, 2 * (81 - 16));
    region_release(&turned);
    assert_int_equal(region_transform(&turned, &r, (double[]){1, 1, 1, 1, 7, 0}, NULL), LMN_OK);
    assert_region(&turned, 0, 0, 0);
    region_release(&r);
    region_release(&pair[0]);
    region_release(&pair[1]);
}

static void hulls_and_sums(void **state)
{
    (void)state;
    region r, pair[2] = {test_circle(0, 0, 1, 7), test_circle(5, 0.33333, 2, 5)};
    assert_int_equal(region_hull(&r, pair, 2, NULL), LMN_OK);
    assert_region(&r, 1, 7, 20.387977);
    assert_true(region_has_point(&r, 5.618034, 2.235443));
    region_release(&r);
    region_release(&pair[0]);
    region_release(&pair[1]);
    pair[0] = test_square(0, 0, 3);
    pair[1] = test_circle(0, 0, 1, 5);
    assert_int_equal(region_minkowski(&r, &pair[0], &pair[1], NULL), LMN_OK);
    assert_region(&r, 1, 8, 22.510920);
    region_release(&r);
    region_release(&pair[0]);
    region frame[2] = {test_square(0, 0, 10), test_square(3, 3, 4)};
    assert_int_equal(region_combine(&pair[0], frame, 2, REGION_DIFFERENCE, NULL), LMN_OK);
    assert_int_equal(region_minkowski(&r, &pair[0], &pair[1], NULL), LMN_OK);
    assert_region(&r, 2, 12, 134.8922);
    region_release(&r);
    assert_int_equal(region_minkowski(&r, &pair[0], &(region){0}, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    assert_int_equal(region_hull(&r, NULL, 0, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    for (int i = 0; i < 2; i++) {
        region_release(&pair[i]);
        region_release(&frame[i]);
    }
}

/* --- offsets -------------------------------------------------------------------------------------------- */

static void offsets_are_openscads(void **state)
{
    (void)state;
    static const struct {
        double distance;
        bool   rounded, chamfer;
        double fn;
        size_t contours, points;
        double area;
    } cases[] = {
        {1, true, false, 0, 1, 11, 113.7092},   {1, true, false, 8, 1, 15, 114.4468},
        {1, true, false, 50, 1, 69, 114.8854},  {1, false, false, 0, 1, 5, 119.0457},
        {1, false, true, 0, 1, 9, 115.3801},    {-1, true, false, 0, 1, 7, 25.26035},
        {-1, true, false, 50, 1, 20, 25.08826}, {-1, false, false, 0, 1, 5, 24.636285},
        {-1, false, true, 0, 1, 6, 25.00703},   {-3, true, false, 12, 0, 0, 0},
        {5, true, false, 3, 1, 11, 337.8273},   {5, true, false, 0, 1, 25, 365.3611},
        {0, true, false, 0, 1, 5, 65},          {-1e5, true, false, 12, 0, 0, 0},
    };
    region r, notched = test_notched();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        facets f = {cases[i].fn, 12, 2};
        assert_int_equal(region_offset(&r, &notched, cases[i].distance, cases[i].rounded, cases[i].chamfer, f, NULL),
                         LMN_OK);
        assert_region(&r, cases[i].contours, cases[i].points, cases[i].area);
        region_release(&r);
    }
    assert_int_equal(region_offset(&r, &notched, 1, true, false, plain, NULL), LMN_OK);
    assert_true(region_has_point(&r, 10.309017, 10.951057) && region_has_point(&r, 5, 4.72047));
    region_release(&r);
    assert_int_equal(region_offset(&r, &notched, NAN, true, false, plain, NULL), LMN_FORMAT);
    assert_int_equal(region_offset(&r, &notched, 1, true, false, (facets){1e7, 12, 2}, NULL), LMN_LIMIT);
    assert_int_equal(region_offset(&r, &(region){0}, 1, true, false, plain, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    region_release(&notched);
}

/* A mitre may be far out. */
static void sharp_corners_run_out(void **state)
{
    (void)state;
    region r, wedge = test_polygon((const double[]){0, 0, 100, 0, 100, 1}, 3);
    assert_int_equal(region_offset(&r, &wedge, 1, false, false, plain, NULL), LMN_OK);
    assert_region(&r, 1, 3, 453.02100);
    assert_true(region_has_point(&r, -200.005, -1));
    region_release(&r);
    region_release(&wedge);
}

/* --- linear extrusion ----------------------------------------------------------------------------------- */

static void extrusions_are_openscads(void **state)
{
    (void)state;
    static const struct {
        linear_extrusion how;
        size_t           points, triangles;
        double           volume;
    } cases[] = {
        {{4, 0, {1, 1}, .facets = {0, 12, 2}}, 8, 12, 16},
        {{4, 0, {1, 1}, .has_slices = true, .slices = 3}, 16, 28, 16},
        {{4, 60, {2, 2}, .facets = {0, 12, 2}}, 16, 28, 40.783388},
        {{4, 60, {0.3, 0.3}, .facets = {0, 12, 2}}, 16, 28, 8.0822098},
        {{4, 60, {0, 0}, .facets = {0, 12, 2}}, 13, 22, 5.7785085},
        {{4, 60, {-1, -1}, .facets = {0, 12, 2}}, 13, 22, 5.7785085},
        {{4, 400, {2, 2}, .facets = {0, 12, 2}}, 24, 44, 39.293982},
        {{4, 60, {1, 20}, .facets = {0, 12, 2}}, 16, 28, 168.05701},
        {{4, 360, {1, 1}, .facets = {20, 12, 2}}, 84, 164, 17.387009},
        {{4, 360, {1, 1}, .facets = {2, 12, 2}}, 16, 28, 12.618854},
        {{40, 360, {1, 1}, .facets = {0, 1, 0.5}}, 332, 660, 163.92624},
        {{4, 0, {1, 9}, .facets = {20, 12, 2}}, 84, 164, 80},
        {{4, 0, {1, 9}, .facets = {0, 12, 2}}, 24, 44, 80},
        {{4, 0, {0, 1}, .facets = {0, 12, 2}}, 14, 24, 8},
        {{4, 60, {0, 1}, .facets = {0, 12, 2}},
         16,
         28,
         8.5485530}, /* closed along the line; OpenSCAD's has a slit there */
        {{4, 0, {0, 0}, .facets = {0, 12, 2}}, 5, 6, 16.0 / 3},
    };
    region square;
    assert_int_equal(construct_square(&square, (double[]){2, 2}, true, NULL), LMN_OK);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        polyhedron p;
        assert_int_equal(construct_linear_extrude(&p, &square, &cases[i].how, NULL), LMN_OK);
        assert_shape(&p, cases[i].points, cases[i].triangles, cases[i].volume);
    }
    region_release(&square);
}

static void extrusions_of_other_outlines(void **state)
{
    (void)state;
    linear_extrusion how = {2, 100, {1, 1}, .centre = true, .facets = plain};
    region           ring, pair[2] = {test_circle(0, 0, 5, 70), test_circle(1, 0.333333333, 3, 31)};
    polyhedron       p;
    assert_int_equal(region_combine(&ring, pair, 2, REGION_DIFFERENCE, NULL), LMN_OK);
    assert_int_equal(construct_linear_extrude(&p, &ring, &how, NULL), LMN_OK);
    assert_watertight(&p);
    assert_bounds(&p, (point3){-5, -5, -1}, (point3){5, 5, 1}, 0.01);
    polyhedron_release(&p);
    region off_axis = test_square(10, 0, 2);
    how = (linear_extrusion){1, 30, {1, 1}, .has_slices = true, .slices = 1};
    assert_int_equal(construct_linear_extrude(&p, &off_axis, &how, NULL), LMN_OK);
    assert_watertight(&p);
    assert_bounds(&p, (point3){8.66025404, -6, 0}, (point3){12, 2, 1}, 1e-8);
    polyhedron_release(&p);
    region_release(&off_axis);
    region_release(&ring);
    region_release(&pair[0]);
    region_release(&pair[1]);
}

/* Edges where two prisms touch have four faces; by positions all is closed. */
static void extrusions_of_touching_outlines_are_closed(void **state)
{
    (void)state;
    region     united, pair[2] = {test_square(0, 0, 1), test_square(1, 1, 1)};
    polyhedron p;
    bool       failed;
    assert_int_equal(region_combine(&united, pair, 2, REGION_UNION, NULL), LMN_OK);
    assert_int_equal(construct_linear_extrude(&p, &united, &(linear_extrusion){1, 0, {1, 1}}, NULL), LMN_OK);
    assert_true(polyhedron_is_closed(&p, &failed));
    assert_int_equal(p.point_count, 14);
    assert_int_equal(p.triangle_count, 24);
    polyhedron_release(&p);
    region_release(&united);
    region_release(&pair[0]);
    region_release(&pair[1]);
}

static void bad_extrusions_are_refused(void **state)
{
    (void)state;
    region     square = test_square(0, 0, 1);
    polyhedron p;
    assert_int_equal(construct_linear_extrude(&p, &square, &(linear_extrusion){-1, 0, {1, 1}}, NULL), LMN_OK);
    assert_empty(&p);
    assert_int_equal(construct_linear_extrude(&p, &(region){0}, &(linear_extrusion){1, 0, {1, 1}}, NULL), LMN_OK);
    assert_empty(&p);
    assert_int_equal(construct_linear_extrude(&p, &square, &(linear_extrusion){1, NAN, {1, 1}}, NULL), LMN_FORMAT);
    linear_extrusion how = {1, 1, {1, 1}, .has_slices = true, .slices = 2000000000};
    assert_int_equal(construct_linear_extrude(&p, &square, &how, NULL), LMN_LIMIT);
    how = (linear_extrusion){1, 1e300, {1, 1}, .facets = plain};
    assert_int_equal(construct_linear_extrude(&p, &square, &how, NULL), LMN_LIMIT);
    how = (linear_extrusion){1, 0, {1, 1}, .has_slices = true, .slices = -5};
    assert_int_equal(construct_linear_extrude(&p, &square, &how, NULL), LMN_OK);
    assert_shape(&p, 8, 12, 1);
    square.contours[0].points[1] = (point2){1, 2}; /* now it crosses itself, and its two halves run opposite ways */
    square.contours[0].points[2] = (point2){1, -2};
    assert_int_equal(construct_linear_extrude(&p, &square, &(linear_extrusion){1, 0, {1, 1}}, NULL), LMN_OK);
    assert_watertight(&p);
    polyhedron_release(&p);
    region_release(&square);
}

/* --- rotating extrusion --------------------------------------------------------------------------------- */

static void turns_are_openscads(void **state)
{
    (void)state;
    static const struct {
        double x, angle, fn;
        size_t points, triangles;
        double low_x, high_x, volume;
    } cases[] = {
        {2, 360, 5, 20, 40, -3, 2.42705098, 23.776413},  {2, -400, 5, 20, 40, -3, 2.42705098, 23.776413},
        {-3, 360, 6, 24, 48, -3, 3, 25.980762},          {2, 90, 8, 12, 20, 0, 3, 7.0710678},
        {-3, -90, 8, 12, 20, -3, 0, 7.0710678},          {2, 45, 0, 8, 12, 1.41421356, 3, 3.5355339},
        {0, 360, 5, 12, 20, -1, 0.80901699, 4.7552826},  {0, 90, 8, 8, 12, 0, 1, 1.4142136},
        {2, 123.4, 0, 16, 28, -1.6514422, 3, 9.8672031},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        region     square, moved;
        polyhedron p;
        point3     low, high;
        assert_int_equal(construct_square(&square, (double[]){1, 2}, false, NULL), LMN_OK);
        assert_int_equal(region_transform(&moved, &square, (double[]){1, 0, 0, 1, cases[i].x, 0}, NULL), LMN_OK);
        assert_int_equal(construct_rotate_extrude(&p, &moved, cases[i].angle, (facets){cases[i].fn, 12, 2}, NULL),
                         LMN_OK);
        assert_true(polyhedron_bounds(&p, &low, &high));
        assert_close(low.x, cases[i].low_x, 1e-5);
        assert_close(high.x, cases[i].high_x, 1e-5);
        assert_shape(&p, cases[i].points, cases[i].triangles, cases[i].volume);
        region_release(&square);
        region_release(&moved);
    }
}

static void bad_turns_are_refused(void **state)
{
    (void)state;
    region     across = test_square(-1, 0, 2), beside = test_square(1, 0, 2);
    polyhedron p;
    assert_int_equal(construct_rotate_extrude(&p, &across, 360, plain, NULL), LMN_FORMAT);
    assert_int_equal(construct_rotate_extrude(&p, &beside, NAN, plain, NULL), LMN_FORMAT);
    assert_int_equal(construct_rotate_extrude(&p, &beside, 360, (facets){1e7, 12, 2}, NULL), LMN_LIMIT);
    assert_int_equal(construct_rotate_extrude(&p, &beside, 0, plain, NULL), LMN_OK);
    assert_empty(&p);
    assert_int_equal(construct_rotate_extrude(&p, &(region){0}, 360, plain, NULL), LMN_OK);
    assert_empty(&p);
    /* Rounding has moved a corner over the axis. */
    region_release(&across);
    across = test_square(0, 0, 2);
    across.contours[0].points[0].x = -1e-17;
    assert_int_equal(construct_rotate_extrude(&p, &across, 360, (facets){4, 12, 2}, NULL), LMN_OK);
    assert_shape(&p, 10, 16, 16);
    region_release(&across);
    region_release(&beside);
}

/* --- from solids back to the plane ---------------------------------------------------------------------- */

static polyhedron solid_at(const polyhedron *from, double z)
{
    polyhedron moved;
    mat4       m = mat4_identity();
    m.m[14] = z;
    assert_int_equal(polyhedron_transform(&moved, from, &m, NULL), LMN_OK);
    return moved;
}

static void slices_are_openscads(void **state)
{
    (void)state;
    polyhedron sphere, cube, p;
    region     r;
    assert_int_equal(construct_sphere(&sphere, 5, (facets){7, 12, 2}, NULL), LMN_OK);
    p = solid_at(&sphere, 1);
    assert_int_equal(polyhedron_slice(&r, &p, NULL), LMN_OK);
    assert_region(&r, 1, 7, 58.3916);
    assert_true(region_has_point(&r, 4.6194, 0) && region_has_point(&r, -4.16193, 2.00428));
    region_release(&r);
    polyhedron_release(&p);
    polyhedron_release(&sphere);
    assert_int_equal(construct_cube(&cube, (double[]){3, 3, 3}, false, NULL), LMN_OK);
    const double heights[] = {0, -3, -1, 1, -4};
    for (int i = 0; i < 5; i++) {
        p = solid_at(&cube, heights[i]);
        assert_int_equal(polyhedron_slice(&r, &p, NULL), LMN_OK);
        assert_region(&r, i < 3, i < 3 ? 4 : 0, i < 3 ? 9 : 0);
        region_release(&r);
        polyhedron_release(&p);
    }
    assert_int_equal(polyhedron_slice(&r, &(polyhedron){0}, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    polyhedron_release(&cube);
}

static void shadows_are_openscads(void **state)
{
    (void)state;
    polyhedron ring, turned;
    region     r, circle = test_circle(5, 0, 2, 10);
    mat4       m = mat4_identity();
    m.m[5] = m.m[10] = cosine_of_degrees(30);
    m.m[6] = 0.5;
    m.m[9] = -0.5;
    assert_int_equal(construct_rotate_extrude(&ring, &circle, 360, (facets){9, 12, 2}, NULL), LMN_OK);
    assert_int_equal(polyhedron_transform(&turned, &ring, &m, NULL), LMN_OK);
    assert_int_equal(polyhedron_shadow(&r, &turned, NULL), LMN_OK);
    assert_region(&r, 2, 22, 107.41820);
    region_release(&r);
    assert_int_equal(polyhedron_shadow(&r, &(polyhedron){0}, NULL), LMN_OK);
    assert_region(&r, 0, 0, 0);
    region_release(&circle);
    polyhedron_release(&ring);
    polyhedron_release(&turned);
}

static lmn_status make_everything(region *offset, polyhedron *solid, region *shadow, const region *notched)
{
    *offset = *shadow = (region){0};
    *solid = (polyhedron){0};
    lmn_status status = region_offset(offset, notched, 1, true, false, plain, NULL);
    if (status == LMN_OK)
        status = construct_linear_extrude(solid, offset, &(linear_extrusion){1, 30, {1, 1}, .facets = plain}, NULL);
    if (status == LMN_OK)
        status = polyhedron_shadow(shadow, solid, NULL);
    region_release(shadow);
    if (status == LMN_OK)
        status = polyhedron_slice(shadow, solid, NULL);
    region_release(shadow);
    if (status == LMN_OK)
        status = region_minkowski(shadow, notched, notched, NULL);
    return status;
}

static void memory_may_end_in_regions(void **state)
{
    (void)state;
    region     notched = test_notched();
    lmn_status status = LMN_MEMORY;
    long       n = 0;
    while (status == LMN_MEMORY) {
        region     offset, shadow;
        polyhedron solid;
        mem_fail_at(++n);
        status = make_everything(&offset, &solid, &shadow, &notched);
        mem_fail_at(0);
        region_release(&offset);
        region_release(&shadow);
        polyhedron_release(&solid);
    }
    assert_int_equal(status, LMN_OK);
    assert_true(n > 50);
    region_release(&notched);
}

/* --- many of them --------------------------------------------------------------------------------------- */

static double random_number(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / 16777216.0;
}

/* A path of few or many corners, on whole numbers (where much touches and lies on lines) or between them. */
static region random_polygon(uint32_t *seed)
{
    double   numbers[60];
    uint32_t count = 3 + (uint32_t)(random_number(seed) * 20);
    bool     whole = random_number(seed) < 0.6;
    for (uint32_t i = 0; i < count * 2; i++) {
        numbers[i] = random_number(seed) * 10;
        numbers[i] = whole ? floor(numbers[i]) : numbers[i];
    }
    return test_polygon(numbers, count);
}

static void assert_closed_solids(const region *r, uint32_t *seed)
{
    polyhedron p;
    region     turned;
    bool       failed;
    double     angle = random_number(seed) * 6.3, twist = floor(random_number(seed) * 3) * 40, c = cos(angle),
           s = sin(angle);
    assert_int_equal(region_transform(&turned, r, (double[]){c, s, -s, c, 0.1, 0.7}, NULL), LMN_OK);
    assert_int_equal(
        construct_linear_extrude(&p, &turned, &(linear_extrusion){2, twist, {1, 1}, .facets = plain}, NULL), LMN_OK);
    assert_true(polyhedron_is_closed(&p, &failed));
    if (twist == 0)
        assert_close(polyhedron_volume(&p), 2 * region_area(r), 1e-3);
    polyhedron_release(&p);
    assert_int_equal(construct_rotate_extrude(&p, r, floor(random_number(seed) * 4) * 120, (facets){5, 12, 2}, NULL),
                     LMN_OK);
    assert_true(polyhedron_is_closed(&p, &failed));
    polyhedron_release(&p);
    region_release(&turned);
}

/* What is a union and an intersection together is both operands together. */
static void random_outlines_make_closed_solids(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (int i = 0; i < 60; i++) {
        region pair[2] = {random_polygon(&seed), random_polygon(&seed)}, united, common, grown;
        assert_int_equal(region_combine(&united, pair, 2, REGION_UNION, NULL), LMN_OK);
        assert_int_equal(region_combine(&common, pair, 2, REGION_INTERSECTION, NULL), LMN_OK);
        assert_close(region_area(&united) + region_area(&common), region_area(&pair[0]) + region_area(&pair[1]), 5e-3);
        assert_int_equal(region_offset(&grown, &united, i % 2 ? 0.5 : -0.25, i % 3 == 0, i % 3 == 1, plain, NULL),
                         LMN_OK);
        assert_true(i % 2 ? region_area(&grown) > region_area(&united) : region_area(&grown) <= region_area(&united));
        assert_closed_solids(&united, &seed);
        assert_closed_solids(&common, &seed);
        region_release(&grown);
        region_release(&united);
        region_release(&common);
        region_release(&pair[0]);
        region_release(&pair[1]);
    }
}

/* GLU follows a hole at infinity astray; there is no triangle then, and no harm. */
static void outlines_at_infinity_have_no_triangles(void **state)
{
    (void)state;
    point2        around[] = {{0, 0}, {0, 1}, {-1, 1}, {-1, 0}}, hole[] = {{-NAN, INFINITY}, {0, 1}, {0, 0}};
    const contour contours[] = {{.points = around, .count = 4}, {.points = hole, .count = 3}};
    uint32_t     *corners = NULL;
    size_t        count = 1;
    bool          exact = true;
    assert_int_equal(contours_triangulate(contours, 2, &corners, &count, &exact, NULL), LMN_OK);
    assert_int_equal(count, 0);
    assert_false(exact);
    mem_free(corners);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outlines_at_infinity_have_no_triangles),
        cmocka_unit_test(squares_and_circles),
        cmocka_unit_test(polygons_are_even_odd),
        cmocka_unit_test(polygons_of_several_paths),
        cmocka_unit_test(set_operations_are_openscads),
        cmocka_unit_test(set_operations_at_their_edges),
        cmocka_unit_test(a_hole_is_a_clockwise_contour),
        cmocka_unit_test(hulls_and_sums),
        cmocka_unit_test(offsets_are_openscads),
        cmocka_unit_test(sharp_corners_run_out),
        cmocka_unit_test(extrusions_are_openscads),
        cmocka_unit_test(extrusions_of_other_outlines),
        cmocka_unit_test(extrusions_of_touching_outlines_are_closed),
        cmocka_unit_test(bad_extrusions_are_refused),
        cmocka_unit_test(turns_are_openscads),
        cmocka_unit_test(bad_turns_are_refused),
        cmocka_unit_test(slices_are_openscads),
        cmocka_unit_test(shadows_are_openscads),
        cmocka_unit_test(memory_may_end_in_regions),
        cmocka_unit_test(random_outlines_make_closed_solids),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
