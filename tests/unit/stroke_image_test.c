/* The picture of a stroke: ink across and along strokes follows it, ends keep their proportions, maps keep their tones,
 * and files that are none are refused. Row P16 of the notes on the pencil city. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/memory.h"
#include "export/export.h"
#include "halftone/tonal_art_map.h"
#include "small_input.h"

enum { SIDE = 256, COLUMNS = 128, ROWS = 16 };

/* --- images that are known ------------------------------------------------------------------------------ */

/* Ink as a function of fractions of the image's length and height, row 0 on top. */
typedef double (*ink_fn)(double along, double down);

static double double_line(double along, double down)
{
    (void)along;
    return down < 0.25 || down > 0.75 ? 1 : 0;
}

static double ramp(double along, double down)
{
    (void)along;
    return (floor(down * ROWS) + 0.5) / ROWS;
}

/* Bare at first and at last, and a mark in the middle. */
static double bars(double along, double down)
{
    (void)down;
    return (along >= 0.125 && along < 0.5) || (along >= 0.75 && along < 0.875) ? 1 : 0.25;
}

static double faint(double along, double down)
{
    (void)along, (void)down;
    return 0.1;
}

static stroke_image image_of(ink_fn ink)
{
    static float values[COLUMNS * ROWS];
    stroke_image out;
    for (int i = 0; i < COLUMNS * ROWS; i++)
        values[i] = (float)ink((i % COLUMNS + 0.5) / COLUMNS, (i / COLUMNS + 0.5) / ROWS);
    assert_int_equal(stroke_image_of_ink(&out, values, COLUMNS, ROWS, NULL), LMN_OK);
    return out;
}

/* --- strokes -------------------------------------------------------------------------------------------- */

static float drawn[SIDE * SIDE];

static void keep(void *user, size_t index, float coverage)
{
    (void)user;
    assert_true(coverage > 0 && coverage <= 1.0001f);
    drawn[index] = coverage;
}

/* Draws one stroke between two positions, texels. */
static void draw(const stroke_image *image, double width, const double from[2], const double to[2])
{
    texture_stroke s = {
        (float)(from[0] / SIDE), (float)(from[1] / SIDE), (float)(to[0] / SIDE), (float)(to[1] / SIDE), 1, 1, 0};
    memset(drawn, 0, sizeof drawn);
    stroke_draw(&s, SIDE, &(stroke_brush){.width = width, .cap = 6 * width, .image = image}, keep, NULL);
}

/* The mean of a function of the image over a texel across the stroke, by many samples. */
static double mean_across(ink_fn ink, double width, double left)
{
    enum { SAMPLES = 4000 };
    double sum = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double down = (0.5 * width - (left - 0.5 + (i + 0.5) / SAMPLES)) / width;
        sum += down > 0 && down < 1 ? ink(0.5, down) : 0;
    }
    return sum / SAMPLES;
}

/* In all four directions, since the upper side of the image is the stroke's left one, wherever its axis lies in its
 * texels. */
static void ink_across_follows_the_image(void **state)
{
    (void)state;
    static const ink_fn inks[] = {double_line, ramp};
    static const double ways[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    double              worst = 0, most = 0;
    for (int k = 0; k < 2; k++) {
        stroke_image image = image_of(inks[k]);
        for (int i = 0; i < 24; i++) {
            const double *way = ways[i % 4], width = 3 + 2.3 * (i / 4);
            const double  at[2] = {128 + 0.17 * i, 128 + 0.29 * i};
            draw(&image, width, (double[2]){at[0] - 80 * way[0], at[1] - 80 * way[1]},
                 (double[2]){at[0] + 80 * way[0], at[1] + 80 * way[1]});
            for (int texel = 100; texel < 156; texel++) {
                int    x = way[0] != 0 ? 128 : texel, y = way[0] != 0 ? texel : 128;
                double left = way[0] * (y + 0.5 - at[1]) - way[1] * (x + 0.5 - at[0]);
                double wanted = mean_across(inks[k], width, left);
                worst = fmax(worst, fabs((double)drawn[y * SIDE + x] - wanted));
                most = fmax(most, wanted);
            }
        }
        stroke_image_release(&image);
    }
    printf("    ink across strokes is off the image's by %.5f at most\n", worst);
    assert_true(worst < 0.001 && most > 0.9);
}

/* Where the ink of a row passes half of what lies around, from one side. */
static double edge_from(int row, double from, int step, bool darker)
{
    int x = (int)floor(from);
    for (int i = 0; i < SIDE; i++, x += step) {
        double here = (double)drawn[row * SIDE + (x + SIDE) % SIDE] - 0.625,
               next = (double)drawn[row * SIDE + (x + step + SIDE) % SIDE] - 0.625;
        if (darker ? here < 0 && next >= 0 : here >= 0 && next < 0)
            return x + 0.5 + step * here / (here - next);
    }
    return -1;
}

/* Marks of the first and last quarter stay as far from the ends, in widths; what lies in the middle stays in the
 * middle, in lengths. */
static void ends_keep_their_proportions(void **state)
{
    (void)state;
    stroke_image image = image_of(bars);
    const double width = 5.3, begin = 4.2;
    double       worst = 0, middle_worst = 0, end = width * COLUMNS / ROWS / 4;
    for (int length = 30; length <= 240; length += 15) {
        draw(&image, width, (double[2]){begin, 100.5}, (double[2]){begin + length, 100.5});
        double shown = fmin(end, length / 4.0); /* short strokes have a middle, too */
        double first = edge_from(100, begin + 1, 1, true) - begin,
               last = begin + length - edge_from(100, begin + length - 2, -1, true);
        double middle = edge_from(100, begin + first + 3, 1, false) - begin;
        worst = fmax(worst, fmax(fabs(first - shown / 2), fabs(last - shown / 2)));
        middle_worst = fmax(middle_worst, fabs(middle - length / 2.0));
        /* No ink outside. */
        assert_true(drawn[100 * SIDE + (int)begin - 1] <= 0 && drawn[96 * SIDE + 40] <= 0);
    }
    stroke_image_release(&image);
    printf("    marks of ends are off by %.3f texels, of the middle by %.3f\n", worst, middle_worst);
    assert_true(worst < 0.1 && middle_worst < 0.1);
}

static void sum_up(void *user, size_t index, float coverage)
{
    (void)index;
    *(double *)user += (double)coverage;
}

/* However it lies, all ink of a stroke is that of its image at its size; and chords show their parts of it. */
static void the_whole_ink_is_there(void **state)
{
    (void)state;
    stroke_image image = image_of(bars);
    for (int i = 0; i < 12; i++) {
        double         length = 50 + 12 * i, width = 3 + 0.7 * i, angle = 0.5 * i, sum = 0, parts = 0;
        double         dx = length * cos(angle) / SIDE, dy = length * sin(angle) / SIDE;
        texture_stroke s = {0.5f, 0.5f, (float)(0.5 + dx), (float)(0.5 + dy), 1, 1, 0}, half[2] = {s, s};
        stroke_brush   brush = {.width = width, .image = &image};
        half[0].u1 = half[1].u0 = (float)(0.5 + dx / 2);
        half[0].v1 = half[1].v0 = (float)(0.5 + dy / 2);
        stroke_draw(&s, SIDE, &brush, sum_up, &sum);
        for (int k = 0; k < 2; k++) {
            brush.from = 0.5 * k;
            brush.to = 0.5 * (k + 1);
            stroke_draw(&half[k], SIDE, &brush, sum_up, &parts);
        }
        double wanted = length * width * stroke_image_mean(&image, &(stroke_extent){length, width});
        assert_true(fabs(sum - wanted) < 0.02 * wanted && fabs(parts - wanted) < 0.02 * wanted);
    }
    stroke_image_release(&image);
}

/* --- maps ----------------------------------------------------------------------------------------------- */

static double mean_ink(const mip_chain *m, int level, int tone)
{
    const uint8_t *t = mip_layer(m, level, tone);
    size_t         count = mip_level_bytes(m, level) / (size_t)m->layers;
    double         sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += 255 - t[i];
    return sum / 255 / (double)count;
}

/*/* But for the rounding of bytes, tones are those that were asked for to half of the shortest stroke's ink, however
 * much the image has; darker ones hold lighter ones. */
static void maps_of_images_have_their_tones(void **state)
{
    (void)state;
    static const ink_fn inks[] = {double_line, ramp, bars, faint};
    for (int k = 0; k < (small_input() ? 1 : 4); k++) {
        stroke_image image = image_of(inks[k]);
        tam_options  w = {.side = SIDE,
                          .tones = 6,
                          .darkest = 0.82,
                          .width = 6,
                          .length = 0.6,
                          .opacity = k == 1 ? 0.5 : 1,
                          .uneven = 0.3f,
                          .image = &image,
                          .seed = 1};
        mip_chain    m;
        double       worst = 0, shortest = 0.3 * w.length * SIDE;
        double ink = w.opacity * shortest * w.width * stroke_image_mean(&image, &(stroke_extent){shortest, w.width});
        assert_int_equal(tonal_art_map(&m, NULL, &w, NULL), LMN_OK);
        for (int tone = 0; tone < 6; tone++)
            worst = fmax(worst, fabs(mean_ink(&m, 0, tone) - w.darkest * (tone + 1) / 6));
        for (int tone = 1; tone < 6; tone++) {
            const uint8_t *lighter = mip_layer(&m, 0, tone - 1), *darker = mip_layer(&m, 0, tone);
            for (int i = 0; i < SIDE * SIDE; i++)
                assert_true(darker[i] <= lighter[i]);
        }
        printf("    tones are off by %.5f at most, half of the shortest stroke has %.5f\n", worst,
               ink / 2 / (SIDE * SIDE));
        assert_true(worst <= 1.2 * ink / 2 / (SIDE * SIDE) + 0.5 / 255);
        mip_chain_release(&m);
        stroke_image_release(&image);
    }
}

/* --- files ---------------------------------------------------------------------------------------------- */

typedef struct pixel {
    uint8_t value, alpha;
} pixel;

/* A picture of one pixel's kind, the upper half of another. */
static void write_picture(const char *path, int width, int height, pixel upper, pixel lower)
{
    uint8_t *rgba = mem_alloc((size_t)width * (size_t)height * 4);
    assert_non_null(rgba);
    for (int i = 0; i < width * height; i++) {
        pixel p = i / width < height / 2 ? upper : lower;
        memset(&rgba[4 * i], p.value, 3);
        rgba[4 * i + 3] = p.alpha;
    }
    export_bytes bytes = {0};
    assert_int_equal(export_png(&bytes, rgba, width, height, NULL), LMN_OK);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes.data, 1, bytes.size, file), bytes.size);
    fclose(file);
    mem_free(bytes.data);
    mem_free(rgba);
}

static char path[] = "stroke-image-XXXXXX.png";

static int make_path(void **state)
{
    (void)state;
    memcpy(path, "stroke-image-XXXXXX.png", sizeof path);
    int file = mkstemps(path, 4);
    return file < 0 ? -1 : close(file);
}

static int remove_path(void **state)
{
    (void)state;
    return unlink(path);
}

/* Ink is how dark a pixel is over white, whether it is grey or thin. */
static void ink_is_what_darkens_paper(void **state)
{
    (void)state;
    static const struct {
        pixel  p;
        double ink;
    } rows[] = {{{0, 255}, 1}, {{255, 255}, 0}, {{0, 0}, 0}, {{0, 51}, 0.2}, {{102, 255}, 0.6}, {{102, 51}, 0.12}};
    const stroke_extent size = {64, 16};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        stroke_image image;
        write_picture(path, 64, 16, (pixel){0, 255}, rows[i].p);
        assert_int_equal(stroke_image_load(&image, path, NULL), LMN_OK);
        assert_int_equal(image.columns, 64);
        assert_int_equal(image.rows, 16);
        assert_true(fabs(stroke_image_at(&image, &size, 32, 4) - 1) < 1e-5);
        assert_true(fabs(stroke_image_at(&image, &size, 32, -4) - rows[i].ink) < 0.003);
        stroke_image_release(&image);
    }
}

static void check_refused(const char *name, lmn_status status, const char *what)
{
    stroke_image image;
    lmn_error    error = {0};
    assert_int_equal(stroke_image_load(&image, name, &error), status);
    assert_null(image.sums);
    if (!strstr(error.message, what))
        fail_msg("'%s' does not say '%s'", error.message, what);
    assert_string_equal(error.file, name);
    assert_true(error.hint[0]);
}

static void what_is_no_stroke_is_refused(void **state)
{
    (void)state;
    const pixel ink = {0, 255}, paper = {255, 255}, nothing = {0, 0};
    write_picture(path, STROKE_IMAGE_LONGEST + 1, 4, ink, ink);
    check_refused(path, LMN_LIMIT, "4097 x 4 pixels; allowed are 4096 x 512");
    write_picture(path, 600, STROKE_IMAGE_HIGHEST + 1, ink, ink);
    check_refused(path, LMN_LIMIT, "600 x 513 pixels");
    write_picture(path, 16, 64, ink, ink);
    check_refused(path, LMN_FORMAT, "higher than it is wide");
    write_picture(path, 64, 16, paper, paper);
    check_refused(path, LMN_FORMAT, "0 % ink");
    write_picture(path, 64, 16, nothing, nothing);
    check_refused(path, LMN_FORMAT, "0 % ink");
    check_refused("no-such-stroke.png", LMN_READ, "cannot open the file");
    FILE *file = fopen(path, "r+b"); /* damaged */
    assert_non_null(file);
    assert_int_equal(fseek(file, 20, SEEK_SET), 0);
    assert_int_equal(fwrite("damage", 1, 6, file), 6);
    fclose(file);
    check_refused(path, LMN_FORMAT, "PNG");
}

/* What was made from a file is found again for as long as the file is the same. */
static void the_content_counts(void **state)
{
    (void)state;
    char *descriptions[2];
    for (int i = 0; i < 2; i++) {
        text out = {0};
        write_picture(path, 64, 16, (pixel){0, 255}, (pixel){(uint8_t)i, 255});
        stroke_image_describe(&out, path);
        descriptions[i] = text_take(&out);
        assert_non_null(descriptions[i]);
    }
    assert_string_not_equal(descriptions[0], descriptions[1]);
    mem_free(descriptions[0]);
    mem_free(descriptions[1]);
}

static void names_are_told_apart(void **state)
{
    (void)state;
    assert_true(stroke_image_is_named("split") && stroke_image_is_named("a/b.png") && stroke_image_is_named("b.webp"));
    assert_true(!stroke_image_is_named("") && !stroke_image_is_named("stipple") && !stroke_image_is_named("a.stx"));
}

/* The one that needs no file: two lines in the middle, which meet at both ends. */
static void split_strokes_are_two_lines(void **state)
{
    (void)state;
    stroke_image image;
    assert_int_equal(stroke_image_load(&image, "split", NULL), LMN_OK);
    const stroke_extent size = {128, 16};
    assert_true(stroke_image_at(&image, &size, 64, 5.5) > 0.99 && stroke_image_at(&image, &size, 64, -5.5) > 0.99);
    assert_true(stroke_image_at(&image, &size, 64, 0) < 0.01 && stroke_image_at(&image, &size, 1, 0) > 0.9);
    assert_true(stroke_image_at(&image, &size, 1, 5.5) < 0.01 && stroke_image_at(&image, &size, 127, 5.5) < 0.01);
    stroke_image_release(&image);
}

static void failing_memory_is_reported(void **state)
{
    (void)state;
    write_picture(path, 64, 16, (pixel){0, 255}, (pixel){0, 255});
    lmn_status status = LMN_MEMORY;
    for (long n = 1; status != LMN_OK && n < 1000; n++) {
        stroke_image image;
        mem_fail_at(n);
        status = stroke_image_load(&image, path, NULL);
        mem_fail_at(0);
        assert_true(status == LMN_OK || (status == LMN_MEMORY && !image.sums));
        stroke_image_release(&image);
    }
    assert_int_equal(status, LMN_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ink_across_follows_the_image),
        cmocka_unit_test(ends_keep_their_proportions),
        cmocka_unit_test(the_whole_ink_is_there),
        cmocka_unit_test(maps_of_images_have_their_tones),
        cmocka_unit_test_setup_teardown(ink_is_what_darkens_paper, make_path, remove_path),
        cmocka_unit_test_setup_teardown(what_is_no_stroke_is_refused, make_path, remove_path),
        cmocka_unit_test_setup_teardown(the_content_counts, make_path, remove_path),
        cmocka_unit_test(names_are_told_apart),
        cmocka_unit_test(split_strokes_are_two_lines),
        cmocka_unit_test_setup_teardown(failing_memory_is_reported, make_path, remove_path),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
