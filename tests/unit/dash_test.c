/* Tracing ink into chains and placing dashes on them, against lines whose course and length are known. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "lines/dash.h"
#include "lines/lines.h"

enum { SIDE = 320, RUNS_MAX = 256 };

static const double pi = 3.14159265358979323846;
static const float  spur = 3.5f;

static uint8_t ink[SIDE * SIDE], mask[SIDE * SIDE];

static void clear_ink(void)
{
    memset(ink, 0, sizeof ink);
}

static double segment_distance(double x, double y, const double a[2], const double b[2])
{
    double dx = b[0] - a[0], dy = b[1] - a[1], t = ((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy);
    t = fmax(0, fmin(1, t));
    return hypot(x - a[0] - t * dx, y - a[1] - t * dy);
}

/* A line as a rasteriser draws it: of width 1 one pixel a column or row, else all pixels within. */
static void draw_line(const double a[2], const double b[2], double width)
{
    double dx = b[0] - a[0], dy = b[1] - a[1], size = hypot(dx, dy);
    /* Across the line a column or row meets it in width / max(|cos|, |sin|) pixels. */
    double half = width <= 1 ? 0.5 * fmax(fabs(dx), fabs(dy)) / size - 1e-6 : 0.5 * width;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            if (segment_distance(x, y, a, b) <= half)
                ink[y * SIDE + x] = 1;
}

static void draw_circle(double radius, double width)
{
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            if (fabs(hypot(x - SIDE / 2, y - SIDE / 2) - radius) <= 0.5 * width)
                ink[y * SIDE + x] = 1;
}

static chain_set paint(dash_style style)
{
    chain_set set;
    assert_true(chains_trace(&set, ink, SIDE, SIDE, spur));
    assert_true(dash_paint(mask, SIDE, SIDE, &set, &style));
    return set;
}

/* The ink that stays at a position, between pixels. */
static double ink_at(double x, double y)
{
    int    column = (int)floor(x), row = (int)floor(y);
    double fx = x - column, fy = y - row, sum = 0;
    for (int k = 0; k < 4; k++) {
        int i = (row + k / 2) * SIDE + column + k % 2;
        sum += (k % 2 ? fx : 1 - fx) * (k / 2 ? fy : 1 - fy) * mask[i] / 255.0;
    }
    return sum;
}

typedef struct run_list {
    double ends[RUNS_MAX]; /* where ink and gap take turns, beginning with ink */
    int    count;
} run_list;

/* Ink and gaps along a straight course. */
static run_list runs_along(const double a[2], const double b[2])
{
    run_list out = {.count = 0};
    double   length = hypot(b[0] - a[0], b[1] - a[1]);
    bool     last = true;
    for (double s = 0; s <= length; s += 0.02) {
        bool on = ink_at(a[0] + (b[0] - a[0]) * s / length, a[1] + (b[1] - a[1]) * s / length) >= 0.5;
        if (on != last && out.count + 1 < RUNS_MAX)
            out.ends[out.count++] = s;
        last = on;
    }
    out.ends[out.count++] = length;
    return out;
}

/* Dashes and gaps between free ends: means near the stretched nominal, none shorter than half, ink at both ends. */
static void judge_line(const run_list *r, dash_style style, double length, const char *what, double *worst)
{
    int gaps = r->count / 2;
    if (gaps < 1 || r->count % 2 != 1)
        fail_msg("%s: %d runs", what, r->count);
    double stretch = length / (gaps * (double)(style.dash + style.gap) + (double)style.dash);
    double dashes = 0, between = 0, least_dash = length, least_gap = length;
    for (int i = 0; i < r->count; i++) {
        double run = r->ends[i] - (i ? r->ends[i - 1] : 0);
        if (i % 2) {
            between += run / gaps;
            least_gap = fmin(least_gap, run);
        } else {
            dashes += run / (gaps + 1);
            least_dash = fmin(least_dash, run);
        }
    }
    double off =
        fmax(fabs(dashes / (stretch * (double)style.dash) - 1), fabs(between / (stretch * (double)style.gap) - 1));
    *worst = fmax(*worst, off);
    if (off > 0.08)
        fail_msg("%s: dashes %.2f, gaps %.2f px, stretch %.3f", what, dashes, between, stretch);
    if (least_dash < 0.5 * stretch * (double)style.dash || least_gap < 0.5 * stretch * (double)style.gap)
        fail_msg("%s: shortest dash %.2f, shortest gap %.2f px", what, least_dash, least_gap);
    if (fabs(stretch - 1) > 0.08)
        fail_msg("%s: stretched by %.3f", what, stretch);
}

static void lines_of_every_slope(void **state)
{
    (void)state;
    static const double widths[] = {1, 2, 3, 6};
    double              worst[4] = {0};
    for (int w = 0; w < 4; w++)
        for (int degrees = 0; degrees <= 90; degrees++) {
            double angle = degrees * pi / 180, a[2] = {40.3, 30.6},
                   b[2] = {a[0] + 210 * cos(angle), a[1] + 210 * sin(angle)};
            char what[64];
            snprintf(what, sizeof what, "width %.0f, %d degrees", widths[w], degrees);
            clear_ink();
            draw_line(a, b, widths[w]);
            dash_style style = {10, 6, (float)widths[w]};
            chain_set  set = paint(style);
            assert_int_equal(set.chain_count, 1);
            assert_false(set.chains[0].closed);
            run_list r = runs_along(a, b);
            judge_line(&r, style, 210, what, &worst[w]);
            chains_release(&set);
        }
    for (int w = 0; w < 4; w++)
        print_message("width %.0f: means at most %.1f %% off\n", widths[w], 100 * worst[w]);
}

static void lengths_do_not_depend_on_slope(void **state)
{
    (void)state;
    for (int w = 1; w <= 3; w++)
        for (int degrees = 0; degrees <= 90; degrees++) {
            double angle = degrees * pi / 180, a[2] = {40.3, 30.6},
                   b[2] = {a[0] + 210 * cos(angle), a[1] + 210 * sin(angle)};
            chain_set set;
            clear_ink();
            draw_line(a, b, w);
            assert_true(chains_trace(&set, ink, SIDE, SIDE, spur));
            if (fabsf(set.chains[0].length - 210) > 210 * 0.015f)
                fail_msg("width %d, %d degrees: %.2f instead of 210 px", w, degrees, (double)set.chains[0].length);
            chains_release(&set);
        }
}

static void circles_have_whole_periods(void **state)
{
    (void)state;
    for (int radius = 11; radius <= 150; radius += 7)
        for (int width = 1; width <= 3; width++) {
            clear_ink();
            draw_circle(radius, width);
            chain_set set = paint((dash_style){8, 5, (float)width});
            if (set.chain_count != 1 || !set.chains[0].closed)
                fail_msg("radius %d, width %d: %zu chains", radius, width, set.chain_count);
            assert_true(fabs((double)set.chains[0].length / (2 * pi * radius) - 1) < 0.04);
            int    turns = 0, steps = 20000;
            double first = -1, last = -1, shortest = 1e9, longest = 0;
            for (int i = 0; i < steps; i++) {
                double t = 2 * pi * i / steps, u = 2 * pi * (i + 1) / steps;
                bool   on = ink_at(SIDE / 2 + radius * cos(t), SIDE / 2 + radius * sin(t)) >= 0.5;
                bool   next = ink_at(SIDE / 2 + radius * cos(u), SIDE / 2 + radius * sin(u)) >= 0.5;
                if (on == next)
                    continue;
                turns++;
                if (on) { /* one dash ends: a period since the last one did */
                    if (last >= 0) {
                        shortest = fmin(shortest, (t - last) * radius);
                        longest = fmax(longest, (t - last) * radius);
                    } else {
                        first = t;
                    }
                    last = t;
                }
            }
            double wrap = (first + 2 * pi - last) * radius, periods = round(2 * pi * radius / 13);
            if (turns != 2 * (int)periods && turns != 2 * (int)periods + 2)
                fail_msg("radius %d, width %d: %d turns", radius, width, turns);
            shortest = fmin(shortest, wrap);
            longest = fmax(longest, wrap);
            if (longest - shortest > 0.25 * 13)
                fail_msg("radius %d, width %d: periods from %.2f to %.2f px", radius, width, shortest, longest);
            chains_release(&set);
        }
}

static void corners_have_ink(void **state)
{
    (void)state;
    for (int width = 1; width <= 3; width++)
        for (int degrees = 0; degrees < 90; degrees += 7) {
            double corners[4][2];
            for (int k = 0; k < 4; k++) {
                double angle = (degrees + 90 * k) * pi / 180;
                corners[k][0] = SIDE / 2 + 103 * cos(angle);
                corners[k][1] = SIDE / 2 + 103 * sin(angle);
            }
            clear_ink();
            for (int k = 0; k < 4; k++)
                draw_line(corners[k], corners[(k + 1) % 4], width);
            chain_set set = paint((dash_style){10, 6, (float)width});
            assert_int_equal(set.chain_count, 4);
            for (size_t i = 0; i < 4; i++) {
                assert_true(set.chains[i].joined[0] && set.chains[i].joined[1]);
                run_list r = runs_along(corners[i], corners[(i + 1) % 4]);
                assert_int_equal(r.count % 2, 1);
                assert_int_equal(r.count / 2, 9); /* 145.7 px in periods of 16 */
                double half = 0.5 * 10 * 145.7 / (9 * 16);
                double first = r.ends[0], last = r.ends[r.count - 1] - r.ends[r.count - 2];
                if (fabs(first - half) > 2 || fabs(last - half) > 2)
                    fail_msg("width %d, %d degrees: %.2f and %.2f px at corners", width, degrees, first, last);
            }
            chains_release(&set);
        }
}

static void neighbours_keep_their_own(void **state)
{
    (void)state;
    static uint8_t alone[2][SIDE];
    double         upper[2][2] = {{20, 50}, {290, 50}}, lower[2][2] = {{31, 53}, {279, 53}};
    for (int k = 0; k < 3; k++) {
        clear_ink();
        if (k != 1)
            draw_line(upper[0], upper[1], 1);
        if (k != 0)
            draw_line(lower[0], lower[1], 1);
        chain_set set = paint((dash_style){8, 5, 1});
        assert_int_equal(set.chain_count, k < 2 ? 1 : 2);
        chains_release(&set);
        if (k < 2)
            memcpy(alone[k], &mask[(50 + 3 * k) * SIDE], SIDE);
    }
    assert_memory_equal(&mask[50 * SIDE], alone[0], SIDE);
    assert_memory_equal(&mask[53 * SIDE], alone[1], SIDE);
    assert_memory_not_equal(alone[0], alone[1], SIDE);
}

static void junctions_have_ink(void **state)
{
    (void)state;
    /* A figure eight: two circles that meet, and a cross. */
    clear_ink();
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            if (fabs(hypot(x - 100, y - 160) - 60) <= 1 || fabs(hypot(x - 219, y - 160) - 60) <= 1)
                ink[y * SIDE + x] = 1;
    chain_set set = paint((dash_style){8, 5, 2});
    assert_true(ink_at(159.5, 160) > 0.9);
    assert_in_range(set.chain_count, 2, 5);
    chains_release(&set);
    for (int degrees = 0; degrees < 90; degrees += 11) {
        clear_ink();
        double angle = degrees * pi / 180, c = 120 * cos(angle), s = 120 * sin(angle);
        draw_line((double[]){160 - c, 160 - s}, (double[]){160 + c, 160 + s}, 2);
        draw_line((double[]){160 - s, 160 + c}, (double[]){160 + s, 160 - c}, 2);
        set = paint((dash_style){8, 5, 2});
        /* The two lines may share a few pixels where they cross. */
        assert_in_range(set.chain_count, 4, 6);
        for (int k = -3; k <= 3; k++)
            assert_true(ink_at(160 + k * c / 120, 160 + k * s / 120) > 0.7);
        assert_true(ink_at(160 + 7 * c / 120, 160 + 7 * s / 120) < 0.6);
        chains_release(&set);
    }
}

static void short_ones_stay_whole(void **state)
{
    (void)state;
    clear_ink();
    draw_line((double[]){50, 50}, (double[]){62, 54}, 2);
    chain_set set = paint((dash_style){12, 4, 2});
    for (size_t i = 0; i < SIDE * SIDE; i++)
        assert_int_equal(mask[i], 255);
    chains_release(&set);
    /* An area is no line. */
    clear_ink();
    for (int y = 50; y < 200; y++)
        memset(&ink[y * SIDE + 40], 1, 120);
    set = paint((dash_style){8, 5, 2});
    for (size_t i = 0; i < SIDE * SIDE; i++)
        assert_int_equal(mask[i], 255);
    chains_release(&set);
}

static void dots_are_dots(void **state)
{
    (void)state;
    double a[2] = {30, 100.5}, b[2] = {290, 100.5};
    clear_ink();
    draw_line(a, b, 2);
    chain_set set = paint((dash_style){1, 10, 8}); /* traced before it grows */
    int       dots = 0;
    for (int x = 60; x < 260; x++)
        dots += ink_at(x, 100.5) >= 0.5 && ink_at(x + 1, 100.5) < 0.5;
    assert_in_range(dots, 10, 12); /* 200 px in periods of 18 */
    /* Round: at the rim of the line they are narrower than in its middle. */
    int middle = 0, rim = 0;
    for (int x = 60; x < 260; x++) {
        middle += mask[100 * SIDE + x] > 127;
        rim += mask[97 * SIDE + x] > 127;
    }
    assert_true(rim > 0 && rim < 0.8 * middle);
    chains_release(&set);
}

static uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* Every thinned pixel is in a chain, and chains go from neighbour to neighbour. */
static void check_chains(const chain_set *set, int width)
{
    for (size_t i = 0; i < set->chain_count; i++) {
        const chain *c = &set->chains[i];
        assert_true(c->count > 0 && c->first + c->count <= set->point_count);
        for (size_t k = 1; k < c->count; k++) {
            const trace_point *p = &set->points[c->first + k], *q = p - 1;
            int                dx = (int)(p->pixel % (uint32_t)width) - (int)(q->pixel % (uint32_t)width);
            int                dy = (int)(p->pixel / (uint32_t)width) - (int)(q->pixel / (uint32_t)width);
            assert_true(abs(dx) <= 1 && abs(dy) <= 1 && (dx || dy));
            assert_true(p->along >= q->along && isfinite(p->x) && isfinite(p->y));
        }
    }
}

static void noise_is_harmless(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (int round = 0; round < 60; round++) {
        int      width = 1 + (int)(next_random(&seed) % 90), height = 1 + (int)(next_random(&seed) % 90);
        uint32_t fraction = next_random(&seed) % 256;
        for (int i = 0; i < width * height; i++)
            ink[i] = next_random(&seed) % 256 < fraction;
        static uint8_t twice[2][SIDE * SIDE];
        for (int k = 0; k < 2; k++) {
            chain_set set;
            assert_true(chains_trace(&set, ink, width, height, spur));
            check_chains(&set, width);
            assert_true(dash_paint(twice[k], width, height, &set, &(dash_style){3, 2, (float)(round % 5)}));
            chains_release(&set);
        }
        assert_memory_equal(twice[0], twice[1], (size_t)(width * height));
    }
}

static void small_pictures(void **state)
{
    (void)state;
    for (int filled = 0; filled < 2; filled++)
        for (int height = 1; height <= 4; height++)
            for (int width = 1; width <= 4; width++) {
                memset(ink, filled, 16);
                chain_set set;
                assert_true(chains_trace(&set, ink, width, height, spur));
                assert_int_equal(set.chain_count > 0, filled);
                assert_true(dash_paint(mask, width, height, &set, &(dash_style){1, 1, 1}));
                chains_release(&set);
            }
}

static void memory_may_run_out(void **state)
{
    (void)state;
    clear_ink();
    draw_circle(60, 2);
    draw_line((double[]){20, 30}, (double[]){200, 190}, 2);
    for (long n = 1;; n++) {
        chain_set set;
        mem_fail_at(n);
        bool traced = chains_trace(&set, ink, SIDE, SIDE, spur);
        bool painted = traced && dash_paint(mask, SIDE, SIDE, &set, &(dash_style){8, 5, 2});
        mem_fail_at(0);
        if (!traced)
            assert_null(set.points);
        chains_release(&set);
        if (painted)
            break;
        assert_true(n < 1000);
    }
}

/* The pass: classes that are not drawn have no dashes, translucent ones do. */
static void maps_are_weighed(void **state)
{
    (void)state;
    enum { W = 80, H = 9 };
    float   values[W * H * 4];
    uint8_t out[W * H];
    for (int channel = 0; channel < 4; channel++)
        for (int mode = 0; mode < 3; mode++) {
            lines_common lines = {.colour = {0, 0, 0, mode == 2 ? 0.1f : 1},
                                  .inner_colour = {.r = NAN},
                                  .id_colour = {.r = NAN},
                                  .width = 2,
                                  .profile_weight = mode != 1,
                                  .inner_weight = mode != 1,
                                  .id_weight = mode != 1,
                                  .dash = 8,
                                  .gap = 5};
            for (int i = 0; i < W * H * 4; i++)
                values[i] = i % 4 == channel && i / 4 / W == 4 ? 0 : 1;
            assert_true(dash_process(&(pass_pixels){.values = {values}, .width = W, .height = H}, out, &lines));
            int open = 0;
            for (int x = 0; x < W; x++)
                open += out[4 * W + x] < 128;
            if (channel == 2 || mode == 1)
                assert_int_equal(open, 0);
            else
                assert_in_range(open, 20, 36);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_of_every_slope),       cmocka_unit_test(lengths_do_not_depend_on_slope),
        cmocka_unit_test(circles_have_whole_periods), cmocka_unit_test(corners_have_ink),
        cmocka_unit_test(neighbours_keep_their_own),  cmocka_unit_test(junctions_have_ink),
        cmocka_unit_test(short_ones_stay_whole),      cmocka_unit_test(dots_are_dots),
        cmocka_unit_test(noise_is_harmless),          cmocka_unit_test(small_pictures),
        cmocka_unit_test(memory_may_run_out),         cmocka_unit_test(maps_are_weighed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
