/* Films by the program ffmpeg: frames go to it as plain RGBA, and it writes the file that is to arrive. */
#include "film/encoder.h"

#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "film/child.h"

enum { ARGUMENTS_MAX = 64, TEXT_SIZE = 64 };

/* One palette for all frames takes all of them at once; beyond so many bytes each gets its own. */
#define ONE_PALETTE_BYTES 536870912.0

static const char program_name[] = "ffmpeg";

/* --- formats -------------------------------------------------------------------------------------------- */

/* Drawings are sRGB, films BT.709: the same primaries, and players take either transfer for the other. Without the
 * last flag the last column of an odd width gets half of its colour. */
#define TO_BT709                                                                                                       \
    "scale=in_range=full:out_range=tv:out_color_matrix=bt709:flags=accurate_rnd+full_chroma_int+full_chroma_inp,"      \
    "format="
#define TAGGED_BT709 "-color_range", "tv", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"

const char *const *encoder_of_mp4(const film *f)
{
    static const char *const arguments[] = {
        "-vf",   TO_BT709 "yuv420p", "-c:v",       "libx264",   "-preset",    "medium", "-crf", "16",
        "-tune", "animation",        TAGGED_BT709, "-movflags", "+faststart", "-f",     "mp4",  NULL};
    (void)f;
    return arguments;
}

/* An encoder that also looks ahead for frames to predict from cannot keep opacity. */
const char *const *encoder_of_webm(const film *f)
{
    static const char *const opaque[] = {
        "-vf",  TO_BT709 "yuv420p", "-c:v", "libvpx-vp9", "-crf", "24",         "-b:v", "0",    "-deadline",
        "good", "-cpu-used",        "3",    "-row-mt",    "1",    TAGGED_BT709, "-f",   "webm", NULL};
    static const char *const transparent[] = {"-vf",           TO_BT709 "yuva420p",
                                              "-c:v",          "libvpx-vp9",
                                              "-crf",          "24",
                                              "-b:v",          "0",
                                              "-deadline",     "good",
                                              "-cpu-used",     "3",
                                              "-row-mt",       "1",
                                              "-auto-alt-ref", "0",
                                              TAGGED_BT709,    "-f",
                                              "webm",          NULL};
    return f->transparent ? transparent : opaque;
}

/* Dots that stand for a colour between two would dance from frame to frame. */
const char *const *encoder_of_gif(const film *f)
{
    static const char *const of_film[] = {
        "-vf", "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=none", "-f", "gif", NULL};
    static const char *const of_frame[] = {
        "-vf", "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=dither=none:new=1", "-f", "gif", NULL};
    double bytes = 4.0 * f->width * f->height * f->frame_count;
    return bytes > 0 && bytes <= ONE_PALETTE_BYTES ? of_film : of_frame;
}

/* --- the process ---------------------------------------------------------------------------------------- */

static lmn_status check(lmn_error *error)
{
    char program[CHILD_PATH_CAPACITY];
    if (child_find(program, program_name))
        return LMN_OK;
    error_set(error, LMN_UNSUPPORTED, "films of this format are made by ffmpeg, which is not on the PATH");
    error_hint(error, "install it (Debian: sudo apt-get install ffmpeg); .webp films and numbered pictures "
                      "(name-{frame}.png) need nothing");
    return LMN_UNSUPPORTED;
}

/* Lists of arguments end with NULL, this one too. */
static void append_all(const char *out[ARGUMENTS_MAX], const char *const *more)
{
    size_t count = 0;
    while (out[count])
        count++;
    while (*more && count + 1 < ARGUMENTS_MAX)
        out[count++] = *more++;
    out[count] = NULL;
}

static lmn_status begin(film *f, lmn_error *error)
{
    char        program[CHILD_PATH_CAPACITY], size[TEXT_SIZE], rate[TEXT_SIZE], file[TEXT_SIZE];
    const char *arguments[ARGUMENTS_MAX] = {program_name, NULL};
    if (!child_find(program, program_name))
        return check(error);
    snprintf(size, sizeof size, "%dx%d", f->width, f->height);
    snprintf(rate, sizeof rate, "%lld/%lld", f->rate.frames, f->rate.seconds);
    snprintf(file, sizeof file, "file:/proc/self/fd/%d", CHILD_FILE);
    append_all(arguments, (const char *const[]){"-hide_banner", "-loglevel", "error", "-nostdin", "-y", NULL});
    append_all(arguments, (const char *const[]){"-f", "rawvideo", "-pix_fmt", "rgba", "-video_size", size, "-framerate",
                                                rate, "-i", "pipe:0", NULL});
    append_all(arguments, f->format->arguments(f));
    /* Neither versions nor random numbers in the file: the same frames, the same bytes. */
    append_all(arguments, (const char *const[]){"-fflags", "+bitexact", "-flags:v", "+bitexact", file, NULL});
    child     *started = NULL;
    lmn_status status = child_start(&started, program, arguments, file_arrival_descriptor(f->file), error);
    f->writing = started;
    return status;
}

/* Which file, when in it, and what can be done. */
static lmn_status explain(const film *f, lmn_status status, lmn_error *error)
{
    if (status != LMN_WRITE || !error)
        return status;
    error_file(error, f->path);
    if (strstr(error->message, "nknown encoder"))
        error_hint(error, "this ffmpeg was built without it; .webp films need no ffmpeg");
    else if (!error->hint[0])
        error_hint(error, "ffmpeg got %u whole frames; numbered pictures (name-{frame}.png) need none",
                   (unsigned)f->added);
    return status;
}

static lmn_status add(film *f, const uint8_t *rgba, lmn_error *error)
{
    return explain(f, child_write(f->writing, rgba, (size_t)f->width * (size_t)f->height * 4, error), error);
}

static lmn_status end(film *f, lmn_error *error)
{
    return explain(f, child_end(f->writing, error), error);
}

static void drop(film *f)
{
    child *c = f->writing;
    child_kill(&c);
    f->writing = NULL;
}

const film_writer film_by_encoder = {program_name, "ffmpeg", check, begin, add, end, drop};
