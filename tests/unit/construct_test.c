/* Solids from numbers. The counts, volumes and coordinates are those of OpenSCAD 2021.01 where no formula gives
 * them. */
#include "construct_shapes.h"

/* --- facets --------------------------------------------------------------------------------------------- */

static void facet_counts_are_openscads(void **state)
{
    (void)state;
    assert_int_equal(facets_of_circle(1e-9, (facets){100, 12, 2}), 3);
    assert_int_equal(facets_of_circle(1, (facets){1, 12, 2}), 3);
    assert_int_equal(facets_of_circle(1, (facets){7.9, 12, 2}), 7);
    assert_int_equal(facets_of_circle(1, plain), 5);
    assert_int_equal(facets_of_circle(5, plain), 16);
    assert_int_equal(facets_of_circle(100, plain), 30);
    assert_int_equal(facets_of_circle(10, (facets){0, 1, 0.1}), 360);
    assert_true(facets_of_circle(1, (facets){1e300, 12, 2}) > (int)LIMIT_SHAPE_POINTS);
    assert_int_equal(facets_of_circle(1, (facets){NAN, 12, 2}), 3);
    assert_int_equal(facets_of_circle(NAN, plain), 3);
}

static void sines_of_degrees_are_exact(void **state)
{
    (void)state;
    for (int i = -720; i <= 720; i++) {
        assert_close(sine_of_degrees(i), sin(i * PI / 180), 1e-14);
        assert_close(cosine_of_degrees(i), cos(i * PI / 180), 1e-14);
        assert_true(sine_of_degrees(i) == -sine_of_degrees(-i) && cosine_of_degrees(i) == cosine_of_degrees(-i));
        assert_true(cosine_of_degrees(i) == sine_of_degrees(i + 90));
    }
    assert_true(sine_of_degrees(180) == 0 && cosine_of_degrees(60) == 0.5 && cosine_of_degrees(-240) == -0.5);
}

/* --- plain solids --------------------------------------------------------------------------------------- */

static void cubes(void **state)
{
    (void)state;
    polyhedron p;
    assert_int_equal(construct_cube(&p, (double[]){1, 2, 3}, false, NULL), LMN_OK);
    assert_true(p.convex && polyhedron_check_convex(&p));
    assert_bounds(&p, (point3){0, 0, 0}, (point3){1, 2, 3}, 0);
    assert_shape(&p, 8, 12, 6);
    assert_int_equal(construct_cube(&p, (double[]){1, 2, 3}, true, NULL), LMN_OK);
    assert_bounds(&p, (point3){-0.5, -1, -1.5}, (point3){0.5, 1, 1.5}, 0);
    assert_shape(&p, 8, 12, 6);
    assert_int_equal(construct_cube(&p, (double[]){1, 0, 3}, true, NULL), LMN_OK);
    assert_empty(&p);
    assert_int_equal(construct_cube(&p, (double[]){1, -2, 3}, true, NULL), LMN_OK);
    assert_empty(&p);
    assert_int_equal(construct_cube(&p, (double[]){1, NAN, 3}, true, NULL), LMN_FORMAT);
    assert_empty(&p);
}

static void spheres(void **state)
{
    (void)state;
    polyhedron p;
    assert_int_equal(construct_sphere(&p, 5, (facets){9, 12, 2}, NULL), LMN_OK);
    assert_true(p.convex && polyhedron_check_convex(&p));
    assert_bounds(&p, (point3){-4.69846310, -4.92403877, -4.75528258}, (point3){5, 4.92403877, 4.75528258}, 1e-8);
    assert_shape(&p, 45, 86, 436.6043);
    assert_int_equal(construct_sphere(&p, 5, plain, NULL), LMN_OK);
    assert_shape(&p, 16 * 8, 16 * 7 * 2 + 14 * 2, 490.91747);
    for (int fn = 1; fn < 40; fn++) {
        assert_int_equal(construct_sphere(&p, 0.3, (facets){fn, 12, 2}, NULL), LMN_OK);
        assert_watertight(&p);
        polyhedron_release(&p);
    }
    assert_int_equal(construct_sphere(&p, 0, plain, NULL), LMN_OK);
    assert_empty(&p);
    assert_int_equal(construct_sphere(&p, -1, plain, NULL), LMN_OK);
    assert_empty(&p);
    assert_int_equal(construct_sphere(&p, INFINITY, plain, NULL), LMN_FORMAT);
    assert_int_equal(construct_sphere(&p, 1, (facets){1e6, 12, 2}, NULL), LMN_LIMIT);
    assert_empty(&p);
}

static void cylinders(void **state)
{
    (void)state;
    polyhedron p;
    double     area5 = 2.5 * sin(72 * PI / 180);
    assert_int_equal(construct_cylinder(&p, 2, 1, 1, true, plain, NULL), LMN_OK);
    assert_true(p.convex && polyhedron_check_convex(&p));
    assert_bounds(&p, (point3){-0.80901699, -0.95105652, -1}, (point3){1, 0.95105652, 1}, 1e-8);
    assert_shape(&p, 10, 16, 2 * area5);
    assert_int_equal(construct_cylinder(&p, 2, 0, 1, false, (facets){5, 12, 2}, NULL), LMN_OK);
    assert_shape(&p, 6, 8, 2 * area5 / 3);
    assert_int_equal(construct_cylinder(&p, 2, 1, 0, false, (facets){5, 12, 2}, NULL), LMN_OK);
    assert_shape(&p, 6, 8, 2 * area5 / 3);
    assert_int_equal(construct_cylinder(&p, 2, 1, 2, false, (facets){5, 12, 2}, NULL), LMN_OK);
    assert_shape(&p, 10, 16, 2 * area5 * 7 / 3);
    const double wrong[][3] = {{0, 1, 1}, {-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {1, 0, 0}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(construct_cylinder(&p, wrong[i][0], wrong[i][1], wrong[i][2], false, plain, NULL), LMN_OK);
        assert_empty(&p);
    }
    assert_int_equal(construct_cylinder(&p, NAN, 1, 1, false, plain, NULL), LMN_FORMAT);
    assert_int_equal(construct_cylinder(&p, 1, 1, 1, false, (facets){1e9, 12, 2}, NULL), LMN_LIMIT);
    assert_empty(&p);
}

/* A prism over an arrow, whose faces are concave. */
static void polyhedra_with_concave_faces(void **state)
{
    (void)state;
    const point3   points[] = {{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {2, 4, 0}, {0, 0, 2},
                               {4, 0, 2}, {2, 1, 2}, {2, 4, 2}, {9, 9, 9}};
    const uint32_t corners[] = {0, 1, 2, 3, 7, 6, 5, 4, 4, 5, 1, 0, 5, 6, 2, 1, 6, 7, 3, 2, 7, 4, 0, 3};
    const uint32_t sizes[] = {4, 4, 4, 4, 4, 4};
    uint32_t       backwards[24];
    polyhedron     p;
    bool           flawed;
    assert_int_equal(construct_polyhedron(&p, points, 9, corners, sizes, 6, &flawed, NULL), LMN_OK);
    assert_false(flawed);
    assert_false(p.convex);
    assert_shape(&p, 8, 12, 2 * 5);
    for (int i = 0; i < 24; i++)
        backwards[i] = corners[23 - i];
    assert_int_equal(construct_polyhedron(&p, points, 8, backwards, sizes, 6, &flawed, NULL), LMN_OK);
    assert_false(flawed);
    assert_shape(&p, 8, 12, 2 * 5);
    assert_int_equal(construct_polyhedron(&p, points, 8, corners, sizes, 5, &flawed, NULL), LMN_OK);
    assert_true(flawed);
    assert_int_equal(p.triangle_count, 10);
    polyhedron_release(&p);
    assert_int_equal(construct_polyhedron(&p, points, 7, corners, sizes, 6, &flawed, NULL), LMN_FORMAT);
    assert_empty(&p);
    assert_int_equal(construct_polyhedron(&p, points, 8, corners, (uint32_t[]){0, 1, 2}, 3, &flawed, NULL), LMN_OK);
    assert_empty(&p);
}

/* Points given twice, as exports often have them, and corners on straight edges. */
static void polyhedra_are_welded(void **state)
{
    (void)state;
    const point3   points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -0.0, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}};
    const uint32_t corners[] = {0, 5, 1, 6, 2, 4, 3, 1, 5, 4, 2, 3, 1, 3, 2, 6};
    polyhedron     p;
    bool           flawed;
    assert_int_equal(construct_polyhedron(&p, points, 7, corners, (uint32_t[]){5, 4, 3, 4}, 4, &flawed, NULL), LMN_OK);
    assert_false(flawed);
    assert_true(p.convex);
    assert_shape(&p, 6, 8, 1.0 / 6);
    point3 bad[7];
    memcpy(bad, points, sizeof bad);
    bad[3].y = NAN;
    assert_int_equal(construct_polyhedron(&p, bad, 7, corners, (uint32_t[]){5, 4, 3, 4}, 4, &flawed, NULL), LMN_FORMAT);
}

/* --- fields of heights, hulls and sums ------------------------------------------------------------------ */

static void heights_stand_on_a_base(void **state)
{
    (void)state;
    const double heights[] = {1, 2, 3, 4, 4, 5, 6, 2, 0, 1, 0, -2}, high[] = {7, 8, 9, 10};
    polyhedron   p;
    assert_int_equal(construct_heights(&p, heights, 4, 3, false, NULL), LMN_OK);
    assert_bounds(&p, (point3){0, 0, -3}, (point3){3, 2, 6}, 0);
    assert_shape(&p, 29, 54, 35.75); /* one more than OpenSCAD's: the middle of the base */
    assert_int_equal(construct_heights(&p, heights, 4, 3, true, NULL), LMN_OK);
    assert_bounds(&p, (point3){-1.5, -1, -3}, (point3){1.5, 1, 6}, 0);
    polyhedron_release(&p);
    assert_int_equal(construct_heights(&p, high, 2, 2, false, NULL), LMN_OK);
    assert_bounds(&p, (point3){0, 0, 0}, (point3){1, 1, 10}, 0);
    assert_shape(&p, 10, 16, 8.5);
    assert_int_equal(construct_heights(&p, heights, 12, 1, false, NULL), LMN_OK);
    assert_empty(&p);
    assert_int_equal(construct_heights(&p, (double[]){1, 2, NAN, 4}, 2, 2, false, NULL), LMN_FORMAT);
    assert_int_equal(construct_heights(&p, heights, 100000, 100000, false, NULL), LMN_LIMIT);
}

static polyhedron moved_cube(double x, double y, double z)
{
    polyhedron cube, moved;
    mat4       m = mat4_identity();
    m.m[12] = x;
    m.m[13] = y;
    m.m[14] = z;
    assert_int_equal(construct_cube(&cube, (double[]){1, 2, 3}, false, NULL), LMN_OK);
    assert_int_equal(polyhedron_transform(&moved, &cube, &m, NULL), LMN_OK);
    polyhedron_release(&cube);
    return moved;
}

static void hulls_are_openscads(void **state)
{
    (void)state;
    polyhedron p, both[2] = {{0}, moved_cube(7, 1, 2)};
    assert_int_equal(construct_sphere(&both[0], 5, (facets){9, 12, 2}, NULL), LMN_OK);
    assert_int_equal(polyhedron_hull(&p, both, 2, NULL), LMN_OK);
    assert_true(p.convex && polyhedron_check_convex(&p));
    assert_shape(&p, 43, 82, 552.31800);
    polyhedron_release(&both[0]);
    both[0] = moved_cube(0, 1, 2);
    assert_int_equal(polyhedron_hull(&p, both, 2, NULL), LMN_OK);
    assert_shape(&p, 8, 12, 48); /* flat sides of many points */
    /* All in a plane, on a line, at one position; nothing at all. */
    for (size_t i = 0; i < both[0].point_count; i++)
        both[0].points[i].z = 1;
    assert_int_equal(polyhedron_hull(&p, both, 1, NULL), LMN_OK);
    assert_empty(&p);
    for (size_t i = 0; i < both[0].point_count; i++)
        both[0].points[i].y = 1;
    assert_int_equal(polyhedron_hull(&p, both, 1, NULL), LMN_OK);
    assert_empty(&p);
    both[0].points[3].x = NAN;
    assert_int_equal(polyhedron_hull(&p, both, 1, NULL), LMN_FORMAT);
    assert_int_equal(polyhedron_hull(&p, NULL, 0, NULL), LMN_OK);
    assert_empty(&p);
    polyhedron_release(&both[0]);
    polyhedron_release(&both[1]);
}

/* Random points, on a lattice too, where most of them lie in the hull's planes. */
static void hulls_of_random_points_are_closed(void **state)
{
    (void)state;
    uint32_t seed = 3;
    for (int i = 0; i < 200; i++) {
        point3     points[200];
        polyhedron p, cloud = {points, 5 + (size_t)i % 195, NULL, 0, false};
        for (size_t k = 0; k < cloud.point_count * 3; k++) {
            seed = seed * 1664525u + 1013904223u;
            double number = (double)(seed >> 8) / 16777216.0;
            (&points[0].x)[k] = i % 3 == 0 ? number : i % 3 == 1 ? floor(number * 4) : floor(number * 30) / 7;
        }
        assert_int_equal(polyhedron_hull(&p, &cloud, 1, NULL), LMN_OK);
        assert_watertight(&p);
        assert_true(p.triangle_count == 0 || polyhedron_check_convex(&p));
        polyhedron_release(&p);
    }
}

static void sums_of_convex_ones_are_openscads(void **state)
{
    (void)state;
    polyhedron p, cube = moved_cube(0, 0, 0), sphere, none = {0};
    assert_int_equal(construct_sphere(&sphere, 1, (facets){12, 12, 2}, NULL), LMN_OK);
    assert_int_equal(polyhedron_minkowski(&p, &cube, &sphere, NULL), LMN_OK);
    assert_shape(&p, 96, 188, 48.38178);
    assert_int_equal(polyhedron_minkowski(&p, &cube, &none, NULL), LMN_OK);
    assert_empty(&p);
    sphere.convex = false;
    assert_int_equal(polyhedron_minkowski(&p, &cube, &sphere, NULL), LMN_OK);
    assert_shape(&p, 96, 188, 48.38178);
    sphere.points[0].z = 0;
    assert_int_equal(polyhedron_minkowski(&p, &cube, &sphere, NULL), LMN_UNSUPPORTED);
    polyhedron_release(&sphere);
    polyhedron_release(&cube);
}

static void memory_may_end_in_hulls(void **state)
{
    (void)state;
    polyhedron cubes[2] = {moved_cube(0, 0, 0), moved_cube(5, 5, 5)};
    long       n = 0;
    lmn_status status = LMN_MEMORY;
    while (status == LMN_MEMORY) {
        polyhedron p, field = {0};
        mem_fail_at(++n);
        status = polyhedron_hull(&p, cubes, 2, NULL);
        if (status == LMN_OK)
            status = construct_heights(&field, (double[]){1, 2, 3, 4}, 2, 2, false, NULL);
        mem_fail_at(0);
        polyhedron_release(&p);
        polyhedron_release(&field);
    }
    assert_int_equal(status, LMN_OK);
    assert_true(n > 8);
    polyhedron_release(&cubes[0]);
    polyhedron_release(&cubes[1]);
}

/* --- transforms and the scene --------------------------------------------------------------------------- */

static void transforms_keep_the_outside_outside(void **state)
{
    (void)state;
    polyhedron p, q;
    assert_int_equal(construct_cube(&p, (double[]){1, 2, 3}, false, NULL), LMN_OK);
    mat4 m = mat4_identity();
    m.m[0] = -2;
    m.m[13] = 5;
    assert_int_equal(polyhedron_transform(&q, &p, &m, NULL), LMN_OK);
    assert_true(q.convex);
    assert_bounds(&q, (point3){-2, 5, 0}, (point3){0, 7, 3}, 0);
    assert_shape(&q, 8, 12, 12);
    m.m[5] = NAN;
    assert_int_equal(polyhedron_transform(&q, &p, &m, NULL), LMN_FORMAT);
    m.m[5] = 0;
    assert_int_equal(polyhedron_transform(&q, &p, &m, NULL), LMN_OK);
    assert_close(polyhedron_volume(&q), 0, 0);
    polyhedron_release(&q);
    polyhedron_release(&p);
}

static void polyhedra_go_into_scenes(void **state)
{
    (void)state;
    lmn_scene *scene = scene_new();
    polyhedron p, empty = {0};
    assert_int_equal(construct_sphere(&p, 1e-3, (facets){12, 12, 2}, NULL), LMN_OK);
    assert_int_equal(polyhedron_into_scene(scene, &p), 0);
    assert_int_equal(polyhedron_into_scene(scene, &empty), 1);
    /* So far out that single precision makes many points one. */
    for (size_t i = 0; i < p.point_count; i++)
        p.points[i].x += 10000;
    assert_int_equal(polyhedron_into_scene(scene, &p), 2);
    const primitive *made = scene->meshes[0].primitives;
    assert_int_equal(made->vertex_count, p.point_count);
    assert_int_equal(made->index_count, p.triangle_count * 3);
    assert_int_equal(made->material, NONE);
    assert_int_equal(scene->meshes[1].primitives->index_count, 0);
    assert_true(scene->meshes[2].primitives->vertex_count < p.point_count);
    polyhedron_release(&p);
    scene_free(scene);
}

static void memory_may_end_in_solids(void **state)
{
    (void)state;
    const point3   points[] = {{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {2, 4, 0}, {0, 0, 2}, {4, 0, 2}, {2, 1, 2}, {2, 4, 2}};
    const uint32_t corners[] = {0, 1, 2, 3, 7, 6, 5, 4, 4, 5, 1, 0, 5, 6, 2, 1, 6, 7, 3, 2, 7, 4, 0, 3};
    long           n = 0;
    lmn_status     status = LMN_MEMORY;
    while (status == LMN_MEMORY) {
        polyhedron p, q = {0};
        bool       flawed;
        mat4       m = mat4_identity();
        mem_fail_at(++n);
        status = construct_polyhedron(&p, points, 8, corners, (uint32_t[]){4, 4, 4, 4, 4, 4}, 6, &flawed, NULL);
        if (status == LMN_OK)
            status = polyhedron_transform(&q, &p, &m, NULL);
        mem_fail_at(0);
        polyhedron_release(&p);
        polyhedron_release(&q);
    }
    assert_int_equal(status, LMN_OK);
    assert_true(n > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facet_counts_are_openscads),
        cmocka_unit_test(sines_of_degrees_are_exact),
        cmocka_unit_test(cubes),
        cmocka_unit_test(spheres),
        cmocka_unit_test(cylinders),
        cmocka_unit_test(polyhedra_with_concave_faces),
        cmocka_unit_test(polyhedra_are_welded),
        cmocka_unit_test(heights_stand_on_a_base),
        cmocka_unit_test(hulls_are_openscads),
        cmocka_unit_test(hulls_of_random_points_are_closed),
        cmocka_unit_test(sums_of_convex_ones_are_openscads),
        cmocka_unit_test(memory_may_end_in_hulls),
        cmocka_unit_test(transforms_keep_the_outside_outside),
        cmocka_unit_test(polyhedra_go_into_scenes),
        cmocka_unit_test(memory_may_end_in_solids),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
