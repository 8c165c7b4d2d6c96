#include "picture.h"

#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

uint8_t *picture_read_rgba(const char *path, int *width, int *height)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_file(&image, path))
        return NULL;
    image.format = PNG_FORMAT_RGBA;
    uint8_t *pixels = malloc(PNG_IMAGE_SIZE(image));
    if (!pixels || !png_image_finish_read(&image, NULL, pixels, 0, NULL)) {
        png_image_free(&image);
        free(pixels);
        return NULL;
    }
    *width = (int)image.width;
    *height = (int)image.height;
    return pixels;
}

/* The simplified interface would apply a transfer curve to 16-bit greys, so ids take the long way. */
static uint16_t *read_grey16(FILE *file, png_structp png, png_infop info, int *width, int *height)
{
    uint16_t *volatile pixels = NULL;
    png_bytep *volatile rows = NULL;
    if (setjmp(png_jmpbuf(png))) {
        free(pixels);
        free((void *)rows);
        return NULL;
    }
    png_init_io(png, file);
    png_read_info(png, info);
    if (png_get_bit_depth(png, info) != 16 || png_get_color_type(png, info) != PNG_COLOR_TYPE_GRAY)
        return NULL;
    png_set_swap(png);
    *width = (int)png_get_image_width(png, info);
    *height = (int)png_get_image_height(png, info);
    pixels = malloc((size_t)*width * (size_t)*height * sizeof *pixels);
    rows = malloc((size_t)*height * sizeof *rows);
    if (!pixels || !rows)
        png_error(png, "out of memory");
    for (int y = 0; y < *height; y++)
        rows[y] = (png_bytep)(pixels + (size_t)y * (size_t)*width);
    png_read_image(png, rows);
    free((void *)rows);
    return pixels;
}

uint16_t *picture_read_grey16(const char *path, int *width, int *height)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop   info = png ? png_create_info_struct(png) : NULL;
    uint16_t   *pixels = info ? read_grey16(file, png, info, width, height) : NULL;
    png_destroy_read_struct(&png, &info, NULL);
    fclose(file);
    return pixels;
}

float *picture_read_pfm(const char *path, int channels, int *width, int *height)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    char   kind[3] = "";
    double scale = 0;
    float *values = NULL;
    if (fscanf(file, "%2s %d %d %lf", kind, width, height, &scale) == 4 && fgetc(file) == '\n' && scale < 0 &&
        strcmp(kind, channels == 3 ? "PF" : "Pf") == 0 && *width > 0 && *height > 0) {
        size_t row = (size_t)*width * (size_t)channels;
        values = malloc(row * (size_t)*height * sizeof *values);
        for (int y = *height - 1; values && y >= 0; y--)
            if (fread(values + (size_t)y * row, sizeof *values, row, file) != row) {
                free(values);
                values = NULL;
            }
        if (values && fgetc(file) != EOF) {
            free(values);
            values = NULL;
        }
    }
    fclose(file);
    return values;
}

static png_image image_of(int width, int height)
{
    return (png_image){.version = PNG_IMAGE_VERSION,
                       .width = (png_uint_32)width,
                       .height = (png_uint_32)height,
                       .format = PNG_FORMAT_RGBA};
}

bool picture_write_rgba(const char *path, const uint8_t *rgba, int width, int height)
{
    png_image image = image_of(width, height);
    return png_image_write_to_file(&image, path, 0, rgba, 0, NULL) != 0;
}

uint8_t *picture_encode_rgba(const uint8_t *rgba, int width, int height, size_t *size)
{
    png_image        image = image_of(width, height);
    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
    uint8_t         *out = malloc(bytes);
    if (!out || !png_image_write_to_memory(&image, out, &bytes, 0, rgba, 0, NULL)) {
        free(out);
        return NULL;
    }
    *size = bytes;
    return out;
}

double picture_shown(uint8_t level)
{
    return level / 255.0;
}

double picture_level(double shown)
{
    return 255 * fmin(fmax(shown, 0), 1);
}

double picture_linear(uint8_t srgb)
{
    static double known[256]; /* whole pictures are asked for, some hundred times */
    if (srgb && known[srgb] == 0) {
        double v = srgb / 255.0;
        known[srgb] = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    }
    return known[srgb];
}

double picture_srgb(double linear)
{
    double v = fmin(fmax(linear, 0), 1);
    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055);
}
