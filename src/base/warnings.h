/* Warnings: what was ignored or repaired, for the report. Equal ones are counted, not repeated. */
#ifndef LIMNER_BASE_WARNINGS_H
#define LIMNER_BASE_WARNINGS_H

#include <stdbool.h>
#include <stddef.h>

/* The codes; tests assert these, not the text. */
#define WARNING_CODES(X)                                                                                               \
    X(WARNING_IGNORED, "ignored")           /* valid content that Limner does not use */                               \
    X(WARNING_MISSING_FILE, "missing-file") /* a texture or buffer beside the model */                                 \
    X(WARNING_REFUSED_FILE, "refused-file") /* a file that the model may not have */                                   \
    X(WARNING_BAD_VALUE, "bad-value")       /* a value that was dropped or replaced */                                 \
    X(WARNING_BAD_GEOMETRY, "bad-geometry") /* degenerate triangles, NaN vertices: left out */                         \
    X(WARNING_REDUCED, "reduced")           /* a texture made smaller to keep within limits */                         \
    X(WARNING_BAD_TEXTURE, "bad-texture")   /* an image that cannot be decoded */                                      \
    X(WARNING_TRANSPARENCY, "transparency") /* drawn as a cut-out */                                                   \
    X(WARNING_NO_MATCH, "no-match")         /* a rule that selects nothing */                                          \
    X(WARNING_LAYER_MEMORY, "layer-memory") /* layers were made the slower way */                                      \
    X(WARNING_CUT_OPEN, "cut-open")         /* parts that are not closed have no cut face */                           \
    X(WARNING_BACKGROUND, "background")     /* what a .csg file marks with % and does not count as the model */        \
    X(WARNING_APPROXIMATE, "approximate")   /* drawn nearly as the file means it */                                    \
    X(WARNING_NO_STROKES, "no-strokes")     /* what has no lines in vector drawings */                                 \
    X(WARNING_PAGE, "page")                 /* what does not fit on a sheet, or is not known for it */                 \
    X(WARNING_UP_AXIS, "up-axis")           /* which way is up was guessed, and not as usual */                        \
    X(WARNING_UNUSED, "unused")             /* a setting without effect */                                             \
    X(WARNING_UNTOLD, "untold")             /* what moves and is told by no sign, or by fewer than asked for */

typedef enum warning_code {
#define X(name, text) name,
    WARNING_CODES(X)
#undef X
        WARNING_CODE_COUNT
} warning_code;

typedef struct warning {
    warning_code code;
    char        *text;
    size_t       count;
} warning;

/* Zero-initialise. */
typedef struct warnings {
    warning *items;
    size_t   count, capacity;
} warnings;

const char *warning_code_text(warning_code code);
/* Adds a warning, of which the log is told, or counts it again. When memory is gone it is dropped: a warning is never
 * worth an error. */
void warnings_add(warnings *list, warning_code code, const char *format, ...) __attribute__((format(printf, 3, 4)));
/* Makes one warning of all of a code that begin alike, if there are several: how many there are of what, and the first.
 */
void warnings_fold(warnings *list, warning_code code, const char *beginning, const char *what);
void warnings_append(warnings *list, const warnings *more);
void warnings_release(warnings *list);

#endif
