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

#endif
