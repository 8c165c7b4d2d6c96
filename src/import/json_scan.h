/* Inside the import folder: JSON read where it lies, in one pass and without a tree, for files that are mostly long
 * lists of numbers. Whoever reads asks for what he expects; what is not wanted is skipped at the speed of memory, and
 * then only its brackets and quotes are checked. The first error sticks and sends `at` to the end, so that loops end.
 */
#ifndef LIMNER_IMPORT_JSON_SCAN_H
#define LIMNER_IMPORT_JSON_SCAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* There has to be a NUL byte at `end`. */
typedef struct json_scan {
    const char *at, *end;
    const char *wrong; /* what; NULL: nothing */
    const char *wrong_at;
} json_scan;

/* Bytes of the text. */
typedef struct json_span {
    const char *at;
    size_t      size;
} json_span;

json_scan scan_of(json_span span); /* nothing is an empty text */
void      scan_fail(json_scan *s, const char *what);

/* The next byte that is no blank; 0 at the end. */
char scan_peek(json_scan *s);

/* Into an object or list, and on to the next member or element:
 *   for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}'))
 * False when there is none left, which is an error unless the bracket closes there. */
bool scan_open(json_scan *s, char bracket);
bool scan_next(json_scan *s, char closing);

/* The name of a member and its colon: the bytes between the quotes, as written. */
json_span scan_key(json_scan *s);
/* A value of any kind, left out; its bytes. */
json_span scan_skip(json_scan *s);
/* A text's bytes between the quotes as written; size 0 with at NULL when it is none, which is then skipped. */
json_span scan_string(json_scan *s);
/* A number; false and an error when there is none. */
bool scan_number(json_scan *s, double *out);
/* null, left out. */
bool scan_null(json_scan *s);

bool span_is(json_span span, const char *text);
/* Does it decode to itself: printable ASCII without escapes? */
bool span_is_plain(json_span span);
/* Bytes between quotes as UTF-8 without escapes and control characters, allocated. NULL when memory is gone. */
char *span_decode(json_span span);

#endif
