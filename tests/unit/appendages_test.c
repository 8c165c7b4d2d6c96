/* What of a shadow hangs on it by a thin neck goes, and nothing else changes. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "light/appendages.h"

enum { WIDTH = 240, HEIGHT = 160 };
static const double RADIUS = 12;

typedef struct shadow {
    uint8_t texels[4 * WIDTH * HEIGHT];
} shadow;

static void fill(shadow *s, int x0, int y0, int x1, int y1)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            s->texels[4 * (y * WIDTH + x)] = 255;
}

static void fill_leaf(shadow *s, double x0, double y0)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            if (hypot((x - x0) / 20, (y - y0) / 9) < 1)
                s->texels[4 * (y * WIDTH + x)] = 255;
}

/* With a thin corner, a wedge and an arm. */
static void fill_body(shadow *s)
{
    fill(s, 20, 40, 120, 140);
    fill(s, 120, 120, 200, 130); /* an arm */
    fill(s, 20, 20, 24, 40);     /* a thin one, which ends in nothing */
    for (int k = 0; k < 30; k++)
        fill(s, 60 + k, 40 - k / 2, 61 + k, 40);
}

static void test_leaves_go(void **state)
{
    (void)state;
    shadow with = {{0}}, without = {{0}};
    fill_body(&with);
    fill_body(&without);
    fill_leaf(&with, 160, 80);
    fill(&with, 118, 79, 145, 82);
    assert_true(appendages_cut(with.texels, WIDTH, HEIGHT, RADIUS));
    int differ = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        differ += with.texels[4 * i] != without.texels[4 * i];
    assert_in_range(differ, 0, 12); /* where the neck was */
    shadow body = without;
    assert_true(appendages_cut(without.texels, WIDTH, HEIGHT, RADIUS));
    assert_memory_equal(body.texels, without.texels, sizeof body.texels);
}

/* On a broad neck, near what throws it, at the border, large, or by itself. */
static void test_others_stay(void **state)
{
    (void)state;
    for (int k = 0; k < 5; k++) {
        shadow s = {{0}}, before;
        fill_body(&s);
        fill_leaf(&s, k == 2 ? 230 : 160, 80);
        if (k == 3)
            fill(&s, 145, 55, 235, 110);
        if (k < 4)
            fill(&s, 118, k ? 79 : 75, k == 2 ? 215 : 150, k ? 82 : 86);
        if (k == 1)
            s.texels[4 * (80 * WIDTH + 160) + 1] = 255;
        before = s;
        assert_true(appendages_cut(s.texels, WIDTH, HEIGHT, RADIUS));
        if (memcmp(before.texels, s.texels, sizeof s.texels))
            fail_msg("case %d changed", k);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_leaves_go), cmocka_unit_test(test_others_stay)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
