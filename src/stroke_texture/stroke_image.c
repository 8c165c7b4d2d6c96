#include "stroke_texture/stroke_image.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/store.h"
#include "fence/image_read.h"

static const char *const split_name = "split";

/* Of the image's columns, and of a stroke's length at most, so that short strokes have a middle too. */
static const double END = 0.25;

bool stroke_image_is_named(const char *name)
{
    return strcmp(name, split_name) == 0 || image_is_named(name);
}

void stroke_image_describe(text *out, const char *name)
{
    text_append(out, " image=1 %s", name);
    if (image_is_named(name))
        text_append(out, " content=%016llx", (unsigned long long)store_hash_of_file(name));
}

void stroke_image_release(stroke_image *image)
{
    mem_free(image->sums);
    *image = (stroke_image){.sums = NULL};
}

/* --- reading -------------------------------------------------------------------------------------------- */

/* Sums of rectangles are differences of four of these. */
lmn_status stroke_image_of_ink(stroke_image *out, const float *ink, int columns, int rows, lmn_error *error)
{
    size_t stride = (size_t)columns + 1;
    *out = (stroke_image){columns, rows, mem_calloc(stride * ((size_t)rows + 1), sizeof *out->sums)};
    if (!out->sums)
        return error_memory(error);
    for (int y = 0; y < rows; y++) {
        double *above = out->sums + (size_t)y * stride, row = 0;
        for (int x = 0; x < columns; x++) {
            row += (double)ink[(size_t)y * (size_t)columns + (size_t)x];
            above[stride + (size_t)x + 1] = above[(size_t)x + 1] + row;
        }
    }
    return LMN_OK;
}

static lmn_status check(const image_pixels *p, const char *name, lmn_error *error)
{
    if (p->width > STROKE_IMAGE_LONGEST || p->height > STROKE_IMAGE_HIGHEST) {
        error_in_file(error, LMN_LIMIT, name, 0, "a stroke of %u x %u pixels; allowed are %d x %d", p->width, p->height,
                      STROKE_IMAGE_LONGEST, STROKE_IMAGE_HIGHEST);
        error_hint(error, "scale the picture down: 512 x 32 pixels are plenty for a stroke");
        return LMN_LIMIT;
    }
    if (p->height > p->width) {
        error_in_file(error, LMN_FORMAT, name, 0, "a stroke of %u x %u pixels is higher than it is wide", p->width,
                      p->height);
        error_hint(error, "turn the picture, so that the stroke goes from left to right");
        return LMN_FORMAT;
    }
    return LMN_OK;
}

static lmn_status check_ink(const stroke_image *image, const char *name, lmn_error *error)
{
    double pixels = (double)image->columns * image->rows;
    double ink = image->sums[((size_t)image->columns + 1) * ((size_t)image->rows + 1) - 1] / pixels;
    if (ink >= STROKE_IMAGE_LEAST_INK)
        return LMN_OK;
    error_in_file(error, LMN_FORMAT, name, 0, "the picture of a stroke has %.2g %% ink; it takes %g", 100 * ink,
                  100 * STROKE_IMAGE_LEAST_INK);
    error_hint(error, "crop the picture to the stroke, which is dark on white or on nothing");
    return LMN_FORMAT;
}

static lmn_status load_picture(stroke_image *out, const char *name, lmn_error *error)
{
    image_pixels pixels;
    lmn_status   status = image_load(&pixels, name, error);
    if (status != LMN_OK)
        return status;
    size_t count = (size_t)pixels.width * pixels.height;
    float *ink = NULL;
    status = check(&pixels, name, error);
    if (status == LMN_OK && !(ink = mem_alloc(count * sizeof *ink)))
        status = error_memory(error);
    for (size_t i = 0; status == LMN_OK && i < count; i++) {
        const uint8_t *pixel = &pixels.rgba[4 * i];
        ink[i] = (float)(255 - image_luma(pixel)) / 255 * ((float)pixel[3] / 255);
    }
    if (status == LMN_OK)
        status = stroke_image_of_ink(out, ink, (int)pixels.width, (int)pixels.height, error);
    if (status == LMN_OK)
        status = check_ink(out, name, error);
    if (status != LMN_OK)
        stroke_image_release(out);
    mem_free(ink);
    mem_free(pixels.rgba);
    return status;
}

/* What a nib leaves that is pressed apart: two lines, which meet where it is set down and lifted. */
static lmn_status make_split(stroke_image *out, lmn_error *error)
{
    enum { COLUMNS = 128, ROWS = 16 };
    static const double LINE = 2.5; /* half as wide as a line, rows */
    float               ink[COLUMNS * ROWS];
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        double along = (i % COLUMNS + 0.5) / COLUMNS, end = fmin(fmin(along, 1 - along) / END, 1);
        double apart = (ROWS / 2.0 - LINE) * end * (2 - end), aside = fabs(i / COLUMNS + 0.5 - ROWS / 2.0);
        ink[i] = (float)fmax(0, fmin(1, LINE + 0.5 - fabs(aside - apart)));
    }
    return stroke_image_of_ink(out, ink, COLUMNS, ROWS, error);
}

lmn_status stroke_image_load(stroke_image *out, const char *name, lmn_error *error)
{
    *out = (stroke_image){.sums = NULL};
    return strcmp(name, split_name) == 0 ? make_split(out, error) : load_picture(out, name, error);
}

/* --- on a stroke ---------------------------------------------------------------------------------------- */

static double between(double low, double value, double high)
{
    return fmax(low, fmin(value, high));
}

/* An end is as long as its pixels are at the stroke's width. */
static double end_texels(const stroke_image *image, const stroke_extent *stroke)
{
    return fmin(END * image->columns * stroke->width / image->rows, END * stroke->length);
}

/* The position in the image, columns, of one on the stroke. */
static double column_of(const stroke_image *image, const stroke_extent *stroke, double along)
{
    double end = end_texels(image, stroke), columns = END * image->columns, rest = stroke->length - along;
    if (along < end)
        return along / end * columns;
    if (rest < end)
        return image->columns - rest / end * columns;
    return columns + (along - end) / (stroke->length - 2 * end) * (image->columns - 2 * columns);
}

/* Ink of all that is above and left of a position, which may lie within a pixel. */
static double sum_to(const stroke_image *image, double column, double row)
{
    int           x = (int)fmin(column, image->columns - 1), y = (int)fmin(row, image->rows - 1);
    double        right = column - x, down = row - y;
    size_t        stride = (size_t)image->columns + 1;
    const double *above = image->sums + (size_t)y * stride + (size_t)x, *below = above + stride;
    return (above[0] * (1 - right) + above[1] * right) * (1 - down) +
           (below[0] * (1 - right) + below[1] * right) * down;
}

/* Mean ink between columns and rows, none of which is empty. */
static double mean_of(const stroke_image *image, const double columns[2], const double rows[2])
{
    double sum = sum_to(image, columns[1], rows[1]) - sum_to(image, columns[0], rows[1]) -
                 sum_to(image, columns[1], rows[0]) + sum_to(image, columns[0], rows[0]);
    return sum / ((columns[1] - columns[0]) * (rows[1] - rows[0]));
}

double stroke_image_at(const stroke_image *image, const stroke_extent *stroke, double along, double left)
{
    double from = between(0, along - 0.5, stroke->length), to = between(0, along + 0.5, stroke->length);
    double top = 0.5 * stroke->width - left; /* from the stroke's upper border */
    double upper = between(0, top - 0.5, stroke->width), lower = between(0, top + 0.5, stroke->width);
    double covered = (to - from) * (lower - upper), rows = image->rows / stroke->width;
    if (!(covered > 1e-9))
        return 0;
    const double columns[2] = {column_of(image, stroke, from), column_of(image, stroke, to)};
    return covered * mean_of(image, columns, (double[2]){upper * rows, lower * rows});
}

double stroke_image_mean(const stroke_image *image, const stroke_extent *stroke)
{
    const double rows[2] = {0, image->rows}, columns = image->columns;
    double       first = mean_of(image, (double[2]){0, END * columns}, rows),
           middle = mean_of(image, (double[2]){END * columns, (1 - END) * columns}, rows),
           last = mean_of(image, (double[2]){(1 - END) * columns, columns}, rows);
    double end = end_texels(image, stroke);
    return stroke->length > 0 ? middle + (first + last - 2 * middle) * end / stroke->length : middle;
}
