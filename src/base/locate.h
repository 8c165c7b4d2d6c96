/* Where in a JSON text something stands, so that messages can name line and column of what was parsed long ago. */
#ifndef LIMNER_BASE_LOCATE_H
#define LIMNER_BASE_LOCATE_H

#include <stddef.h>

/* One step into a document: a member's key, or with key NULL an element's index. */
typedef struct locate_step {
    const char *key;
    size_t      index;
} locate_step;

/* Line and column (from 1, in characters) of the member or element at the end of the steps, or of the last one that is
 * there. The text is valid JSON. */
void locate(const char *text, size_t size, const locate_step *steps, size_t count, int *line, int *column);

/* The same many times in one text, each mostly behind the one before: what was found is not searched again.
 * Zero-initialise. */
enum { LOCATE_LEVELS = 64 };
typedef struct locate_level {
    const char *container, *at; /* an array or object, and where its element or member `index` begins */
    size_t      index;
} locate_level;
typedef struct locate_memo {
    locate_level levels[LOCATE_LEVELS];
    const char  *counted; /* lines are counted up to here */
    int          line, column;
} locate_memo;
void locate_on(locate_memo *memo, const char *text, size_t size, const locate_step *steps, size_t count, int *line,
               int *column);

#endif
