/* Thresholds of marks, and polygons that shrink: against numbers worked out by hand and shapes cut the other way
 * round. Seed 001, chapter 5; rows EX-01 to EX-08, EX-15, EX-16. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "marks/marks.h"
#include "base/random.h"

static void assert_near(double value, double wanted, double off)
{
    if (!(fabs(value - wanted) <= off))
        fail_msg("%.9g is not %.9g within %.3g", value, wanted, off);
}

/* --- EX-01 ---------------------------------------------------------------------------------------------- */

/* Visible needs both priorities; equality counts. */
static void test_two_thresholds(void **state)
{
    (void)state;
    assert_true(mark_is_drawn(0.5f, 0.5f, 0.5f, 0.5f));
    assert_false(mark_is_drawn(0.5f, 0.9f, 0.6f, 0.1f));
    assert_false(mark_is_drawn(0.9f, 0.5f, 0.1f, 0.6f));
    assert_true(mark_is_drawn(1.2f, 1, 1, 0)); /* raised by indication: stays in full light */
}

/* --- EX-02 ---------------------------------------------------------------------------------------------- */

static void project(const double p[3], double focal, bool orthographic, double out[2])
{
    double depth = orthographic ? 1 : -p[2];
    out[0] = focal * p[0] / depth;
    out[1] = focal * p[1] / depth;
}

static void random_frame(random_source *r, double n[3], double u[3], double v[3])
{
    double length = 0;
    do {
        length = 0;
        for (int k = 0; k < 3; k++) {
            n[k] = random_signed(r);
            length += n[k] * n[k];
        }
    } while (length < 0.05 || length > 1);
    for (int k = 0; k < 3; k++)
        n[k] /= sqrt(length);
    const double other[3] = {fabs(n[0]) < 0.6, fabs(n[0]) >= 0.6, 0};
    u[0] = n[1] * other[2] - n[2] * other[1];
    u[1] = n[2] * other[0] - n[0] * other[2];
    u[2] = n[0] * other[1] - n[1] * other[0];
    length = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    for (int k = 0; k < 3; k++)
        u[k] /= length;
    v[0] = n[1] * u[2] - n[2] * u[1];
    v[1] = n[2] * u[0] - n[0] * u[2];
    v[2] = n[0] * u[1] - n[1] * u[0];
}

/* A small square's area and a short line's length on the page, measured by projecting their corners. */
static void test_page_area(void **state)
{
    (void)state;
    const double  SIDE = 1e-4;
    random_source r = random_start(7, 2);
    for (int i = 0; i < 2000; i++) {
        double n[3], u[3], v[3], focal = 200 + 3000 * random_unit(&r), corners[4][2], direction[3];
        bool   flat = i % 3 == 0;
        double position[3] = {random_signed(&r) * 2, random_signed(&r) * 2, -2 - 8 * random_unit(&r)};
        random_frame(&r, n, u, v);
        for (int c = 0; c < 4; c++) {
            double p[3];
            for (int k = 0; k < 3; k++)
                p[k] = position[k] + SIDE * ((c == 1 || c == 2 ? 0.5 : -0.5) * u[k] + (c >= 2 ? 0.5 : -0.5) * v[k]);
            project(p, focal, flat, corners[c]);
        }
        double area = 0;
        for (int c = 0; c < 4; c++)
            area += 0.5 * (corners[c][0] * corners[(c + 1) % 4][1] - corners[c][1] * corners[(c + 1) % 4][0]);
        double unit = flat ? focal : focal / -position[2];
        assert_near(mark_page_area(position, n, focal, flat) / (unit * unit),
                    fabs(area) / (SIDE * SIDE) / (unit * unit), 0.003);
        memcpy(direction, u, sizeof direction);
        double length = hypot(corners[1][0] - corners[0][0], corners[1][1] - corners[0][1]) / SIDE;
        assert_near(mark_page_length(position, direction, focal, flat) / unit, length / unit, 0.003);
    }
}

/* --- EX-03 to EX-05 ------------------------------------------------------------------------------------- */

/* The thesis' law: t = 1 − d |N·P| / |P|², from both together: half of all at twice the distance, half at 60 degrees.
 */
static void test_combined(void **state)
{
    (void)state;
    random_source r = random_start(3, 3);
    for (int i = 0; i < 100; i++) {
        double n[3], u[3], v[3], position[3] = {random_signed(&r), random_signed(&r), -1 - 4 * random_unit(&r)};
        random_frame(&r, n, u, v);
        double away = hypot(hypot(position[0], position[1]), position[2]),
               cosine = fabs(n[0] * position[0] + n[1] * position[1] + n[2] * position[2]) / away;
        assert_near(mark_fraction(MARK_LAW_THESIS, position, n, u, 1.7, false), 1.7 / away * cosine, 1e-12);
        /* What is drawn, times what of it is seen on the page, is the same everywhere for the law that belongs to
         * the mark. */
        double area = mark_page_area(position, n, 1, false);
        assert_near(mark_fraction(MARK_LAW_DOT, position, n, u, 1.7, false) / area, 1.7 * 1.7, 1e-9);
        double length = mark_page_length(position, u, 1, false);
        if (length > 0.05)
            assert_near(mark_fraction(MARK_LAW_LINE, position, n, u, 1.7, false) * length / area, 1.7, 1e-9);
    }
    /* Lines across the tilt keep their number, those along it need the cosine. */
    const double position[3] = {0, 0, -1}, tilted[3] = {sin(1.2), 0, cos(1.2)}, along[3] = {0, 1, 0},
                 across[3] = {cos(1.2), 0, -sin(1.2)};
    assert_near(mark_fraction(MARK_LAW_LINE, position, tilted, along, 1, false), cos(1.2), 1e-9);
    assert_near(mark_fraction(MARK_LAW_LINE, position, tilted, across, 1, false), 1, 1e-9);
}

/* --- EX-07, EX-08 ------------------------------------------------------------------------------------- */

static void test_fade(void **state)
{
    (void)state;
    const float  thresholds[] = {0, 0.25f, 0.5f, 0.75f, 1};
    const double means[] = {1, 0.775, 0.5, 0.225, 0};
    for (int t = 0; t < 5; t++) {
        double sum = 0;
        for (int i = 0; i < 10000; i++)
            sum += (double)mark_fade(((float)i + 0.5f) / 10000, 1, thresholds[t], 0, 0.1f);
        assert_near(sum / 10000, means[t], 0.002);
    }
    /* The greater lack decides, and no step of a threshold changes a mark by more than the ramp's slope. */
    assert_near((double)mark_fade(0.5f, 0.9f, 0.55f, 0, 0.1f), (double)mark_fade(0.5f, 0.2f, 0.55f, 0, 0.1f), 1e-6);
    for (int i = 0; i < 50; i++)
        for (int k = 0; k < 400; k++) {
            float p = (float)i / 50, step = 1.0f / 400, a = mark_fade(p, 1, (float)k * step, 0, 0.1f),
                  b = mark_fade(p, 1, (float)(k + 1) * step, 0, 0.1f);
            assert_true(fabsf(a - b) <= 1.1f * step / 0.1f + 1e-5f);
            assert_false(a >= 1 && b <= 0);
        }
    assert_true(mark_fade(0.5f, 1, 0.5f, 0, 0) == 1 && mark_fade(0.49f, 1, 0.5f, 0, 0) == 0);
}

/* All dots together have the ink that was asked for, as long as there are enough of them or they may grow. */
static void test_dot_ink(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    for (int s = 1; s <= 40; s++) {
        float  fraction = 0.05f * (float)s;
        double sum = 0;
        float  before = INFINITY;
        for (int i = 0; i < COUNT; i++) {
            float ink = mark_dot_ink(1 - (float)i / COUNT, fraction, 0.2f, 2.25f);
            assert_true(ink <= before + 1e-6f); /* by rank */
            before = ink;
            sum += (double)ink;
        }
        assert_near(sum / COUNT, (double)fraction, 0.002);
    }
    assert_true(mark_dot_ink(1, 0, 0.2f, 1) == 0);
    mark_line line = {.light = 0.5f, .perspective = 0.7f};
    assert_true(mark_line_ink(&line, 0.6f, 0.9f, 0) == 1 && mark_line_ink(&line, 0.4f, 0.9f, 0) == 0 &&
                mark_line_ink(&line, 0.6f, 0.2f, 0) == 0);
}

/* --- EX-15, EX-16 --------------------------------------------------------------------------------------- */

static double area_of(double (*p)[2], int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += 0.5 * (p[i][0] * p[(i + 1) % count][1] - p[i][1] * p[(i + 1) % count][0]);
    return fabs(sum);
}

static void test_shapes(void **state)
{
    (void)state;
    /* Onto an edge: linear; onto a point: quadratic; towards a point outside of the triangle. */
    const mark_corner to_edge[3] = {
        {{1, 0}, {0, 0}}, {{1, 0}, {1, 0}}, {{0.2, 1}, {0.2, 1}}}; /* first corner moves from the second */
    const mark_corner to_point[3] = {{{3, 2}, {0, 0}}, {{3, 2}, {1, 0}}, {{3, 2}, {0.2, 1}}};
    double            out[3][2], whole[3][2];
    for (int i = 0; i <= 10; i++) {
        double p = i / 10.0;
        mark_corner_at(to_edge, 3, 1, whole);
        mark_corner_at(to_edge, 3, p, out);
        assert_near(area_of(out, 3) / area_of(whole, 3), p, 0.01);
        mark_corner_at(to_point, 3, p, out);
        assert_near(area_of(out, 3) / area_of(whole, 3), p * p, 0.01);
    }
}

/* An independent reference: the shrunken triangle cut by each line of the other one. */
static int cut_by_line(double (*p)[2], int count, const double a[2], const double b[2], double sign)
{
    double out[16][2];
    int    n = 0;
    for (int i = 0; i < count; i++) {
        const double *from = p[i], *to = p[(i + 1) % count];
        double        s = sign * ((b[0] - a[0]) * (from[1] - a[1]) - (b[1] - a[1]) * (from[0] - a[0]));
        double        e = sign * ((b[0] - a[0]) * (to[1] - a[1]) - (b[1] - a[1]) * (to[0] - a[0]));
        if (s >= 0)
            memcpy(out[n++], from, sizeof out[0]);
        if ((s >= 0) != (e >= 0)) {
            out[n][0] = from[0] + s / (s - e) * (to[0] - from[0]);
            out[n++][1] = from[1] + s / (s - e) * (to[1] - from[1]);
        }
    }
    memcpy(p, out, (size_t)n * sizeof out[0]);
    return n;
}

static void test_cut(void **state)
{
    (void)state;
    random_source r = random_start(11, 4);
    int           most = 0, obtuse = 0;
    for (int i = 0; i < 20000; i++) {
        double mark[3][2], onto[3][2];
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 2; c++) {
                mark[k][c] = random_unit(&r);
                onto[k][c] = random_unit(&r);
            }
        mark_cut cut;
        mark_cut_make(&cut, (const double(*)[2])mark, (const double(*)[2])onto);
        most = cut.count > most ? cut.count : most;
        double turn = (onto[1][0] - onto[0][0]) * (onto[2][1] - onto[0][1]) -
                      (onto[1][1] - onto[0][1]) * (onto[2][0] - onto[0][0]);
        for (int step = 0; step <= 10; step++) {
            double p = step / 10.0, shrunk[16][2], out[MARK_POLYGON_MAX + 1][2];
            memcpy(shrunk, mark, sizeof mark);
            for (int c = 0; c < 2; c++)
                shrunk[2][c] = mark[1][c] + p * (mark[2][c] - mark[1][c]);
            double angle = acos(((shrunk[2][0] - mark[0][0]) * (mark[1][0] - mark[0][0]) +
                                 (shrunk[2][1] - mark[0][1]) * (mark[1][1] - mark[0][1])) /
                                (hypot(shrunk[2][0] - mark[0][0], shrunk[2][1] - mark[0][1]) *
                                 hypot(mark[1][0] - mark[0][0], mark[1][1] - mark[0][1])));
            obtuse += angle > 1.5707963;
            int count = 3;
            for (int k = 0; k < 3; k++)
                count = cut_by_line(shrunk, count, onto[k], onto[(k + 1) % 3], turn >= 0 ? 1 : -1);
            int n = mark_cut_at(&cut, p, out);
            assert_in_range(n, 0, MARK_POLYGON_MAX + 1);
            assert_near(area_of(out, n), area_of(shrunk, count), 1e-5);
        }
    }
    assert_int_equal(most, 6);
    assert_true(obtuse > 1000); /* where the printed arc sine goes wrong */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_two_thresholds),
        cmocka_unit_test(test_page_area),
        cmocka_unit_test(test_combined),
        cmocka_unit_test(test_fade),
        cmocka_unit_test(test_dot_ink),
        cmocka_unit_test(test_shapes),
        cmocka_unit_test(test_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
