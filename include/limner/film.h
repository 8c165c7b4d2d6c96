/* Films: drawings at times that follow each other, in one file. H.264, VP9 and GIF are made by the program `ffmpeg`
 * where it is installed; animated WebP needs nothing. */
#ifndef LIMNER_FILM_H
#define LIMNER_FILM_H

#include "limner/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lmn_film lmn_film;

/* What is to be filmed. Initialise with LMN_FILM_DESC_INIT. */
typedef struct lmn_film_desc {
    size_t          struct_size;
    int             width, height; /* of each frame, pixels; 1 … 16384 */
    double          rate;          /* frames a second, 0.001 … what the format has */
    uint32_t        frame_count;   /* at most; 0: not known, and then each frame of a GIF has a palette of its own */
    const char     *format;        /* ".mp4", with or without the dot; NULL: the path's ending */
    lmn_progress_fn progress;      /* asked in all calls whether to go on; NULL: never cancels */
    void           *progress_user;
} lmn_film_desc;
#define LMN_FILM_DESC_INIT                                                                                             \
    {                                                                                                                  \
        sizeof(lmn_film_desc), 1024, 1024, 24.0, 0, NULL, NULL, NULL                                                   \
    }

/* A format of films. Texts last. */
typedef struct lmn_film_format_info {
    const char *ending;  /* ".mp4" */
    const char *doc;     /* what it is, in a line */
    const char *program; /* that must be installed, "ffmpeg"; NULL: none */
    const char *package; /* of Debian that brings it; NULL: none */
    bool        usable;  /* here and now: the program is on the PATH, or this build has what it takes */
} lmn_film_format_info;
/* One format by index from 0, for lists. False when out of range. Any thread. */
LMN_API bool lmn_film_format_at(size_t index, lmn_film_format_info *out);

/* Would opening this film be refused, as far as that can be told without touching the file? For those who have much
 * to do before. Errors: LMN_USAGE (desc, format, size, rate), LMN_UNSUPPORTED (what makes the format is not here). */
LMN_API lmn_status lmn_film_check(const char *path, const lmn_film_desc *desc, lmn_error *error);

/* Begins a film; one thread at a time uses it. End it with lmn_film_close, or lmn_film_destroy to leave nothing of it.
 * Errors: those of lmn_film_check, LMN_WRITE (a folder that is missing, a pipe), LMN_MEMORY, LMN_CANCELLED. */
LMN_API lmn_status lmn_film_open(lmn_film **out, const char *path, const lmn_film_desc *desc, lmn_error *error);

/* Adds a frame of the film's size: RGBA, 8 bits, sRGB, straight alpha, row 0 on top, as lmn_drawing_pixels has it.
 * After an error nothing more can be added. Errors: LMN_WRITE (the program failed, the disk is full), LMN_MEMORY,
 * LMN_CANCELLED, LMN_LIMIT (time). */
LMN_API lmn_status lmn_film_add(lmn_film *film, const uint8_t *rgba, lmn_error *error);

/* Finishes the film, gives the file its name, and sets the handle to NULL in any case: the file is whole, or it is
 * not there. `bytes` (may be NULL) gets its size. Errors: as lmn_film_add, LMN_USAGE (no frame). */
LMN_API lmn_status lmn_film_close(lmn_film **film, uint64_t *bytes, lmn_error *error);

/* Ends a film that is not finished: what there is of it goes, and so does the program that makes it. Sets the handle
 * to NULL; NULL and a pointer to NULL are accepted. */
LMN_API void lmn_film_destroy(lmn_film **film);

/* How many warnings there are so far, and one of them as text (borrowed; NULL when out of range). */
LMN_API size_t      lmn_film_warning_count(const lmn_film *film);
LMN_API const char *lmn_film_warning_at(const lmn_film *film, size_t index, const char **code, size_t *count);

/* Is there a PNG of this size, whole to its last byte? For who goes on with numbered pictures where an earlier run was
 * broken off. False also when memory is gone. */
LMN_API bool lmn_picture_is_whole(const char *path, int width, int height);

#ifdef __cplusplus
}
#endif
#endif
