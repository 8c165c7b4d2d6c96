/* PNG, JPEG and WebP to RGBA8. */
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include <jpeglib.h>
#include <png.h>
#include <webp/decode.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "import/build.h"
#include "import/import.h"

/* Sets the size and makes room for the pixels, after the limits were checked. */
static lmn_status make_pixels(image *out, size_t width, size_t height, lmn_error *error)
{
    if (width == 0 || height == 0)
        return error_set(error, LMN_FORMAT, "an image of %zu x %zu pixels", width, height);
    if (width > LIMIT_IMAGE_SIDE || height > LIMIT_IMAGE_SIDE || width * height > LIMIT_IMAGE_PIXELS)
        return error_set(error, LMN_LIMIT, "an image of %zu x %zu pixels; allowed are %d a side and %zu in all", width,
                         height, LIMIT_IMAGE_SIDE, LIMIT_IMAGE_PIXELS);
    out->pixels = mem_alloc(width * height * 4);
    if (!out->pixels)
        return error_memory(error);
    out->width = (uint32_t)width;
    out->height = (uint32_t)height;
    return LMN_OK;
}

static lmn_status read_png(image *out, const unsigned char *bytes, size_t size, lmn_error *error)
{
    png_image png = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_memory(&png, bytes, size)) {
        error_set(error, LMN_FORMAT, "PNG: %s", png.message);
        png_image_free(&png);
        return LMN_FORMAT;
    }
    png.format = PNG_FORMAT_RGBA;
    lmn_status status = make_pixels(out, png.width, png.height, error);
    if (status == LMN_OK && !png_image_finish_read(&png, NULL, out->pixels, 0, NULL))
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
static lmn_status decode_jpeg(struct jpeg_decompress_struct *info, image *out, const unsigned char *bytes, size_t size,
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
        JSAMPROW row = out->pixels + (size_t)info->output_scanline * out->width * 4;
        jpeg_read_scanlines(info, &row, 1);
    }
    jpeg_finish_decompress(info);
    return LMN_OK;
}

static lmn_status read_jpeg(image *out, const unsigned char *bytes, size_t size, lmn_error *error)
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

static lmn_status read_webp(image *out, const unsigned char *bytes, size_t size, lmn_error *error)
{
    int width, height;
    if (!WebPGetInfo(bytes, size, &width, &height))
        return error_set(error, LMN_FORMAT, "WebP: damaged header");
    lmn_status status = make_pixels(out, (size_t)width, (size_t)height, error);
    if (status != LMN_OK)
        return status;
    if (!WebPDecodeRGBAInto(bytes, size, out->pixels, (size_t)width * (size_t)height * 4, width * 4))
        return error_set(error, LMN_FORMAT, "WebP: damaged or cut off");
    return LMN_OK;
}

lmn_status import_image(image *out, const unsigned char *bytes, size_t size, lmn_error *error)
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
        mem_free(out->pixels);
        out->pixels = NULL;
        out->width = out->height = 0;
    }
    return status;
}

lmn_status build_image_bytes(const import_job *job, const char *name, const unsigned char *bytes, size_t size,
                             int32_t *out, lmn_error *error)
{
    *out = NONE;
    image decoded = {0};
    lmn_error problem;
    lmn_status status = import_image(&decoded, bytes, size, &problem);
    if (status == LMN_MEMORY)
        return error_memory(error);
    if (status != LMN_OK) {
        warnings_add(&job->scene->warnings, WARNING_BAD_TEXTURE, "texture \"%s\": %s", name, problem.message);
        return LMN_OK;
    }
    size_t total = (size_t)decoded.width * decoded.height;
    for (size_t i = 0; i < job->scene->image_count; i++)
        total += (size_t)job->scene->images[i].width * job->scene->images[i].height;
    if (total > LIMIT_SCENE_PIXELS) {
        warnings_add(&job->scene->warnings, WARNING_BAD_TEXTURE, "texture \"%s\": all textures together have more than %zu pixels",
                     name, LIMIT_SCENE_PIXELS);
        mem_free(decoded.pixels);
        return LMN_OK;
    }
    decoded.name = mem_copy_text(name);
    image *added = decoded.name ? scene_append_image(job->scene) : NULL;
    if (!added) {
        mem_free(decoded.name);
        mem_free(decoded.pixels);
        return error_memory(error);
    }
    *added = decoded;
    *out = (int32_t)job->scene->image_count - 1;
    return LMN_OK;
}

lmn_status build_image_file(const import_job *job, const char *name, int32_t *out, lmn_error *error)
{
    *out = NONE;
    file_data file;
    lmn_status status = build_side_file(job, "texture", name, &file, error);
    if (status != LMN_OK || !file.data)
        return status;
    status = build_image_bytes(job, name, file.data, file.size, out, error);
    file_data_release(&file);
    return status;
}
