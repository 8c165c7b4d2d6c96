/* PNG, JPEG and WebP to RGBA8. The decoders run behind the fence; what comes back is the pixels and, behind them,
 * their size. */
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include <jpeglib.h>
#include <png.h>
#include <webp/decode.h>

#include "base/colour.h"
#include "base/file.h"
#include "base/limits.h"
#include "base/memory.h"
#include "fence/fence.h"
#include "fence/image_read.h"

/* Sets the size and makes room for the pixels, after the limits were checked. */
static lmn_status make_pixels(image_pixels *out, size_t width, size_t height, lmn_error *error)
{
    if (width == 0 || height == 0)
        return error_set(error, LMN_FORMAT, "an image of %zu x %zu pixels", width, height);
    if (width > LIMIT_IMAGE_SIDE || height > LIMIT_IMAGE_SIDE || width * height > LIMIT_IMAGE_PIXELS)
        return error_set(error, LMN_LIMIT, "an image of %zu x %zu pixels; allowed are %d a side and %zu in all", width,
                         height, LIMIT_IMAGE_SIDE, LIMIT_IMAGE_PIXELS);
    out->rgba = mem_alloc(width * height * 4);
    if (!out->rgba)
        return error_memory(error);
    out->width = (uint32_t)width;
    out->height = (uint32_t)height;
    return LMN_OK;
}

static lmn_status read_png(image_pixels *out, const unsigned char *bytes, size_t size, lmn_error *error)
{
    png_image png = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_memory(&png, bytes, size)) {
        error_set(error, LMN_FORMAT, "PNG: %s", png.message);
        png_image_free(&png);
        return LMN_FORMAT;
    }
    png.format = PNG_FORMAT_RGBA;
    lmn_status status = make_pixels(out, png.width, png.height, error);
    if (status == LMN_OK && !png_image_finish_read(&png, NULL, out->rgba, 0, NULL))
        status = error_set(error, LMN_FORMAT, "PNG: %s", png.message);
    png_image_free(&png);
    return status;
}

typedef struct jpeg_failure {
    struct jpeg_error_mgr manager; /* first: libjpeg hands this struct back */
    jmp_buf               back;
    char                  message[JMSG_LENGTH_MAX];
} jpeg_failure;

static void jpeg_failed(j_common_ptr info)
{
    jpeg_failure *failure = (jpeg_failure *)info->err;
    info->err->format_message(info, failure->message);
    longjmp(failure->back, 1);
}

static void jpeg_silent(j_common_ptr info)
{
    (void)info;
}

/* Four inks to light: what each of them lets through, times what black does. Adobe's programs write how much is let
 * through, others how much ink there is. */
static void lay_inks(uint8_t *out, const uint8_t *inks, uint32_t width, bool adobe)
{
    for (uint32_t x = 0; x < width; x++, out += 4, inks += 4) {
        unsigned black = adobe ? inks[3] : 255u - inks[3];
        for (int k = 0; k < 3; k++)
            out[k] = (uint8_t)(((adobe ? inks[k] : 255u - inks[k]) * black + 127) / 255);
        out[3] = 255;
    }
}

/* Rows arrive as RGBA through libjpeg-turbo's extension, alpha opaque, or as four inks in the row's own bytes. */
static lmn_status decode_jpeg(struct jpeg_decompress_struct *info, image_pixels *out, const unsigned char *bytes,
                              size_t size, lmn_error *error)
{
    jpeg_mem_src(info, bytes, (unsigned long)size);
    jpeg_read_header(info, TRUE);
    lmn_status status = make_pixels(out, info->image_width, info->image_height, error);
    if (status != LMN_OK)
        return status;
    bool inks = info->jpeg_color_space == JCS_CMYK || info->jpeg_color_space == JCS_YCCK;
    info->out_color_space = inks ? JCS_CMYK : JCS_EXT_RGBA;
    jpeg_start_decompress(info);
    while (info->output_scanline < info->output_height) {
        JSAMPROW row = out->rgba + (size_t)info->output_scanline * out->width * 4;
        jpeg_read_scanlines(info, &row, 1);
        if (inks)
            lay_inks(row, row, out->width, info->saw_Adobe_marker);
    }
    jpeg_finish_decompress(info);
    return LMN_OK;
}

static lmn_status read_jpeg(image_pixels *out, const unsigned char *bytes, size_t size, lmn_error *error)
{
    struct jpeg_decompress_struct info;
    jpeg_failure                  failure = {.message = ""};
    info.err = jpeg_std_error(&failure.manager);
    failure.manager.error_exit = jpeg_failed;
    failure.manager.output_message = jpeg_silent;
    if (setjmp(failure.back)) {
        jpeg_destroy_decompress(&info);
        return error_set(error, LMN_FORMAT, "JPEG: %s", failure.message);
    }
    jpeg_create_decompress(&info);
    lmn_status status = decode_jpeg(&info, out, bytes, size, error);
    jpeg_destroy_decompress(&info);
    return status;
}

static lmn_status read_webp(image_pixels *out, const unsigned char *bytes, size_t size, lmn_error *error)
{
    int width, height;
    if (!WebPGetInfo(bytes, size, &width, &height))
        return error_set(error, LMN_FORMAT, "WebP: damaged header");
    lmn_status status = make_pixels(out, (size_t)width, (size_t)height, error);
    if (status != LMN_OK)
        return status;
    if (!WebPDecodeRGBAInto(bytes, size, out->rgba, (size_t)width * (size_t)height * 4, width * 4))
        return error_set(error, LMN_FORMAT, "WebP: damaged or cut off");
    return LMN_OK;
}

static lmn_status decode(image_pixels *out, const unsigned char *bytes, size_t size, lmn_error *error)
{
    if (size >= 8 && memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0)
        return read_png(out, bytes, size, error);
    if (size >= 3 && memcmp(bytes, "\xFF\xD8\xFF", 3) == 0)
        return read_jpeg(out, bytes, size, error);
    if (size >= 12 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBP", 4) == 0)
        return read_webp(out, bytes, size, error);
    return error_set(error, LMN_UNSUPPORTED, "an image that is neither PNG, JPEG nor WebP");
}

/* --- making it smaller ---------------------------------------------------------------------------------- */

/* Both ways between bytes and light; powers are dear. The sum of four lights is the index. */
enum { LIGHT_STEPS = 1 << 14 };

typedef struct light_table {
    uint16_t light[256];
    uint8_t  byte[4 * LIGHT_STEPS + 1];
} light_table;

static void fill_table(light_table *t)
{
    for (int i = 0; i < 256; i++)
        t->light[i] = (uint16_t)(colour_to_linear((float)i / 255) * LIGHT_STEPS + 0.5f);
    for (int i = 0; i <= 4 * LIGHT_STEPS; i++)
        t->byte[i] = (uint8_t)(colour_from_linear((float)i / (4 * LIGHT_STEPS)) * 255 + 0.5f);
}

/* An odd row or column at the end is left out. */
void image_halve(image_pixels *image)
{
    light_table table;
    fill_table(&table);
    uint32_t width = image->width > 1 ? image->width / 2 : 1, height = image->height > 1 ? image->height / 2 : 1;
    uint8_t *out = image->rgba;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++, out += 4) {
            size_t         right = image->width > 1 ? 4 : 0, below = image->height > 1 ? (size_t)image->width * 4 : 0;
            const uint8_t *a = image->rgba + ((size_t)y * 2 * image->width + (size_t)x * 2) * 4, *b = a + right,
                          *c = a + below, *d = c + right;
            uint8_t pixel[4];
            for (int k = 0; k < 3; k++)
                pixel[k] = table.byte[table.light[a[k]] + table.light[b[k]] + table.light[c[k]] + table.light[d[k]]];
            pixel[3] = (uint8_t)((a[3] + b[3] + c[3] + d[3] + 2) / 4);
            memcpy(out, pixel, sizeof pixel);
        }
    image->width = width;
    image->height = height;
    image->halved++;
}

/* --- behind the fence and before it --------------------------------------------------------------------- */

enum { HALVED_MOST = 14 }; /* from the longest side to one pixel */

typedef struct picture_size {
    uint32_t width, height;
    int32_t  halved;
} picture_size;

/* Request: the most bytes, then the file. Answer: pixels, then picture_size; so that the pixels can be kept where
 * they arrive. */
static lmn_status decode_request(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    fence_reader r = fence_read(request, size);
    uint64_t     most = 0;
    const void  *at = fence_take(&r, sizeof most);
    if (at)
        memcpy(&most, at, sizeof most);
    image_pixels picture = {0};
    lmn_status   status = decode(&picture, r.at, (size_t)(r.end - r.at), error);
    if (status != LMN_OK) {
        mem_free(picture.rgba);
        return status;
    }
    while (most && (uint64_t)picture.width * picture.height * 4 > most && picture.width * picture.height > 1)
        image_halve(&picture);
    size_t bytes = (size_t)picture.width * picture.height * 4;
    *answer = (fence_bytes){.bytes = picture.rgba, .size = bytes, .capacity = bytes};
    fence_put(answer, &(picture_size){picture.width, picture.height, picture.halved}, sizeof(picture_size));
    return LMN_OK;
}

lmn_status image_read(image_pixels *out, const unsigned char *bytes, size_t size, size_t most_bytes, lmn_error *error)
{
    *out = (image_pixels){0};
    fence_bytes request = {0}, answer;
    fence_put(&request, &(uint64_t){most_bytes}, sizeof(uint64_t));
    fence_put(&request, bytes, size);
    lmn_status status = fence_call(&answer, decode_request, "the reader of pictures", &request, error);
    mem_free(request.bytes);
    if (status != LMN_OK)
        return status;
    picture_size facts = {0};
    if (answer.size >= sizeof facts)
        memcpy(&facts, answer.bytes + answer.size - sizeof facts, sizeof facts);
    if (!facts.width || !facts.height || facts.width > LIMIT_IMAGE_SIDE || facts.height > LIMIT_IMAGE_SIDE ||
        facts.halved < 0 || facts.halved > HALVED_MOST ||
        answer.size - sizeof facts != (size_t)facts.width * facts.height * 4) {
        mem_free(answer.bytes);
        return error_set(error, LMN_FORMAT, "the reader of pictures gave a wrong answer");
    }
    *out = (image_pixels){.width = facts.width, .height = facts.height, .rgba = answer.bytes, .halved = facts.halved};
    return LMN_OK;
}

bool image_is_named(const char *path)
{
    static const char *const endings[] = {".png", ".jpg", ".jpeg", ".webp"};
    char                     ending[8];
    file_ending(path, ending, sizeof ending);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (strcmp(ending, endings[i]) == 0)
            return true;
    return false;
}

lmn_status image_load(image_pixels *out, const char *path, lmn_error *error)
{
    *out = (image_pixels){0};
    file_data  file;
    lmn_status status = file_load(&file, path, error);
    if (status != LMN_OK)
        return status;
    lmn_error problem = {0};
    status = image_read(out, file.data, file.size, 0, &problem);
    file_data_release(&file);
    if (status == LMN_OK)
        return LMN_OK;
    error_in_file(error, status, path, 0, "%s", problem.message);
    if (problem.hint[0])
        error_hint(error, "%s", problem.hint);
    else if (status == LMN_FORMAT)
        error_hint(error, "save the picture again, as PNG for example");
    return status;
}
