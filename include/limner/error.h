/* Errors: every fallible call returns an lmn_status and fills an lmn_error the caller owns. */
#ifndef LIMNER_ERROR_H
#define LIMNER_ERROR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define LMN_API __attribute__((visibility("default")))

/* What kind of thing went wrong. The command maps these to its exit status. */
typedef enum lmn_status {
    LMN_OK = 0,
    LMN_USAGE,       /* an argument is wrong: unknown name, value out of range, empty size */
    LMN_READ,        /* a file is missing or cannot be read */
    LMN_FORMAT,      /* a file's content is wrong */
    LMN_LIMIT,       /* a documented limit for untrusted input is exceeded */
    LMN_UNSUPPORTED, /* valid input that this build cannot handle */
    LMN_WRITE,       /* an output cannot be written */
    LMN_GL,          /* no usable OpenGL, or the driver failed */
    LMN_MEMORY,      /* out of memory */
    LMN_CANCELLED,   /* the progress callback asked to stop */
    LMN_INTERNAL     /* a defect of Limner itself */
} lmn_status;

/* One error. Fixed size and without allocation, so that it works when memory is gone.
 * Unused text is empty, unused numbers are 0. */
typedef struct lmn_error {
    lmn_status status;
    char       message[512]; /* what is wrong, the value found, what is allowed */
    char       file[512];    /* which file, when one is to blame */
    int        line, column; /* 1-based */
    char       hint[256];    /* what to do about it */
} lmn_error;

/* The name of a status in words ("cannot be read"). Never NULL. Any thread. */
LMN_API const char *lmn_status_text(lmn_status status);

/* Called during long work with the fraction done (0..1) and the name of the stage (borrowed for the call).
 * Return false to cancel: the work stops soon and returns LMN_CANCELLED. */
typedef bool (*lmn_progress_fn)(double fraction, const char *stage, void *user);

#ifdef __cplusplus
}
#endif
#endif
