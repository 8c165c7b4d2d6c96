/* Animated WebP through libwebp and libwebpmux: without loss, and only what changed from frame to frame. */
#include "film/film.h"

#include "base/error.h"

#ifdef LIMNER_HAVE_WEBPMUX

#include <limits.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include "base/memory.h"
#include "base/work.h"

/* Of libwebp's levels of effort, the one that takes about as long as drawing. */
enum { EFFORT = 4 };

typedef struct webp_writing {
    WebPAnimEncoder *encoder;
    WebPConfig       config;
} webp_writing;

static lmn_status check(lmn_error *error)
{
    (void)error;
    return LMN_OK;
}

static lmn_status begin(film *f, lmn_error *error)
{
    WebPAnimEncoderOptions options;
    webp_writing          *w = f->writing = mem_calloc(1, sizeof *w);
    if (!w)
        return error_memory(error);
    if (!WebPAnimEncoderOptionsInit(&options) || !WebPConfigInit(&w->config) ||
        !WebPConfigLosslessPreset(&w->config, EFFORT))
        return error_set(error, LMN_INTERNAL, "libwebp is of another version than its headers");
    w->config.exact = 1; /* colours below transparent pixels stay */
    w->config.thread_level = 1;
    options.anim_params.loop_count = 0;
    w->encoder = WebPAnimEncoderNew(f->width, f->height, &options);
    return w->encoder ? LMN_OK : error_memory(error);
}

/* Times are whole milliseconds: each frame begins at the nearest one, so that they do not drift. */
static int begin_ms(const film *f, uint32_t frame)
{
    long long scaled = (long long)frame * 1000 * f->rate.seconds, ms = (scaled + f->rate.frames / 2) / f->rate.frames;
    return ms < INT_MAX ? (int)ms : INT_MAX; /* libwebp refuses frames that take no time, and says so */
}

static lmn_status refuse(const film *f, lmn_error *error)
{
    const webp_writing *w = f->writing;
    lmn_status          status = work_check(error);
    if (status != LMN_OK)
        return status;
    return error_in_file(error, LMN_WRITE, f->path, 0, "libwebp failed: %s", WebPAnimEncoderGetError(w->encoder));
}

static lmn_status add(film *f, const uint8_t *rgba, lmn_error *error)
{
    webp_writing *w = f->writing;
    WebPPicture   picture;
    lmn_status    status = work_check(error);
    if (status != LMN_OK)
        return status;
    if (!WebPPictureInit(&picture))
        return error_set(error, LMN_INTERNAL, "libwebp is of another version than its headers");
    picture.use_argb = 1;
    picture.width = f->width;
    picture.height = f->height;
    if (!WebPPictureImportRGBA(&picture, rgba, 4 * f->width))
        status = error_memory(error);
    else if (!WebPAnimEncoderAdd(w->encoder, &picture, begin_ms(f, f->added), &w->config))
        status = refuse(f, error);
    WebPPictureFree(&picture);
    return status;
}

static lmn_status end(film *f, lmn_error *error)
{
    webp_writing *w = f->writing;
    WebPData      bytes;
    lmn_status    status = work_check(error);
    WebPDataInit(&bytes);
    if (status == LMN_OK && (!WebPAnimEncoderAdd(w->encoder, NULL, begin_ms(f, f->added), NULL) ||
                             !WebPAnimEncoderAssemble(w->encoder, &bytes)))
        status = refuse(f, error);
    if (status == LMN_OK)
        status = file_arrival_write(f->file, bytes.bytes, bytes.size, error);
    WebPDataClear(&bytes);
    return status;
}

static void drop(film *f)
{
    webp_writing *w = f->writing;
    WebPAnimEncoderDelete(w->encoder);
    mem_free(w);
    f->writing = NULL;
}

const film_writer film_by_webp = {NULL, NULL, check, begin, add, end, drop};

#else

static lmn_status check(lmn_error *error)
{
    error_set(error, LMN_UNSUPPORTED, "this build of Limner has no animated WebP: libwebpmux was missing");
    error_hint(error, "build it with libwebpmux (Debian: libwebp-dev), or take another format");
    return LMN_UNSUPPORTED;
}

static lmn_status begin(film *f, lmn_error *error)
{
    (void)f;
    return check(error);
}

static lmn_status add(film *f, const uint8_t *rgba, lmn_error *error)
{
    (void)f, (void)rgba;
    return check(error);
}

static void drop(film *f)
{
    (void)f;
}

const film_writer film_by_webp = {NULL, "libwebp-dev", check, begin, add, begin, drop};

#endif
