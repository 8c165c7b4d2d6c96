/* Seed points: the listed values of their sequences, how evenly they lie, and how they leave their positions; row 58
 * (Großmann 2011, section 6.3.2), row 64. And the textures of streaks, row 72. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "motion/seeds.h"
#include "motion/streak_texture.h"

static void values_are_those_listed(void **state)
{
    static const double base2[] = {1 / 2., 1 / 4.,  3 / 4.,  1 / 8.,  5 / 8.,  3 / 8.,
                                   7 / 8., 1 / 16., 9 / 16., 5 / 16., 13 / 16.};
    static const double base3[] = {1 / 3., 2 / 3., 1 / 9., 4 / 9., 7 / 9., 2 / 9., 5 / 9., 8 / 9., 1 / 27.};
    static const double hammersley[4][2] = {{0, 0}, {0.25, 0.5}, {0.5, 0.25}, {0.75, 0.75}};
    double              places[16][3];
    (void)state;
    seeds_place(SEEDS_HALTON, 16, 0, places);
    for (size_t i = 0; i < sizeof base2 / sizeof *base2; i++)
        assert_true(fabs(places[i][0] - base2[i]) < 1e-15);
    for (size_t i = 0; i < sizeof base3 / sizeof *base3; i++)
        assert_true(fabs(places[i][1] - base3[i]) < 1e-15);
    seeds_place(SEEDS_HAMMERSLEY, 4, 0, places);
    for (size_t i = 0; i < 4; i++)
        for (size_t k = 0; k < 2; k++)
            assert_true(fabs(places[i][k] - hammersley[i][k]) < 1e-15);
}

/* The largest empty circle inside the unit square of seeds over [−0.1, 1.1]², on a grid. */
static double largest_gap(seed_sequence sequence, size_t count)
{
    static double places[1024][3];
    double        largest = 0;
    seeds_place(sequence, count, 7, places);
    for (int y = 0; y <= 100; y++)
        for (int x = 0; x <= 100; x++) {
            double nearest = 1;
            for (size_t i = 0; i < count; i++)
                nearest =
                    fmin(nearest, hypot(places[i][0] * 1.2 - 0.1 - x / 100., places[i][1] * 1.2 - 0.1 - y / 100.));
            largest = fmax(largest, nearest);
        }
    return largest;
}

static void gaps_are_in_order(void **state)
{
    (void)state;
    double random = largest_gap(SEEDS_RANDOM, 1000), halton = largest_gap(SEEDS_HALTON, 1000),
           hammersley = largest_gap(SEEDS_HAMMERSLEY, 1024);
    printf("largest gaps: random %.3f, Halton %.3f, Hammersley %.3f\n", random, halton, hammersley);
    assert_true(random > 1.2 * halton && halton > 1.2 * hammersley);
    assert_true(fabs(halton - 0.039) < 0.003 && fabs(hammersley - 0.029) < 0.003);
}

static void seeds_leave_their_positions_as_told(void **state)
{
    double a[2], b[2], together = 0, apart = 0, steps = 0;
    (void)state;
    seed_offset(JITTER_NONE, 3, 1, 5, a);
    assert_true(a[0] == 0 && a[1] == 0);
    for (size_t i = 0; i < 200; i++) {
        seed_offset(JITTER_ALL, i, 1, 5.2, a);
        seed_offset(JITTER_ALL, i + 1, 1, 5.9, b); /* the same tick */
        together += hypot(a[0] - b[0], a[1] - b[1]);
        seed_offset(JITTER_EACH, i, 1, 5, a);
        seed_offset(JITTER_EACH, i + 1, 1, 5, b);
        apart += a[0] * b[0] + a[1] * b[1];
        assert_true(fabs(a[0]) <= 1 && fabs(a[1]) <= 1);
        seed_offset(JITTER_DRIFT, i, 1, 5, a);
        seed_offset(JITTER_DRIFT, i, 1, 5.05, b);
        steps = fmax(steps, hypot(a[0] - b[0], a[1] - b[1]));
        assert_true(fabs(a[0]) <= 1 && fabs(a[1]) <= 1);
    }
    seed_offset(JITTER_ALL, 0, 1, 5, a);
    seed_offset(JITTER_ALL, 0, 1, 6, b);
    assert_true(together == 0 && hypot(a[0] - b[0], a[1] - b[1]) > 0.01);
    assert_true(fabs(apart / 200) < 0.15); /* neighbours have nothing in common: the mean product of 1/3 + 1/3 would be
                                              0.67 */
    assert_true(steps > 0 && steps < 0.08);
}

/* Lightness and opacity at a place of the finest level. */
static void texel_of(const mip_chain *c, double u, double v, double out[2])
{
    const uint8_t *t =
        (const uint8_t *)mip_layer(c, 0, 0) + 2 * ((int)(v * c->height) * c->width + (int)(u * c->width));
    out[0] = t[0] / 255.;
    out[1] = t[1] / 255.;
}

static void textures_are_as_named(void **state)
{
    static const char *const names[] = {"solid",        "clear",        "gradient",
                                        "solid-border", "clear-border", "gradient-border"};
    lmn_error                error = {0};
    (void)state;
    for (int i = 0; i < 6; i++) {
        mip_chain c;
        double    head[2], tail[2], rim[2], outside[2];
        assert_int_equal(streak_texture_check(names[i], &error), LMN_OK);
        assert_int_equal(streak_texture_make(&c, names[i], &error), LMN_OK);
        texel_of(&c, 0.8, 0.5, head);
        texel_of(&c, 0.2, 0.5, tail);
        texel_of(&c, 0.6, 0.1, rim);
        texel_of(&c, 0.99, 0.05, outside); /* beside the round head */
        assert_true(outside[1] == 0);
        assert_true(head[0] == 1 && tail[0] == 1);
        assert_true(i % 3 == 0   ? head[1] == 1 && tail[1] == 1
                    : i % 3 == 1 ? head[1] < 0.6 && head[1] == tail[1]
                                 : head[1] > tail[1] + 0.5);
        assert_true(i < 3 ? rim[0] == 1 : rim[0] < 0.4 && rim[1] > (i % 3 == 1 ? 0.9 : 0.3));
        mip_chain_release(&c);
    }
    assert_int_equal(streak_texture_check("grdient", &error), LMN_USAGE);
    assert_int_equal(streak_texture_check("brush.png", &error), LMN_OK);
    mip_chain none;
    assert_int_not_equal(streak_texture_make(&none, "/nowhere/brush.png", &error), LMN_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(values_are_those_listed), cmocka_unit_test(gaps_are_in_order),
                                       cmocka_unit_test(seeds_leave_their_positions_as_told),
                                       cmocka_unit_test(textures_are_as_named)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
