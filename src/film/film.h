/* Films: a table of formats, and one file being made. film.c makes of drawings the frames that a format takes; a
 * writer makes a file of frames: encoder.c by the program ffmpeg, webp.c by libwebp. */
#ifndef LIMNER_FILM_FILM_H
#define LIMNER_FILM_FILM_H

#include "base/file_store.h"
#include "base/warnings.h"
#include "limner/film.h"

/* What a format keeps of opacity. */
typedef enum film_opacity {
    FILM_OPAQUE,      /* nothing */
    FILM_CUT_OUT,     /* whether there is something */
    FILM_FIRST_FRAME, /* all of it, when the first frame has any */
    FILM_TRANSPARENT  /* all of it */
} film_opacity;

typedef struct film film;

/* How a file is made of frames. Errors: LMN_WRITE, LMN_MEMORY, LMN_CANCELLED, LMN_LIMIT. */
typedef struct film_writer {
    const char *program, *package; /* lmn_film_format_info */
    /* Is what it takes here? Errors: LMN_UNSUPPORTED. */
    lmn_status (*check)(lmn_error *error);
    /* Before the first frame, when `film.transparent` is known. */
    lmn_status (*begin)(film *f, lmn_error *error);
    /* `rgba` is of the size `film.width`, `film.height`. */
    lmn_status (*add)(film *f, const uint8_t *rgba, lmn_error *error);
    /* After the last frame: all is in the file. */
    lmn_status (*end)(film *f, lmn_error *error);
    /* Frees `film.writing`, whether the film was ended or not. */
    void (*drop)(film *f);
} film_writer;

typedef struct film_format {
    const char        *ending; /* ".mp4" */
    const char        *doc;    /* what it is: one line that ends in a full stop */
    const film_writer *writer;
    film_opacity       opacity;
    bool               even;                        /* sizes are even */
    int                side_most;                   /* pixels */
    int                rate_most;                   /* frames a second */
    const char        *why_rate;                    /* why no more: a hint */
    const char *const *(*arguments)(const film *f); /* what ffmpeg is told of the file; NULL: another writer */
} film_format;

extern const film_format film_formats[];
extern const size_t      film_format_count;

/* A rate as two whole numbers without common divisor. */
typedef struct film_rate {
    long long frames, seconds;
} film_rate;

struct film {
    const film_format *format;
    char              *path; /* for messages */
    file_arrival      *file;
    int                given_width, given_height; /* of the drawings */
    int                width, height;             /* of the frames */
    film_rate          rate;
    uint32_t           frame_count; /* what was said of it; 0: nothing */
    uint32_t           added;
    bool               transparent; /* opacity is kept */
    uint8_t           *frame;       /* a frame that is not the drawing as it is; NULL: not needed yet */
    void              *writing;     /* the writer's own; NULL: not begun */
    bool               failed;      /* nothing more can be added */
    lmn_progress_fn    progress;
    void              *progress_user;
    warnings           warnings;
};

/* The format of a film: `name` with or without the dot, or the path's ending where that is NULL. Errors: LMN_USAGE. */
lmn_status film_choose(const film_format **out, const char *path, const char *name, lmn_error *error);
/* Can it be made in this size, at this rate, here? Errors: LMN_USAGE, LMN_UNSUPPORTED. */
lmn_status film_check(const film_format *format, const char *path, const lmn_film_desc *desc, lmn_error *error);

/* include/limner/film.h has what these do; the description has been checked. */
lmn_status film_open(film **out, const film_format *format, const char *path, const lmn_film_desc *desc,
                     lmn_error *error);
lmn_status film_add(film *f, const uint8_t *rgba, lmn_error *error);
lmn_status film_close(film **handle, uint64_t *bytes, lmn_error *error);
void       film_destroy(film **handle);

/* The frames of ffmpeg, and those of libwebp. */
extern const film_writer film_by_encoder, film_by_webp;

/* lmn_picture_is_whole. */
bool film_picture_is_whole(const char *path, int width, int height);

#endif
