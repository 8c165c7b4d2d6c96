/* Lines that run on, found in arrays whose lines are known: where, how far, in which direction. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "lines/lines.h"
#include "lines/overshoot.h"

enum { SIDE = 320 };

static const double pi = 3.14159265358979323846;

static float    edges[SIDE * SIDE * 4], surfaces[SIDE * SIDE * 4];
static uint8_t  ink[SIDE * SIDE];
static uint32_t words[SIDE * SIDE * 2];

static void clear(void)
{
    for (int i = 0; i < SIDE * SIDE * 4; i++)
        edges[i] = 1;
}

static double segment_distance(double x, double y, const double a[2], const double b[2])
{
    double dx = b[0] - a[0], dy = b[1] - a[1], t = ((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy);
    t = fmax(0, fmin(1, t));
    return hypot(x - a[0] - t * dx, y - a[1] - t * dy);
}

/* A line as a rasteriser draws it, in a channel of the edge map: of width 1 one pixel a column or row. */
static void draw_line(const double a[2], const double b[2], double width, int channel)
{
    double dx = b[0] - a[0], dy = b[1] - a[1], size = hypot(dx, dy);
    double half = width <= 1 ? 0.5 * fmax(fabs(dx), fabs(dy)) / size - 1e-6 : 0.5 * width;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            if (segment_distance(x, y, a, b) <= half)
                edges[4 * (y * SIDE + x) + channel] = 0;
}

/* Closes a corner that thin lines leave open. */
static void draw_dot(const double at[2])
{
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            if (hypot(x - at[0], y - at[1]) <= 0.9)
                edges[4 * (y * SIDE + x)] = 0;
}

static void draw_circle(double cx, double cy, double radius, double width)
{
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            if (fabs(hypot(x - cx, y - cy) - radius) <= 0.5 * width)
                edges[4 * (y * SIDE + x)] = 0;
}

static lines_common lines_of(float width, float length)
{
    return (lines_common){.colour = {0, 0, 0, 1},
                          .inner_colour = {.r = NAN},
                          .id_colour = {.r = NAN},
                          .width = width,
                          .profile_weight = 1,
                          .inner_weight = 1,
                          .id_weight = 1,
                          .overshoot = length};
}

static pass_pixels input(bool with_surfaces)
{
    return (pass_pixels){
        .values = {edges, with_surfaces ? surfaces : NULL}, .width = SIDE, .height = SIDE, .pixel = 1, .scale = 1};
}

static extension_set find(float width, float length, bool with_surfaces)
{
    extension_set extensions;
    chain_set     chains;
    lines_common  lines = lines_of(width, length);
    pass_pixels   in = input(with_surfaces);
    lines_find_ink(ink, edges, SIDE * SIDE, &lines);
    assert_true(chains_trace(&chains, ink, SIDE, SIDE, LINES_SPUR));
    assert_true(overshoot_find(&extensions, &chains, &in, ink, &(overshoot_style){length, width, 4, 0.75f}));
    chains_release(&chains);
    return extensions;
}

static double degrees_between(double ax, double ay, double bx, double by)
{
    return fabs(atan2(ax * by - ay * bx, ax * bx + ay * by)) * 180 / pi;
}

/* The extension that goes on where the line from `from` to `to` ends; NULL when there is none. */
static const extension *stroke_of(const extension_set *set, const double from[2], const double to[2])
{
    for (size_t i = 0; i < set->count; i++) {
        const extension *s = &set->extensions[i];
        if (hypot((double)s->x - to[0], (double)s->y - to[1]) < 5 &&
            degrees_between((double)s->dx, (double)s->dy, to[0] - from[0], to[1] - from[1]) < 20)
            return s;
    }
    return NULL;
}

typedef struct worst {
    double position, degrees;
} worst;

/* The line runs on from its end, about as far as was asked for, in its own direction. */
static void judge(const extension_set *set, const double from[2], const double to[2], double length, worst *w,
                  const char *what)
{
    const extension *s = stroke_of(set, from, to);
    if (!s) {
        fail_msg("%s: no extension at %.0f, %.0f", what, to[0], to[1]);
        return;
    }
    double size = hypot(to[0] - from[0], to[1] - from[1]), ux = (to[0] - from[0]) / size, uy = (to[1] - from[1]) / size;
    double wanted = fmin(length, 0.4 * size), off = fabs(((double)s->x - to[0]) * uy - ((double)s->y - to[1]) * ux);
    double turn = degrees_between((double)s->dx, (double)s->dy, ux, uy),
           ends = ((double)s->x - to[0]) * ux + ((double)s->y - to[1]) * uy;
    w->position = fmax(w->position, fmax(off, fabs(ends)));
    w->degrees = fmax(w->degrees, turn);
    if (off > 1 || fabs(ends) > 4 || turn > 3)
        fail_msg("%s: %.2f px beside, %.2f px beyond the corner, %.2f degrees off", what, off, ends, turn);
    if ((double)s->length < 0.6 * wanted || (double)s->length > 1.31 * fmin(length, 0.31 * size + 4) + 1)
        fail_msg("%s: %.2f px long instead of %.2f", what, (double)s->length, wanted);
}

static void squares_of_every_slope(void **state)
{
    (void)state;
    worst w = {0};
    for (int width = 1; width <= 2; width++)
        for (int degrees = 0; degrees < 90; degrees++)
            for (int size = 28; size <= 124; size += 16) {
                double corners[4][2];
                char   what[64];
                for (int k = 0; k < 4; k++) {
                    double angle = (degrees + 90 * k) * pi / 180;
                    corners[k][0] = SIDE / 2 + size / sqrt(2) * cos(angle);
                    corners[k][1] = SIDE / 2 + size / sqrt(2) * sin(angle);
                }
                snprintf(what, sizeof what, "width %d, %d degrees, side %d", width, degrees, size);
                clear();
                for (int k = 0; k < 4; k++) {
                    draw_line(corners[k], corners[(k + 1) % 4], width, 0);
                    draw_dot(corners[k]);
                }
                extension_set set = find((float)width, 14, false);
                if (set.count != 8)
                    fail_msg("%s: %zu extensions instead of 8", what, set.count);
                for (int k = 0; k < 4; k++) {
                    judge(&set, corners[k], corners[(k + 1) % 4], 14, &w, what);
                    judge(&set, corners[(k + 1) % 4], corners[k], 14, &w, what);
                }
                overshoot_release(&set);
            }
    print_message("corners at most %.2f px, directions %.2f degrees off\n", w.position, w.degrees);
}

static void legs_and_stems(void **state)
{
    (void)state;
    worst w = {0};
    for (int degrees = 0; degrees < 360; degrees += 7) {
        double angle = degrees * pi / 180, c = cos(angle), s = sin(angle), middle[2] = {SIDE / 2, SIDE / 2};
        double one[2] = {middle[0] + 100 * c, middle[1] + 100 * s}, two[2] = {middle[0] - 80 * s, middle[1] + 80 * c};
        double other[2] = {middle[0] - 100 * c, middle[1] - 100 * s};
        clear(); /* an L: two extensions at its corner, none where it just ends */
        draw_line(middle, one, 2, 0);
        draw_line(middle, two, 2, 0);
        extension_set set = find(2, 20, false);
        assert_int_equal(set.count, 2);
        judge(&set, one, middle, 20, &w, "L");
        judge(&set, two, middle, 20, &w, "L");
        overshoot_release(&set);
        draw_line(middle, other, 2, 0); /* a T: the stem alone, since the bar goes on */
        set = find(2, 20, false);
        assert_int_equal(set.count, 1);
        judge(&set, two, middle, 20, &w, "T");
        overshoot_release(&set);
    }
}

static void curves_and_bends_do_not(void **state)
{
    (void)state;
    for (int radius = 12; radius <= 150; radius += 6) {
        clear();
        draw_circle(SIDE / 2, SIDE / 2, radius, 2);
        extension_set set = find(2, 14, false);
        if (set.count)
            fail_msg("radius %d: %zu extensions", radius, set.count);
        overshoot_release(&set);
    }
    clear(); /* two circles that cross: their arcs have ends */
    draw_circle(130, 160, 70, 2);
    draw_circle(190, 160, 70, 2);
    extension_set set = find(2, 14, false);
    assert_int_equal(set.count, 0);
    overshoot_release(&set);
    for (int bend = 4; bend <= 20; bend += 4) { /* a line that bends a little */
        double a[2] = {40, 150}, b[2] = {160, 150},
               d[2] = {160 + 120 * cos(bend * pi / 180), 150 + 120 * sin(bend * pi / 180)};
        clear();
        draw_line(a, b, 2, 0);
        draw_line(b, d, 2, 0);
        set = find(2, 14, false);
        if (set.count)
            fail_msg("bend of %d degrees: %zu extensions", bend, set.count);
        overshoot_release(&set);
    }
}

/* A line that an arc touches runs on from where the two part. */
static void tangents(void **state)
{
    (void)state;
    for (int radius = 12; radius <= 48; radius += 6) {
        clear(); /* a slot's end: two sides and half a circle */
        draw_line((double[]){160 - radius, 300}, (double[]){160 - radius, 120}, 2, 0);
        draw_line((double[]){160 + radius, 300}, (double[]){160 + radius, 120}, 2, 0);
        for (int y = 0; y <= 120; y++)
            for (int x = 0; x < SIDE; x++)
                if (fabs(hypot(x - 160, y - 120) - radius) <= 1)
                    edges[4 * (y * SIDE + x)] = 0;
        extension_set set = find(2, 14, false);
        if (set.count != 2)
            fail_msg("radius %d: %zu extensions", radius, set.count);
        for (size_t i = 0; i < set.count; i++) {
            const extension *s = &set.extensions[i];
            assert_true(degrees_between((double)s->dx, (double)s->dy, 0, -1) < 3);
            assert_true(fabs(fabs((double)s->x - 160) - radius) < 1 && fabsf(s->y - 120) < 16);
            assert_true(s->start > 0 && s->length - s->start > 9 && s->length - s->start < 19);
        }
        overshoot_release(&set);
    }
}

static void short_lines_less(void **state)
{
    (void)state;
    for (int size = 6; size <= 60; size += 2) {
        double tick[2] = {160, 150 + size}, foot[2] = {160, 150};
        clear(); /* a tick on a long line */
        draw_line((double[]){40, 150}, (double[]){280, 150}, 2, 0);
        draw_line(foot, tick, 2, 0);
        extension_set set = find(2, 24, false);
        if (size < 14)
            assert_int_equal(set.count, 0);
        else if (size > 24)
            assert_int_equal(set.count, 1);
        for (size_t i = 0; i < set.count; i++)
            assert_true(set.extensions[i].length <= 0.4f * (float)(size + 2));
        overshoot_release(&set);
    }
}

/* Classes and strength are the line's; what is painted lies on its continuation. */
static void paints_the_class(void **state)
{
    (void)state;
    static const int channels[3] = {0, 1, 3};
    lines_common     lines = lines_of(2, 20);
    for (int k = 0; k < 3; k++) {
        clear();
        draw_line((double[]){60, 100}, (double[]){160, 100}, 2, channels[k]);
        draw_line((double[]){160, 100}, (double[]){160, 220}, 2, channels[(k + 1) % 3]);
        memset(words, 0, sizeof words);
        pass_pixels in = input(false);
        assert_true(overshoot_process(&in, words, &lines));
        uint32_t beyond = words[2 * (100 * SIDE + 166)], below = words[2 * (94 * SIDE + 160)];
        assert_in_range(beyond >> 8 * k & 255, 200, 255);
        assert_int_equal(beyond & ~(255u << 8 * k), 0);
        assert_in_range(below >> 8 * ((k + 1) % 3) & 255, 200, 255);
        int inked = 0;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                if (words[2 * (y * SIDE + x)]) {
                    inked++;
                    assert_true(segment_distance(x, y, (double[]){155, 100}, (double[]){187, 100}) < 2 ||
                                segment_distance(x, y, (double[]){160, 105}, (double[]){160, 73}) < 2);
                }
        assert_in_range(inked, 60, 180);
    }
}

/* A line that ends behind a surface stays behind it; one that comes to the front does not. Beyond, it has the depth
 * that it has in space. */
static void goes_on_in_space(void **state)
{
    (void)state;
    for (int perspective = 0; perspective < 2; perspective++)
        for (int hidden = 0; hidden < 2; hidden++) {
            clear();
            draw_line((double[]){60, 150}, (double[]){160, 150}, 2, 1);
            draw_line((double[]){160, 40}, (double[]){160, 280}, 2, 0);
            for (int y = 0; y < SIDE; y++)
                for (int x = 0; x < SIDE; x++) {
                    float behind = perspective ? 1 / (0.002f + 0.000005f * (float)x) : 400 - 0.5f * (float)x;
                    surfaces[4 * (y * SIDE + x) + 3] = x <= 160 ? behind : hidden ? 100 : 5000;
                }
            pass_pixels in = input(true);
            in.perspective = perspective;
            in.pixel = perspective ? 0.002f : 1;
            memset(words, 0, sizeof words);
            lines_common lines = lines_of(2, 20);
            assert_true(overshoot_process(&in, words, &lines));
            uint32_t *at = &words[2 * (150 * SIDE + 170)];
            assert_int_equal((at[0] >> 8 & 255) > 100, !hidden);
            if (!hidden) {
                float depth, wanted = perspective ? 1 / (0.002f + 0.000005f * 170) : 400 - 0.5f * 170;
                memcpy(&depth, &at[1], sizeof depth);
                if (fabsf(depth - wanted) > 0.01f * wanted)
                    fail_msg("depth %.2f instead of %.2f", (double)depth, (double)wanted);
            }
        }
}

/* Lines of others' surfaces do not run on; and depths that other techniques wrote stay. */
static void leaves_others_alone(void **state)
{
    (void)state;
    static uint8_t own[SIDE * SIDE];
    lines_common   lines = lines_of(2, 20);
    clear();
    draw_line((double[]){60, 100}, (double[]){160, 100}, 2, 0);
    draw_line((double[]){160, 100}, (double[]){160, 220}, 2, 0);
    for (int all = 0; all < 2; all++) {
        pass_pixels in = input(false);
        in.own = own;
        memset(own, all, sizeof own);
        for (int i = 0; i < SIDE * SIDE * 2; i++)
            words[i] = 7;
        assert_true(overshoot_process(&in, words, &lines));
        int inked = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            inked += words[2 * i] != 0;
            assert_int_equal(words[2 * i + 1], 7);
        }
        assert_int_equal(inked > 0, all);
    }
}

/* Ink beside an extension is in its way within a pixel of it and no farther, on whichever side of whichever line. */
static void near_ink_is_in_the_way(void **state)
{
    (void)state;
    static const double ways[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int k = 0; k < 4; k++)
        for (int beside = -3; beside <= 3; beside++) {
            const double ux = ways[k][0], uy = ways[k][1],
                         corner[2] = {160 + 40 * ux - 40 * uy, 160 + 40 * uy + 40 * ux};
            const double from[2] = {corner[0] - 80 * ux, corner[1] - 80 * uy};
            const double others[2][2] = {{from[0] + 80 * uy, from[1] - 80 * ux},
                                         {corner[0] + 80 * uy, corner[1] - 80 * ux}};
            const double near[2] = {corner[0] + 12 * ux - beside * uy, corner[1] + 12 * uy + beside * ux},
                         far[2] = {near[0] + 40 * ux, near[1] + 40 * uy};
            clear();
            draw_line(from, corner, 1, 0);
            draw_line(corner, others[1], 1, 0);
            draw_line(others[1], others[0], 1, 0);
            draw_line(others[0], from, 1, 0);
            draw_line(near, far, 1, 0);
            extension_set set = find(1, 24, false);
            bool          there = stroke_of(&set, from, corner) != NULL;
            if (abs(beside) >= 2 && !there)
                fail_msg("way %d: ink %d px beside it is in the way of an extension", k, beside);
            if (abs(beside) <= 1 && there)
                fail_msg("way %d: an extension lies on ink that is %d px beside it", k, beside);
            overshoot_release(&set);
        }
}

static uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static void noise_is_harmless(void **state)
{
    (void)state;
    uint32_t seed = 3;
    for (int round = 0; round < 60; round++) {
        int         width = 1 + (int)(next_random(&seed) % 90), height = 1 + (int)(next_random(&seed) % 90);
        uint32_t    fraction = next_random(&seed) % 256;
        pass_pixels in = {.values = {edges, surfaces},
                          .width = width,
                          .height = height,
                          .pixel = 0.01f,
                          .scale = 1,
                          .perspective = round % 2};
        for (int i = 0; i < width * height * 4; i++) {
            edges[i] = next_random(&seed) % 256 < fraction ? 0 : 1;
            surfaces[i] = (float)(next_random(&seed) % 5);
        }
        lines_common    lines = lines_of(1 + (float)(round % 4), 64);
        static uint32_t twice[2][90 * 90 * 2];
        for (int k = 0; k < 2; k++) {
            memset(twice[k], 0, sizeof twice[k]);
            assert_true(overshoot_process(&in, twice[k], &lines));
        }
        assert_memory_equal(twice[0], twice[1], sizeof twice[0]);
    }
}

static void memory_may_run_out(void **state)
{
    (void)state;
    lines_common lines = lines_of(2, 20);
    clear();
    draw_line((double[]){60, 100}, (double[]){160, 100}, 2, 0);
    draw_line((double[]){160, 100}, (double[]){160, 220}, 2, 0);
    pass_pixels in = input(false);
    for (long n = 1;; n++) {
        mem_fail_at(n);
        bool done = overshoot_process(&in, words, &lines);
        mem_fail_at(0);
        if (done)
            break;
        assert_true(n < 1000);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(squares_of_every_slope),  cmocka_unit_test(legs_and_stems),
        cmocka_unit_test(curves_and_bends_do_not), cmocka_unit_test(tangents),
        cmocka_unit_test(short_lines_less),        cmocka_unit_test(paints_the_class),
        cmocka_unit_test(goes_on_in_space),        cmocka_unit_test(leaves_others_alone),
        cmocka_unit_test(near_ink_is_in_the_way),  cmocka_unit_test(noise_is_harmless),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
