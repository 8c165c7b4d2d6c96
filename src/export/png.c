/* PNG through libdeflate: one fixed filter and level 6 beat libpng's defaults in size and time on drawings. It
 * compresses all at once, which takes long for very large pictures; those go through zlib in pieces, between which
 * one can stop. */
#include "export/export.h"

#include <libdeflate.h>
#include <string.h>
#include <zlib.h>

#include "base/memory.h"
#include "base/work.h"

enum { COLOUR_GREY = 0, COLOUR_RGB = 2, COLOUR_RGBA = 6, FILTER_UP = 2 };

/* Bytes of rows up to which a picture is compressed at once; pieces of larger ones. */
enum { AT_ONCE_MOST = 1 << 25, PIECE = 1 << 21, LEVEL = 6 };

typedef struct png_image {
    int            width, height, colour_type, depth, pixel_bytes;
    unsigned char *rows; /* filtered: one filter byte and the row, for each row */
    size_t         rows_size;
} png_image;

static void put_be32(unsigned char *at, uint32_t value)
{
    at[0] = (unsigned char)(value >> 24);
    at[1] = (unsigned char)(value >> 16);
    at[2] = (unsigned char)(value >> 8);
    at[3] = (unsigned char)value;
}

static size_t put_chunk(unsigned char *at, const char *type, const unsigned char *data, size_t size)
{
    put_be32(at, (uint32_t)size);
    memcpy(at + 4, type, 4);
    if (size && data)
        memmove(at + 8, data, size);
    put_be32(at + 8 + size, libdeflate_crc32(0, at + 4, size + 4));
    return size + 12;
}

static bool allocate_rows(png_image *png, int width, int height, int colour_type, int depth, int pixel_bytes)
{
    *png = (png_image){width, height, colour_type, depth, pixel_bytes, NULL, 0};
    png->rows_size = ((size_t)width * (size_t)pixel_bytes + 1) * (size_t)height;
    png->rows = mem_alloc(png->rows_size);
    return png->rows != NULL;
}

/* Turns plain rows, already laid out with room for the filter byte, into differences to the row above; bottom row
 * first. */
static void filter_up(png_image *png)
{
    size_t stride = (size_t)png->width * (size_t)png->pixel_bytes + 1;
    for (int y = png->height - 1; y >= 0; y--) {
        unsigned char *row = png->rows + (size_t)y * stride;
        row[0] = y > 0 ? FILTER_UP : 0;
        if (y == 0)
            continue;
        const unsigned char *above = row - stride;
        for (size_t x = 1; x < stride; x++)
            row[x] = (unsigned char)(row[x] - above[x]);
    }
}

static size_t compress_at_once(const png_image *png, unsigned char *out, size_t capacity)
{
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(LEVEL);
    size_t size = compressor ? libdeflate_zlib_compress(compressor, png->rows, png->rows_size, out, capacity) : 0;
    libdeflate_free_compressor(compressor);
    return size;
}

/* 0 when it is to stop, or memory is gone. */
static size_t compress_in_pieces(const png_image *png, unsigned char *out, size_t capacity)
{
    z_stream z = {0};
    int      result = deflateInit(&z, LEVEL);
    size_t   read = 0, written = 0;
    while (result == Z_OK && !work_stopped() && work_check(NULL) == LMN_OK) {
        size_t some = png->rows_size - read < PIECE ? png->rows_size - read : PIECE,
               left = capacity - written < PIECE ? capacity - written : PIECE;
        z.next_in = png->rows + read;
        z.avail_in = (uInt)some;
        z.next_out = out + written;
        z.avail_out = (uInt)left;
        result = deflate(&z, read + some == png->rows_size ? Z_FINISH : Z_NO_FLUSH);
        read += some - z.avail_in;
        written += left - z.avail_out;
    }
    deflateEnd(&z);
    return result == Z_STREAM_END ? written : 0;
}

/* The most that either makes of the rows. */
static size_t compressed_most(const png_image *png)
{
    return png->rows_size + png->rows_size / 512 + 4096;
}

static lmn_status compress_rows(export_bytes *out, png_image *png, lmn_error *error)
{
    static const unsigned char signature[8] = {0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A};
    filter_up(png);
    size_t         bound = compressed_most(png);
    unsigned char *data = mem_alloc(bound + 128);
    if (!data) {
        mem_free(png->rows);
        return error_memory(error);
    }
    unsigned char header[13] = {0};
    put_be32(header, (uint32_t)png->width);
    put_be32(header + 4, (uint32_t)png->height);
    header[8] = (unsigned char)png->depth;
    header[9] = (unsigned char)png->colour_type;
    memcpy(data, signature, 8);
    size_t at = 8;
    at += put_chunk(data + at, "IHDR", header, sizeof header);
    at += put_chunk(data + at, "sRGB", (const unsigned char[]){0}, 1);
    size_t size = png->rows_size > AT_ONCE_MOST ? compress_in_pieces(png, data + at + 8, bound)
                                                : compress_at_once(png, data + at + 8, bound);
    if (size == 0) {
        mem_free(png->rows);
        mem_free(data);
        return error_memory(error);
    }
    at += put_chunk(data + at, "IDAT", NULL, size);
    at += put_chunk(data + at, "IEND", NULL, 0);
    mem_free(png->rows);
    out->data = data;
    out->size = at;
    return LMN_OK;
}

static lmn_status export_rgba(export_bytes *out, const uint8_t *rgba, int width, int height, bool keep_alpha,
                              lmn_error *error)
{
    png_image png;
    int       bytes = keep_alpha ? 4 : 3;
    if (!allocate_rows(&png, width, height, keep_alpha ? COLOUR_RGBA : COLOUR_RGB, 8, bytes))
        return error_memory(error);
    size_t stride = (size_t)width * (size_t)bytes + 1;
    for (int y = 0; y < height; y++) {
        unsigned char *row = png.rows + (size_t)y * stride + 1;
        const uint8_t *from = rgba + (size_t)y * (size_t)width * 4;
        if (keep_alpha)
            memcpy(row, from, (size_t)width * 4);
        else
            for (int x = 0; x < width; x++)
                memcpy(row + 3 * x, from + 4 * x, 3);
    }
    return compress_rows(out, &png, error);
}

lmn_status export_png(export_bytes *out, const uint8_t *rgba, int width, int height, lmn_error *error)
{
    size_t        count = (size_t)width * (size_t)height;
    unsigned char all = 255;
    for (size_t i = 0; i < count; i++)
        all &= rgba[4 * i + 3];
    return export_rgba(out, rgba, width, height, all != 255, error);
}

lmn_status export_png_raw(export_bytes *out, const uint8_t *rgba, int width, int height, lmn_error *error)
{
    return export_rgba(out, rgba, width, height, true, error);
}

lmn_status export_png_grey16(export_bytes *out, const uint16_t *grey, int width, int height, lmn_error *error)
{
    png_image png;
    if (!allocate_rows(&png, width, height, COLOUR_GREY, 16, 2))
        return error_memory(error);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            uint16_t       value = grey[(size_t)y * (size_t)width + (size_t)x];
            unsigned char *at = png.rows + (size_t)y * ((size_t)width * 2 + 1) + 1 + 2 * (size_t)x;
            at[0] = (unsigned char)(value >> 8);
            at[1] = (unsigned char)value;
        }
    return compress_rows(out, &png, error);
}
