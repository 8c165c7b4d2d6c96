/* Shapes from numbers. The counts, volumes and coordinates are those of OpenSCAD 2021.01 where no formula gives them. */
#include "import_support.h"

#include <math.h>

#include "base/limits.h"
#include "construct/construct.h"
#include "construct/construct_private.h"

static const facets plain = {0, 12, 2}; /* OpenSCAD's defaults */

static int compare_test_edges(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* No point twice, no triangle without three corners, each directed edge once and once the other way. */
static void assert_watertight(const polyhedron *p)
{
    size_t count = p->triangle_count * 3;
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

static void assert_close(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance))
        print_error("%.12g, wanted %.12g\n", value, wanted);
    assert_true(fabs(value - wanted) <= tolerance);
}

static void assert_bounds(const polyhedron *p, point3 low, point3 high, double tolerance)
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
static void assert_shape(polyhedron *p, size_t points, size_t triangles, double volume)
{
    assert_watertight(p);
    assert_int_equal(p->point_count, points);
    assert_int_equal(p->triangle_count, triangles);
    assert_close(polyhedron_volume(p), volume, 1e-5 * (fabs(volume) + 1));
    polyhedron_release(p);
}

static void assert_empty(polyhedron *p)
{
    assert_int_equal(p->triangle_count, 0);
    assert_int_equal(p->point_count, 0);
    assert_null(p->points);
}

/* --- facets ---------------------------------------------------------------------------------------------------------- */

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

/* --- plain solids ---------------------------------------------------------------------------------------------------- */

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
    double area5 = 2.5 * sin(72 * PI / 180);
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
    const point3 points[] = {{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {2, 4, 0}, {0, 0, 2}, {4, 0, 2}, {2, 1, 2}, {2, 4, 2}, {9, 9, 9}};
    const uint32_t corners[] = {0, 1, 2, 3, 7, 6, 5, 4, 4, 5, 1, 0, 5, 6, 2, 1, 6, 7, 3, 2, 7, 4, 0, 3};
    const uint32_t sizes[] = {4, 4, 4, 4, 4, 4};
    uint32_t backwards[24];
    polyhedron p;
    bool flawed;
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
    const point3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -0.0, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}};
    const uint32_t corners[] = {0, 5, 1, 6, 2, 4, 3, 1, 5, 4, 2, 3, 1, 3, 2, 6};
    polyhedron p;
    bool flawed;
    assert_int_equal(construct_polyhedron(&p, points, 7, corners, (uint32_t[]){5, 4, 3, 4}, 4, &flawed, NULL), LMN_OK);
    assert_false(flawed);
    assert_true(p.convex);
    assert_shape(&p, 6, 8, 1.0 / 6);
    point3 bad[7];
    memcpy(bad, points, sizeof bad);
    bad[3].y = NAN;
    assert_int_equal(construct_polyhedron(&p, bad, 7, corners, (uint32_t[]){5, 4, 3, 4}, 4, &flawed, NULL), LMN_FORMAT);
}

/* --- transforms and the scene ------------------------------------------------------------------------------------ */

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
    const point3 points[] = {{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {2, 4, 0}, {0, 0, 2}, {4, 0, 2}, {2, 1, 2}, {2, 4, 2}};
    const uint32_t corners[] = {0, 1, 2, 3, 7, 6, 5, 4, 4, 5, 1, 0, 5, 6, 2, 1, 6, 7, 3, 2, 7, 4, 0, 3};
    long n = 0;
    lmn_status status = LMN_MEMORY;
    while (status == LMN_MEMORY) {
        polyhedron p, q = {0};
        bool flawed;
        mat4 m = mat4_identity();
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
        cmocka_unit_test(transforms_keep_the_outside_outside),
        cmocka_unit_test(polyhedra_go_into_scenes),
        cmocka_unit_test(memory_may_end_in_solids),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
