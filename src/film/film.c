/* The table of formats, and drawings as frames: of the size and with the opacity that the format has. */
#include "film/film.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "film/encoder.h"

enum { SIDE_VIDEO = 16384, SIDE_WEBP = 16383, RATE_PARTS = 1000000 };

#define RATE_MIN 0.001

static const char whole_milliseconds[] = "its times are whole milliseconds";

const film_format film_formats[] = {
    {".mp4", "H.264, which everything plays; without opacity, and its sizes are even.", &film_by_encoder, FILM_OPAQUE,
     .even = true, .side_most = SIDE_VIDEO, .rate_most = 1000, .why_rate = whole_milliseconds,
     .arguments = encoder_of_mp4},
    {".webm", "VP9, for the web; keeps opacity.", &film_by_encoder, FILM_FIRST_FRAME, .side_most = SIDE_VIDEO,
     .rate_most = 1000, .why_rate = whole_milliseconds, .arguments = encoder_of_webm},
    {".gif", "256 colours, runs for ever; a pixel is there or not.", &film_by_encoder, FILM_CUT_OUT,
     .side_most = SIDE_VIDEO, .rate_most = 50, .why_rate = "what shows GIF shows faster ones slowly",
     .arguments = encoder_of_gif},
    {".webp", "Animated WebP without loss, runs for ever; keeps opacity.", &film_by_webp, FILM_TRANSPARENT,
     .side_most = SIDE_WEBP, .rate_most = 1000, .why_rate = whole_milliseconds},
};
const size_t film_format_count = sizeof film_formats / sizeof *film_formats;

lmn_status film_choose(const film_format **out, const char *path, const char *name, lmn_error *error)
{
    char        ending[16];
    const char *known[sizeof film_formats / sizeof *film_formats];
    if (!name)
        file_ending(path, ending, sizeof ending);
    const char *wanted = name ? name : ending, *bare = wanted + (*wanted == '.');
    for (size_t i = 0; i < film_format_count; i++) {
        known[i] = film_formats[i].ending;
        if (strcmp(film_formats[i].ending + 1, bare) == 0) {
            *out = &film_formats[i];
            return LMN_OK;
        }
    }
    lmn_status  status = error_in_file(error, LMN_USAGE, path, 0, "cannot write '%s' films", wanted);
    const char *nearest = text_nearest(wanted, known, film_format_count);
    if (nearest)
        error_hint(error, "did you mean '%s'?", nearest);
    else
        error_hint(error, "films are written as .mp4, .webm, .gif or .webp");
    return status;
}

lmn_status film_check(const film_format *format, const char *path, const lmn_film_desc *desc, lmn_error *error)
{
    if (desc->width < 1 || desc->height < 1 || desc->width > format->side_most || desc->height > format->side_most)
        return error_in_file(error, LMN_USAGE, path, 0, "the film is of %dx%d pixels; allowed are 1 to %d a side in %s",
                             desc->width, desc->height, format->side_most, format->ending);
    if (!(desc->rate >= RATE_MIN && desc->rate <= format->rate_most)) {
        error_in_file(error, LMN_USAGE, path, 0, "the film has %g frames a second; allowed are 0.001 to %d in %s",
                      desc->rate, format->rate_most, format->ending);
        error_hint(error, "%s", format->why_rate);
        return LMN_USAGE;
    }
    lmn_status status = format->writer->check(error);
    if (status != LMN_OK)
        error_file(error, path);
    return status;
}

/* --- open ----------------------------------------------------------------------------------------------- */

/* 24 as 24/1, 29.97 as 2997/100. */
static film_rate rate_of(double frames_a_second)
{
    film_rate r = {llround(frames_a_second * RATE_PARTS), RATE_PARTS};
    long long a = r.frames, b = r.seconds;
    while (b != 0) {
        long long rest = a % b;
        a = b;
        b = rest;
    }
    return (film_rate){r.frames / a, r.seconds / a};
}

lmn_status film_open(film **out, const film_format *format, const char *path, const lmn_film_desc *desc,
                     lmn_error *error)
{
    film *f = *out = mem_calloc(1, sizeof *f);
    if (!f)
        return error_memory(error);
    f->format = format;
    f->given_width = f->width = desc->width;
    f->given_height = f->height = desc->height;
    f->rate = rate_of(desc->rate);
    f->frame_count = desc->frame_count;
    f->progress = desc->progress;
    f->progress_user = desc->progress_user;
    if (format->even) {
        f->width += f->width % 2;
        f->height += f->height % 2;
    }
    if (f->width != f->given_width || f->height != f->given_height)
        warnings_add(&f->warnings, WARNING_APPROXIMATE,
                     "films of %s have even sizes: this one has %dx%d pixels, with the last column or row twice",
                     format->ending, f->width, f->height);
    f->path = mem_copy_text(path);
    lmn_status status = f->path ? file_arrival_begin(&f->file, path, error) : error_memory(error);
    if (status != LMN_OK)
        film_destroy(out);
    return status;
}

/* --- frames --------------------------------------------------------------------------------------------- */

static bool is_opaque(const uint8_t *rgba, size_t pixels)
{
    unsigned char all = 255;
    for (size_t i = 0; i < pixels; i++)
        all &= rgba[4 * i + 3];
    return all == 255;
}

static void warn_of_opacity(film *f)
{
    if (f->format->opacity == FILM_CUT_OUT)
        warnings_add(&f->warnings, WARNING_TRANSPARENCY,
                     "in %s a pixel is there or not: what is less than half opaque is left out, the rest is opaque",
                     f->format->ending);
    else if (!f->transparent && f->format->opacity == FILM_OPAQUE)
        warnings_add(&f->warnings, WARNING_TRANSPARENCY,
                     "%s has no opacity: what is transparent lies on white; .webm and .webp keep it",
                     f->format->ending);
    else if (!f->transparent)
        warnings_add(&f->warnings, WARNING_TRANSPARENCY,
                     "the first frame was opaque, and so is the film: what is transparent later lies on white");
}

/* `values` of the drawing over white. */
static void put_on_white(uint8_t *values, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++, values += 4) {
        unsigned opacity = values[3];
        for (int k = 0; k < 3; k++)
            values[k] = (uint8_t)((values[k] * opacity + 255 * (255 - opacity) + 127) / 255);
        values[3] = 255;
    }
}

/* The drawing with its last column and row again where the frame is larger. */
static void enlarge(const film *f, const uint8_t *rgba)
{
    size_t given = (size_t)f->given_width * 4, stride = (size_t)f->width * 4;
    for (int y = 0; y < f->height; y++) {
        int            source = y < f->given_height ? y : f->given_height - 1;
        const uint8_t *from = rgba + (size_t)source * given;
        uint8_t       *to = f->frame + (size_t)y * stride;
        memcpy(to, from, given);
        if (stride > given)
            memcpy(to + given, from + given - 4, 4);
    }
}

/* The drawing itself where the format takes it as it is. NULL: memory is gone. */
static const uint8_t *prepare(film *f, const uint8_t *rgba, bool opaque)
{
    size_t pixels = (size_t)f->width * (size_t)f->height;
    bool   same_size = f->width == f->given_width && f->height == f->given_height;
    bool   flat = opaque || f->transparent || f->format->opacity == FILM_CUT_OUT;
    if (!opaque)
        warn_of_opacity(f);
    if (same_size && flat)
        return rgba;
    if (!f->frame)
        f->frame = mem_alloc(pixels * 4);
    if (!f->frame)
        return NULL;
    enlarge(f, rgba);
    if (!flat)
        put_on_white(f->frame, pixels);
    return f->frame;
}

static lmn_status add_one(film *f, const uint8_t *rgba, lmn_error *error)
{
    bool       opaque = is_opaque(rgba, (size_t)f->given_width * (size_t)f->given_height);
    lmn_status status = LMN_OK;
    if (!f->writing) {
        f->transparent = f->format->opacity == FILM_TRANSPARENT || (f->format->opacity == FILM_FIRST_FRAME && !opaque);
        status = f->format->writer->begin(f, error);
    }
    const uint8_t *frame = status == LMN_OK ? prepare(f, rgba, opaque) : NULL;
    if (status == LMN_OK && !frame)
        status = error_memory(error);
    return status == LMN_OK ? f->format->writer->add(f, frame, error) : status;
}

lmn_status film_add(film *f, const uint8_t *rgba, lmn_error *error)
{
    if (f->failed)
        return error_in_file(error, LMN_USAGE, f->path, 0, "an earlier frame failed; nothing more can be added");
    lmn_status status = add_one(f, rgba, error);
    f->failed = status != LMN_OK;
    f->added += status == LMN_OK;
    return status;
}

/* --- close ---------------------------------------------------------------------------------------------- */

lmn_status film_close(film **handle, uint64_t *bytes, lmn_error *error)
{
    film      *f = *handle;
    lmn_status status = LMN_OK;
    if (f->failed || f->added == 0)
        status = error_in_file(error, LMN_USAGE, f->path, 0,
                               f->failed ? "a frame failed; there is no film" : "the film has no frame");
    if (status == LMN_OK)
        status = f->format->writer->end(f, error);
    if (status == LMN_OK)
        status = file_arrival_end(&f->file, bytes, error);
    film_destroy(handle);
    return status;
}

void film_destroy(film **handle)
{
    film *f = handle ? *handle : NULL;
    if (!f)
        return;
    if (f->writing)
        f->format->writer->drop(f);
    file_arrival_drop(&f->file);
    warnings_release(&f->warnings);
    mem_free(f->frame);
    mem_free(f->path);
    mem_free(f);
    *handle = NULL;
}
