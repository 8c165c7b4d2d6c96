/* PNG, JPEG and WebP to RGBA8. */
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include <jpeglib.h>
#include <png.h>
#include <webp/decode.h>

#include "base/image_read.h"
#include "base/limits.h"
#include "base/file.h"
#include "base/memory.h"

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

/* Rows arrive as RGBA through libjpeg-turbo's extension; alpha is opaque. */
static lmn_status decode_jpeg(struct jpeg_decompress_struct *info, image_pixels *out, const unsigned char *bytes, size_t size,
                              lmn_error *error)
{
    jpeg_mem_src(info, bytes, (unsigned long)size);
    jpeg_read_header(info, TRUE);
    if (info->num_components == 4)
        return error_set(error, LMN_UNSUPPORTED, "JPEG with four colour channels (CMYK)");
    lmn_status status = make_pixels(out, info->image_width, info->image_height, error);
    if (status != LMN_OK)
        return status;
    info->out_color_space = JCS_EXT_RGBA;
    jpeg_start_decompress(info);
    while (info->output_scanline < info->output_height) {
        JSAMPROW row = out->rgba + (size_t)info->output_scanline * out->width * 4;
        jpeg_read_scanlines(info, &row, 1);
    }
    jpeg_finish_decompress(info);
    return LMN_OK;
}

static lmn_status read_jpeg(image_pixels *out, const unsigned char *bytes, size_t size, lmn_error *error)
{
    struct jpeg_decompress_struct info;
    jpeg_failure failure = {.message = ""};
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

lmn_status image_read(image_pixels *out, const unsigned char *bytes, size_t size, lmn_error *error)
{
    lmn_status status;
    if (size >= 8 && memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0)
        status = read_png(out, bytes, size, error);
    else if (size >= 3 && memcmp(bytes, "\xFF\xD8\xFF", 3) == 0)
        status = read_jpeg(out, bytes, size, error);
    else if (size >= 12 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBP", 4) == 0)
        status = read_webp(out, bytes, size, error);
    else
        return error_set(error, LMN_UNSUPPORTED, "an image that is neither PNG, JPEG nor WebP");
    if (status != LMN_OK) {
        mem_free(out->rgba);
        out->rgba = NULL;
        out->width = out->height = 0;
    }
    return status;
}

lmn_status image_load(image_pixels *out, const char *path, lmn_error *error)
{
    *out = (image_pixels){0};
    file_data file;
    lmn_status status = file_load(&file, path, error);
    if (status != LMN_OK)
        return status;
    lmn_error problem;
    status = image_read(out, file.data, file.size, &problem);
    file_data_release(&file);
    return status == LMN_OK ? LMN_OK : error_in_file(error, status, path, 0, "%s", problem.message);
}
