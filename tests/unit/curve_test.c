/* Four-point curves: stencils by hand, positions on known curves. Rows OE-12, OE-13. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "stroke/curve.h"

static const double pi = 3.14159265358979323846;
enum { CAPACITY = 4096 };

/* Where the number that is asked for is 16 at one point and 0 elsewhere, its fractions can be read off. */
static void fractions_of_each_point(void **state)
{
    (void)state;
    static const double wanted[6][11] = {
        {16, 8, 0, -1, 0, 0, 0, 0, 0, 0, 0},  {0, 9, 16, 9, 0, -1, 0, 0, 0, 0, 0}, {0, -1, 0, 9, 16, 9, 0, -1, 0, 0, 0},
        {0, 0, 0, -1, 0, 9, 16, 9, 0, -1, 0}, {0, 0, 0, 0, 0, -1, 0, 9, 16, 9, 0}, {0, 0, 0, 0, 0, 0, 0, -1, 0, 8, 16},
    };
    for (int i = 0; i < 6; i++) {
        double points[6] = {0}, out[11];
        points[i] = 16;
        curve_refine(out, points, 6, 1, false);
        assert_int_equal(curve_count(6, false), 11);
        for (int k = 0; k < 11; k++)
            assert_true(out[k] == wanted[i][k]);
    }
}

static void closed_chains_have_no_ends(void **state)
{
    (void)state;
    for (int i = 0; i < 5; i++) {
        double points[5] = {0}, out[10];
        points[i] = 16;
        curve_refine(out, points, 5, 1, true);
        static const double wanted[10] = {16, 9, 0, -1, 0, 0, 0, -1, 0, 9};
        for (int k = 0; k < 10; k++)
            assert_true(out[(2 * i + k) % 10] == wanted[k]);
    }
}

static void short_chains_stay_straight(void **state)
{
    (void)state;
    const double two[4] = {1, 2, 5, 10};
    double       out[6];
    curve_refine(out, two, 2, 2, false);
    const double wanted[6] = {1, 2, 3, 6, 5, 10};
    assert_memory_equal(out, wanted, sizeof wanted);
    curve_refine(out, two, 1, 2, false);
    assert_memory_equal(out, two, 2 * sizeof *two);
    assert_int_equal(curve_count(0, false), 0);
    assert_int_equal(curve_count(1, false), 1);
}

/* Cubic polynomials are reproduced inside; the points around the middle of a long chain see no end. */
static void cubics_are_exact(void **state)
{
    (void)state;
    double points[32], out[63];
    for (int i = 0; i < 32; i++)
        points[i] = i * i * i - 20.0 * i * i + i;
    curve_refine(out, points, 32, 1, false);
    for (int k = 2; k < 61; k++) {
        double t = 0.5 * k;
        assert_true(fabs(out[k] - (t * t * t - 20 * t * t + t)) < 1e-9);
    }
}

static void twelve_corners_make_a_circle(void **state)
{
    (void)state;
    double a[CAPACITY], b[CAPACITY], *now = a, *next = b;
    size_t count = 12;
    for (size_t i = 0; i < count; i++) {
        now[2 * i] = 100 * cos(2 * pi * (double)i / 12);
        now[2 * i + 1] = 100 * sin(2 * pi * (double)i / 12);
    }
    for (int step = 0; step < 4; step++) {
        curve_refine(next, now, count, 2, true);
        count = curve_count(count, true);
        double *other = now;
        now = next;
        next = other;
    }
    assert_int_equal(count, 12 * 16);
    double most = 0;
    for (size_t i = 0; i < count; i++)
        most = fmax(most, fabs(hypot(now[2 * i], now[2 * i + 1]) - 100));
    assert_true(most < 0.3); /* the twelve-sided polygon is off by 3.4 */
}

/* On the page or in space is the same in parallel projection, whatever else a point carries along. */
static void projecting_first_or_last_is_the_same(void **state)
{
    (void)state;
    double       space[20 * 3], page[20 * 2], fine[39 * 3], flat[39 * 2];
    const double turn[2][3] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}};
    for (int i = 0; i < 20; i++) {
        space[3 * i] = cos(0.4 * i);
        space[3 * i + 1] = sin(0.4 * i);
        space[3 * i + 2] = 0.1 * i;
        for (int k = 0; k < 2; k++)
            page[2 * i + k] = turn[k][0] * space[3 * i] + turn[k][1] * space[3 * i + 1] + turn[k][2] * space[3 * i + 2];
    }
    curve_refine(fine, space, 20, 3, false);
    curve_refine(flat, page, 20, 2, false);
    for (int i = 0; i < 39; i++)
        for (int k = 0; k < 2; k++)
            assert_true(fabs(flat[2 * i + k] - (turn[k][0] * fine[3 * i] + turn[k][1] * fine[3 * i + 1] +
                                                turn[k][2] * fine[3 * i + 2])) < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fractions_of_each_point),      cmocka_unit_test(closed_chains_have_no_ends),
        cmocka_unit_test(short_chains_stay_straight),   cmocka_unit_test(cubics_are_exact),
        cmocka_unit_test(twelve_corners_make_a_circle), cmocka_unit_test(projecting_first_or_last_is_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
