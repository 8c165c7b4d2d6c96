/* Filling an lmn_error. All functions accept a NULL error and return the status, so that a caller can `return`
 * them. */
#ifndef LIMNER_BASE_ERROR_H
#define LIMNER_BASE_ERROR_H

#include "limner/error.h"

/* Sets status and message and clears everything else. */
lmn_status error_set(lmn_error *error, lmn_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The same with the file that is to blame; line 0 means "not known". */
lmn_status error_in_file(lmn_error *error, lmn_status status, const char *file, int line, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/* Adds the file that is to blame to an error that was set before. */
void error_file(lmn_error *error, const char *file);

/* Adds what to do about it to an error that was set before. */
void error_hint(lmn_error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The error for memory that could not be had. */
lmn_status error_memory(lmn_error *error);

#endif
