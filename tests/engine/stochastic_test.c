/* The motion technique `stochastic` against the share of time that a bar covers pixels, and against pictures of many
 * times; row 39 of Großmann 2011 (section 4.3). */
#include "checked.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../support/moving_scene.h"

enum { SIDE = 240, PIXELS = SIDE * SIDE };

static lmn_renderer *renderer;

static int set_up(void **state)
{
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    moving_scene      m;
    const double      half[3] = {0.1, 0.8, 0.1}, black[3] = {0, 0, 0};
    (void)state;
    DO(lmn_renderer_create(&renderer, &desc, &error));
    /* A bar 24 pixels wide that comes 96 pixels to the right. */
    moving_scene_begin(&m);
    int bar = moving_scene_box(&m, 0, 0, 0, half, black);
    moving_scene_keys(&m, bar, "translation", 2, (double[]){1, 2}, (double[]){-0.4, 0, 0, 0.4, 0, 0});
    moving_scene_camera(&m, 0, 0, 10, true, 1);
    moving_scene_write(&m, "stochastic_bar.glb");
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    lmn_renderer_destroy(&renderer);
    return 0;
}

/* How dark each pixel is, 0 to 1, and on the mean each column within the bar. */
static void draw(const char *motion, uint32_t seed, double *pixels, double columns[SIDE])
{
    char          json[512];
    lmn_scene    *s = NULL;
    lmn_look     *look = NULL;
    lmn_drawing  *d = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_file(s, "stochastic_bar.glb", NULL, &error));
    snprintf(json, sizeof json,
             "{\"version\": 1, \"rules\": [{\"surface\": \"lit\", \"motion\": {\"exposure\": 1, %s}}]}", motion);
    DO(lmn_look_parse(&look, json, "test", &error));
    desc.width = desc.height = SIDE;
    desc.dpi = 96;
    desc.camera = "eye";
    desc.time_given = true;
    desc.time_s = 2;
    desc.seed = seed;
    DO(lmn_draw(&d, renderer, s, look, &desc, &error));
    const uint8_t *bytes = lmn_drawing_pixels(d, NULL, NULL);
    memset(columns, 0, SIDE * sizeof *columns);
    for (int i = 0; i < PIXELS; i++) {
        pixels[i] = 1 - bytes[4 * i] / 255.0;
        if (i / SIDE >= SIDE / 4 && i / SIDE < 3 * SIDE / 4)
            columns[i % SIDE] += pixels[i] / (SIDE / 2);
    }
    lmn_drawing_destroy(&d);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&s);
}

/* The share of the exposure in which the bar covers a column's middle. */
static double share_of(int column)
{
    double x = (column + 0.5) / (SIDE / 2.) - 1, from = fmax(x - 0.1, -0.4), to = fmin(x + 0.1, 0.4);
    return fmax(to - from, 0) / 0.8;
}

static double worst_of(const double columns[SIDE])
{
    double worst = 0;
    for (int x = 0; x < SIDE; x++)
        worst = fmax(worst, fabs(columns[x] - share_of(x)));
    return worst;
}

/* With four samples columns have on the mean the bar's share, ±3 times what chance does; the mean of four pictures has
 * steps of a quarter: ghosts. */
static void four_samples_leave_no_ghosts(void **state)
{
    static double pixels[PIXELS], columns[SIDE];
    (void)state;
    draw("\"technique\": \"stochastic\", \"samples\": 4", 1, pixels, columns);
    double grain = worst_of(columns);
    draw("\"technique\": \"accumulate\", \"times\": 4", 1, pixels, columns);
    double ghosts = worst_of(columns);
    printf("columns are off by %.3f at most; of the mean of four pictures by %.3f\n", grain, ghosts);
    assert_true(grain < 0.06);
    assert_true(ghosts > 0.2);
}

/* The mean of pictures of many seeds is that of many times, pixel by pixel; single ones are grainy. */
static void it_is_unbiased(void **state)
{
    enum { SEEDS = 24 };
    static double pixels[PIXELS], mean[PIXELS], truth[PIXELS], columns[SIDE];
    double        off = 0, grain = 0, most = 0;
    int           inside = 0;
    (void)state;
    memset(mean, 0, sizeof mean);
    for (uint32_t seed = 1; seed <= SEEDS; seed++) {
        draw("\"technique\": \"stochastic\", \"samples\": 4", seed, pixels, columns);
        for (int i = 0; i < PIXELS; i++)
            mean[i] += pixels[i] / SEEDS;
    }
    draw("\"technique\": \"accumulate\", \"times\": 64", 1, truth, columns);
    for (int i = 0; i < PIXELS; i++) {
        if (truth[i] <= 0)
            continue;
        off += mean[i] - truth[i];
        grain += fabs(pixels[i] - truth[i]);
        most = fmax(most, fabs(mean[i] - truth[i]));
        inside++;
    }
    printf("mean of %d seeds: off by %+.4f on the mean, %.3f at most; a single one by %.3f\n", SEEDS, off / inside,
           most, grain / inside);
    assert_true(inside > 5000);
    assert_true(fabs(off / inside) < 0.01);
    assert_true(grain / inside > 0.05 && most < 0.3);
}

static void the_same_seed_gives_the_same_picture(void **state)
{
    static double first[PIXELS], second[PIXELS], columns[SIDE];
    (void)state;
    draw("\"technique\": \"stochastic\"", 5, first, columns);
    draw("\"technique\": \"stochastic\"", 5, second, columns);
    assert_memory_equal(first, second, sizeof first);
    draw("\"technique\": \"stochastic\"", 6, second, columns);
    assert_memory_not_equal(first, second, sizeof first);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(four_samples_leave_no_ghosts), cmocka_unit_test(it_is_unbiased),
                                       cmocka_unit_test(the_same_seed_gives_the_same_picture)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
