/* What perturbations say of their parameters before anything is drawn: whether they move anything, how far at most, on
 * how fine a grid, and by which seed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "halftone/graphite.h"
#include "perturb/perturb.h"

static const char *const degrees[] = {"edges_xx",  "edges_xy",  "edges_yx",  "edges_yy",
                                      "shades_xx", "shades_xy", "shades_yx", "shades_yy"};
enum { DEGREES = 8 };

static void *values_of(const technique *t)
{
    void *values = mem_calloc(1, t->params_size);
    assert_non_null(values);
    params_set_defaults(t->params, t->param_count, values);
    return values;
}

static void set(const technique *t, void *values, const char *name, const char *text)
{
    for (size_t i = 0; i < t->param_count; i++)
        if (strcmp(t->params[i].key, name) == 0) {
            assert_int_equal(param_set_text(&t->params[i], values, text, NULL), LMN_OK);
            return;
        }
    fail_msg("no parameter %s", name);
}

/* Nothing moves: no degree at all. */
static void *still_values(void)
{
    void *values = values_of(&perturb_uncertainty);
    for (int k = 0; k < DEGREES; k++)
        set(&perturb_uncertainty, values, degrees[k], "0");
    return values;
}

/* Each of what moves or thins anything suffices, and without all of them, or with an amount of 0, nothing is to be
 * done. */
static void test_each_makes_active(void **state)
{
    (void)state;
    const perturbation *p = perturb_uncertainty.perturbs;
    void               *values = still_values();
    assert_false(p->active(values));
    for (int k = 0; k < DEGREES; k++) {
        set(&perturb_uncertainty, values, degrees[k], "-0.5");
        assert_true(p->active(values));
        set(&perturb_uncertainty, values, "amount", "0");
        assert_false(p->active(values));
        set(&perturb_uncertainty, values, "amount", "3");
        set(&perturb_uncertainty, values, degrees[k], "0");
    }
    static const char *const others[] = {"rough", "tooth", "pressure"};
    for (int k = 0; k < 3; k++) {
        set(&perturb_uncertainty, values, others[k], "0.5");
        assert_true(p->active(values));
        set(&perturb_uncertainty, values, others[k], "0");
    }
    assert_false(p->active(values));
    mem_free(values);
}

/* The reach is the farthest along either axis that any noise of −1 … 1 can move anything, for lines and for fill, and
 * what grains add. */
static void test_reach_is_farthest(void **state)
{
    (void)state;
    static const char *const rows[][DEGREES] = {{"1", "0", "0", "1", "-0.75", "0", "0", "-0.75"},
                                                {"0.25", "-1.5", "0.5", "0.75", "0", "0", "0", "0"},
                                                {"0.25", "0.5", "-1", "-2", "1", "0", "0", "0"},
                                                {"0", "0", "0", "0", "-1.25", "2", "0.5", "0"},
                                                {"0.5", "0", "0", "0", "0", "0.25", "3", "-1.5"}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        void *values = still_values();
        set(&perturb_uncertainty, values, "amount", "4");
        set(&perturb_uncertainty, values, "rough", "1.5");
        double farthest = 0;
        for (int k = 0; k < DEGREES; k++)
            set(&perturb_uncertainty, values, degrees[k], rows[r][k]);
        for (int k = 0; k < DEGREES; k += 2)
            for (int corner = 0; corner < 4; corner++)
                farthest = fmax(farthest, fabs(atof(rows[r][k]) * (corner & 1 ? 1 : -1) +
                                               atof(rows[r][k + 1]) * (corner & 2 ? 1 : -1)));
        assert_float_equal(perturb_uncertainty.perturbs->reach(values), (float)(4 * farthest + 1.5), 1e-5f);
        mem_free(values);
    }
}

/* Repetitions are turned: noise whose two components are both 1 is then up to √2 long along one axis, and each
 * repetition goes farther by its degree. */
static void test_reach_of_repetitions(void **state)
{
    (void)state;
    void *values = still_values();
    set(&perturb_uncertainty, values, "amount", "4");
    set(&perturb_uncertainty, values, "edges_xx", "1");
    set(&perturb_uncertainty, values, "edges_yy", "1");
    set(&perturb_uncertainty, values, "repeat", "3");
    set(&perturb_uncertainty, values, "repeat_degree", "1.5");
    assert_float_equal(perturb_uncertainty.perturbs->reach(values), 4 * 1.4142136f * 1.5f * 1.5f, 1e-4f);
    set(&perturb_uncertainty, values, "repeat_degree", "0.5"); /* the first one has gone all the way */
    assert_float_equal(perturb_uncertainty.perturbs->reach(values), 4 * 1.4142136f, 1e-4f);
    mem_free(values);
}

/* Grids are never finer than pixels, coarse for long waves and far moves, and a tile has a whole number of cells. */
static void test_cells(void **state)
{
    (void)state;
    const perturbation *p = perturb_uncertainty.perturbs;
    void               *values = still_values();
    set(&perturb_uncertainty, values, "scale", "15");
    assert_float_equal(p->cell(values), 1, 0);
    set(&perturb_uncertainty, values, "scale", "87");
    assert_float_equal(p->cell(values), 3, 1e-5);
    set(&perturb_uncertainty, values, "edges_xx", "1");
    set(&perturb_uncertainty, values, "amount", "42");
    assert_float_equal(p->cell(values), 6, 1e-5);
    set(&perturb_uncertainty, values, "tile", "100"); /* of the model's own wobble there is no tile */
    assert_float_equal(p->cell(values), 6, 1e-5);
    set(&perturb_uncertainty, values, "lock", "screen");
    assert_float_equal(p->cell(values), 100 / 17.0f, 1e-5f);
    mem_free(values);
}

/* Seeds add up; what boils has one seed a step, new from the step's beginning on, whose time may have been rounded. */
static void test_seeds(void **state)
{
    (void)state;
    const technique *const both[] = {&perturb_uncertainty, &perturb_pencil};
    for (int k = 0; k < 2; k++) {
        const perturbation *p = both[k]->perturbs;
        void               *values = values_of(both[k]);
        uint32_t            seven = p->seed(values, 7, 0);
        assert_int_not_equal(seven, p->seed(values, 6, 0));
        assert_int_equal(seven, p->seed(values, 7, 3.3));
        set(both[k], values, "seed", "4");
        assert_int_equal(seven, p->seed(values, 3, 0));
        mem_free(values);
    }
    const perturbation *p = perturb_uncertainty.perturbs;
    void               *values = values_of(&perturb_uncertainty);
    set(&perturb_uncertainty, values, "boil", "12");
    assert_int_equal(p->seed(values, 7, 0.001), p->seed(values, 7, 0.083));
    assert_int_equal(p->seed(values, 7, 0.083333), p->seed(values, 7, 0.16));
    assert_int_not_equal(p->seed(values, 7, 0.083), p->seed(values, 7, 0.083333));
    mem_free(values);
}

/* A pencil's lines go as far as they sway and jitter, those groups of them that there are, or as far as the fill
 * overruns. */
static void test_pencil(void **state)
{
    (void)state;
    const perturbation *p = perturb_pencil.perturbs;
    void               *values = values_of(&perturb_pencil);
    set(&perturb_pencil, values, "dark_sway", "5");
    set(&perturb_pencil, values, "light_sway", "9");
    set(&perturb_pencil, values, "jitter", "2");
    assert_float_equal(p->reach(values), 11, 1e-5);
    set(&perturb_pencil, values, "light", "0");
    assert_float_equal(p->reach(values), 7, 1e-5);
    assert_true(p->active(values));
    set(&perturb_pencil, values, "overrun", "8");
    assert_float_equal(p->reach(values), 8, 1e-5);
    set(&perturb_pencil, values, "dark", "0");
    assert_false(p->active(values));
    set(&perturb_pencil, values, "light", "1");
    set(&perturb_pencil, values, "overrun", "0");
    assert_true(p->active(values));
    assert_float_equal(p->reach(values), 11, 1e-5);
    mem_free(values);
}

/* How much a channel of the grain differs from texel to texel along an axis, where it repeats too, in the mean. */
static double roughness(const mip_chain *grain, int channel, int right, int up)
{
    const int      side = mip_width(grain, 0), channels = (int)mip_texel_size(grain->format);
    const uint8_t *texels = grain->data[0];
    double         sum = 0;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            int there = (y + up) % side * side + (x + right) % side;
            sum += abs(texels[(y * side + x) * channels + channel] - texels[there * channels + channel]);
        }
    return sum / (side * side);
}

/* The clouds by which graphite is paler here and there are as smooth to the right as up, over the borders of the square
 * as well, and not the same everywhere. */
static void test_graphite_is_cloudy(void **state)
{
    (void)state;
    mip_chain grain;
    assert_int_equal(graphite_grain(&grain, 1, NULL), LMN_OK);
    double right = roughness(&grain, 0, 1, 0), up = roughness(&grain, 0, 0, 1), far = roughness(&grain, 0, 37, 41);
    print_message("clouds of graphite: neighbours differ by %.2f to the right, %.2f upwards; far ones by %.1f\n", right,
                  up, far);
    assert_true(fabs(right - up) < 0.2 * right);
    assert_true(far > 4 * right);
    const int side = mip_width(&grain, 0), channels = (int)mip_texel_size(grain.format);
    double    over = 0;
    for (int i = 0; i < side; i++)
        over += fabs((double)((uint8_t *)grain.data[0])[i * channels] -
                     ((uint8_t *)grain.data[0])[((side - 1) * side + i) * channels]) /
                side;
    assert_true(over < 2 * up);
    mip_chain_release(&grain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_makes_active),
        cmocka_unit_test(test_reach_is_farthest),
        cmocka_unit_test(test_reach_of_repetitions),
        cmocka_unit_test(test_cells),
        cmocka_unit_test(test_seeds),
        cmocka_unit_test(test_pencil),
        cmocka_unit_test(test_graphite_is_cloudy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
