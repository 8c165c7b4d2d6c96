/* Four-point curves: stencils by hand, positions on known curves. Rows OE-12, OE-13. Arcs over chords: circles,
 * fillets, corners. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "stroke/curve.h"
#include "stroke/curve_arcs.h"

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

static void project(const double p[3], double out[2])
{
    const double focal = 500, away = 5;
    out[0] = focal * (0.36 * p[0] + 0.48 * p[1] - 0.8 * p[2]) / (away - p[0]);
    out[1] = focal * (-0.8 * p[0] + 0.6 * p[1]) / (away - p[0]);
}

/* Row OE-13: curves on the page are those in space, seen from near, but for how unevenly perspective lays points. The
 * truth is the helix itself; what is not refined is ten times farther from it. */
static void curves_on_the_page_are_those_in_space(void **state)
{
    (void)state;
    enum { COUNT = 20, FINE = 39 };
    double space[COUNT * 3], page[COUNT * 2], fine[FINE * 3], flat[FINE * 2], apart = 0, off = 0, chords = 0;
    for (int i = 0; i < COUNT; i++) {
        const double p[3] = {cos(0.4 * i), sin(0.4 * i), 0.1 * i};
        memcpy(&space[3 * i], p, sizeof p);
        project(p, &page[2 * i]);
    }
    curve_refine(fine, space, COUNT, 3, false);
    curve_refine(flat, page, COUNT, 2, false);
    for (int i = 3; i < FINE - 3; i++) { /* the ends know less of what goes on */
        const double true_point[3] = {cos(0.2 * i), sin(0.2 * i), 0.05 * i};
        double       seen[2], wanted[2];
        project(&fine[3 * i], seen);
        project(true_point, wanted);
        apart = fmax(apart, hypot(seen[0] - flat[2 * i], seen[1] - flat[2 * i + 1]));
        off = fmax(off, hypot(wanted[0] - flat[2 * i], wanted[1] - flat[2 * i + 1]));
        if (i % 2)
            chords = fmax(chords, hypot(wanted[0] - 0.5 * (page[i - 1] + page[i + 1]),
                                        wanted[1] - 0.5 * (page[i] + page[i + 2])));
    }
    print_message("on the page and in space: %.3f px apart, %.3f px off the helix, chords %.3f px\n", apart, off,
                  chords);
    assert_true(apart < 0.25 && off < 0.3 && chords > 10 * off);
}

/* How far arcs lie from a circle, at most; `first` … `last` are the lines that are looked at. */
static double off_circle(const arc_point *p, const arc *arcs, size_t count, size_t first, size_t last,
                         const double middle[2], double radius)
{
    double most = 0;
    for (size_t i = first; i <= last; i++) {
        const arc_point *a = &p[i], *b = &p[(i + 1) % count];
        for (int k = 0; k <= 16; k++) {
            double u = k / 16.0, away = arc_height(arcs[i], u), x = b->x - a->x, y = b->y - a->y;
            most = fmax(most,
                        fabs(hypot(a->x + u * x - away * y - middle[0], a->y + u * y + away * x - middle[1]) - radius));
        }
    }
    return most;
}

/* Either way round, whatever the sharpness. */
static void chords_of_circles_become_round(void **state)
{
    (void)state;
    for (int way = -1; way <= 1; way += 2)
        for (int kind = ARC_POINT_SMOOTH; kind <= ARC_POINT_STEP; kind++) {
            arc_point p[12];
            arc       arcs[12];
            for (int i = 0; i < 12; i++)
                p[i] =
                    (arc_point){.x = 100 * cos(2 * pi * i / 12), .y = way * 100 * sin(2 * pi * i / 12), .kind = kind};
            curve_arcs(arcs, p, 12, true, 100);
            assert_true(off_circle(p, arcs, 12, 0, 11, (const double[2]){0, 0}, 100) < 0.1); /* the polygon: 3.4 */
        }
}

/* A part of a circle that ends in corners. */
static void open_arcs_are_round_to_their_ends(void **state)
{
    (void)state;
    arc_point p[7];
    arc       arcs[6];
    for (int i = 0; i < 7; i++)
        p[i] = (arc_point){.x = 100 * cos(0.3 * i), .y = 100 * sin(0.3 * i), .kind = ARC_POINT_STEP};
    curve_arcs(arcs, p, 7, false, 100);
    assert_true(off_circle(p, arcs, 7, 0, 5, (const double[2]){0, 0}, 100) < 0.05); /* the polyline: 1.1 */
}

/* A plate with fillets of five steps: its sides stay straight, its fillets are round, up to where they begin. */
static void fillets_begin_where_sides_end(void **state)
{
    (void)state;
    enum { STEPS = 5, COUNT = 4 * (STEPS + 1) };
    static const double middles[4][2] = {{300, 80}, {20, 80}, {20, 20}, {300, 20}};
    arc_point           p[COUNT];
    arc                 arcs[COUNT];
    for (int k = 0; k < 4; k++)
        for (int i = 0; i <= STEPS; i++) {
            double turn = 0.5 * pi * (k + (double)i / STEPS);
            p[k * (STEPS + 1) + i] = (arc_point){
                .x = middles[k][0] + 20 * cos(turn), .y = middles[k][1] + 20 * sin(turn), .kind = ARC_POINT_STEP};
        }
    curve_arcs(arcs, p, COUNT, true, 100);
    for (size_t k = 0; k < 4; k++) {
        size_t first = k * (STEPS + 1);
        assert_true(off_circle(p, arcs, COUNT, first, first + STEPS - 1, middles[k], 20) < 0.05); /* polyline: 0.25 */
        assert_true(arcs[first + STEPS].begin == 0 && arcs[first + STEPS].end == 0);
    }
}

/* An ellipse of uneven corners: arcs make up the whole turn between them, and come nearer to it than chords do. */
static void arcs_meet_without_corners(void **state)
{
    (void)state;
    enum { COUNT = 18 };
    arc_point p[COUNT];
    arc       arcs[COUNT];
    double    polyline = 0, curve = 0;
    for (int i = 0; i < COUNT; i++) {
        double turn = 2 * pi * (i + 0.3 * sin(2.0 * i)) / COUNT;
        p[i] = (arc_point){.x = 200 * cos(turn), .y = 100 * sin(turn)};
    }
    curve_arcs(arcs, p, COUNT, true, 100);
    for (int i = 0; i < COUNT; i++) {
        const arc_point *a = &p[i], *b = &p[(i + 1) % COUNT];
        double           made = -atan(arcs[(i + COUNT - 1) % COUNT].end) - atan(arcs[i].begin);
        assert_true(fabs(made - a->turn) < 1e-9 && a->turn > 0);
        for (int k = 1; k < 16; k++) {
            double u = k / 16.0, away = arc_height(arcs[i], u), x = a->x + u * (b->x - a->x),
                   y = a->y + u * (b->y - a->y), over_x = x - away * (b->y - a->y), over_y = y + away * (b->x - a->x);
            polyline = fmax(polyline, 1 - hypot(x / 200, y / 100));
            curve = fmax(curve, fabs(1 - hypot(over_x / 200, over_y / 100)));
        }
    }
    printf("an ellipse: chords off by %.4f, arcs by %.4f\n", polyline, curve);
    assert_true(curve < 0.25 * polyline);
}

/* What turns once or twice between sharp edges is meant, and so is what turns far, or once where nothing else does. */
static void corners_are_no_arcs(void **state)
{
    (void)state;
    static const struct {
        double at[6][2];
        size_t count;
        bool   closed;
        int    kind;
    } shapes[] = {
        {{{0, 0}, {100, 0}, {100, 100}, {0, 100}}, 4, true, ARC_POINT_SMOOTH}, /* a square */
        {{{0, 0}, {100, 0}, {190, 40}}, 3, false, ARC_POINT_STEP},             /* one bend */
        {{{0, 0}, {100, 0}, {170, 30}, {200, 100}}, 4, false, ARC_POINT_STEP}, /* two, a chamfer */
        {{{0, 0}, {100, 0}, {100, 0}, {150, 40}}, 4, false, ARC_POINT_SMOOTH}, /* nothing between two points */
        {{{0, 0}, {140, 34}, {240, 34}}, 3, false, ARC_POINT_SMOOTH}, /* along a cone, and on along a cylinder */
        {{{0, 0}, {140, 34}, {200, 34}, {210, 34}, {300, 34.1}}, 5, false, ARC_POINT_SMOOTH}, /* in pieces */
    };
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        arc_point p[6];
        arc       arcs[6];
        size_t    count = shapes[s].count, lines = shapes[s].closed ? count : count - 1;
        for (size_t i = 0; i < count; i++)
            p[i] = (arc_point){.x = shapes[s].at[i][0], .y = shapes[s].at[i][1], .kind = shapes[s].kind};
        curve_arcs(arcs, p, count, shapes[s].closed, 100);
        for (size_t i = 0; i < lines; i++)
            assert_true(arcs[i].begin == 0 && arcs[i].end == 0);
    }
}

/* An outline that runs to and fro across a circle, by less than may be moved: most of that goes, and no corner is
 * left. On smooth surfaces alone: steps between sharp edges stay where they are. */
static void zigzags_become_fair(void **state)
{
    (void)state;
    enum { COUNT = 24 };
    for (int way = 0; way < 3; way++) {
        int       kind = way < 2 ? ARC_POINT_SMOOTH : ARC_POINT_STEP;
        double    most = way == 1 ? 0.5 : 8;
        arc_point p[COUNT];
        arc       arcs[COUNT];
        double    off = 0, moved = 0, corner = 0;
        for (int i = 0; i < COUNT; i++) {
            double turn = 2 * pi * (i + 0.3 * sin(2.0 * i)) / COUNT, radius = i % 2 ? 101 : 99;
            p[i] = (arc_point){.x = radius * cos(turn), .y = radius * sin(turn), .kind = kind};
        }
        curve_arcs(arcs, p, COUNT, true, most);
        for (int i = 0; i < COUNT; i++) {
            int before = (i + COUNT - 1) % COUNT;
            off = fmax(off, fabs(hypot(p[i].x, p[i].y) - 100));
            moved = fmax(moved, hypot(p[i].x - p[i].home_x, p[i].y - p[i].home_y));
            corner = fmax(corner, fabs(-atan(arcs[before].end) - atan(arcs[i].begin) - p[i].turn));
        }
        printf("way %d: off by %.3f, moved by %.3f, corners of %.4f\n", way, off, moved, corner);
        assert_true(way == 2 ? moved == 0 : moved > 0.2 && moved <= fmin(0.5 * most, 2) + 1e-9);
        if (way == 0)
            assert_true(off < 0.5 && corner < 1e-9);
    }
}

static void arcs_stay_near_their_chords(void **state)
{
    (void)state;
    arc_point p[8];
    arc       arcs[8];
    double    most = 0;
    for (int i = 0; i < 8; i++)
        p[i] = (arc_point){.x = 100 * cos(2 * pi * i / 8), .y = 60 * sin(2 * pi * i / 8)};
    curve_arcs(arcs, p, 8, true, 1.5);
    for (size_t i = 0; i < 8; i++)
        for (int k = 0; k <= 64; k++)
            most = fmax(most, fabs(arc_height(arcs[i], k / 64.0)) * p[i].length);
    assert_true(most <= 1.5 && most > 1); /* without a bound: 7 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fractions_of_each_point),
        cmocka_unit_test(closed_chains_have_no_ends),
        cmocka_unit_test(short_chains_stay_straight),
        cmocka_unit_test(cubics_are_exact),
        cmocka_unit_test(twelve_corners_make_a_circle),
        cmocka_unit_test(curves_on_the_page_are_those_in_space),
        cmocka_unit_test(zigzags_become_fair),
        cmocka_unit_test(chords_of_circles_become_round),
        cmocka_unit_test(open_arcs_are_round_to_their_ends),
        cmocka_unit_test(fillets_begin_where_sides_end),
        cmocka_unit_test(corners_are_no_arcs),
        cmocka_unit_test(arcs_stay_near_their_chords),
        cmocka_unit_test(arcs_meet_without_corners),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
