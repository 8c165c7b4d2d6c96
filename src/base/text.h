/* Text: growing strings, numbers that ignore the locale, globs, and the nearest name for a message. */
#ifndef LIMNER_BASE_TEXT_H
#define LIMNER_BASE_TEXT_H

#include <stdbool.h>
#include <stddef.h>

/* A growing string. Zero-initialise; the first failure sticks in `failed` and later appends do nothing. */
typedef struct text {
    char  *data; /* NUL-terminated, or NULL when empty */
    size_t size, capacity;
    bool   failed;
} text;

void text_append(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
void text_append_bytes(text *t, const char *bytes, size_t size);
void text_release(text *t);
/* Hands the string over (free with mem_free); NULL when an append failed. */
char *text_take(text *t);

/* Parses a decimal number ("-1.5e3", "nan" and "inf" in any case) whatever the locale. Returns the end of the
 * number, or NULL when `from` starts with none. Reads no further than `end`. No leading blanks. */
const char *text_parse_double(const char *from, const char *end, double *out);
const char *text_parse_int(const char *from, const char *end, long long *out);
/* The whole string must be the number. */
bool text_is_double(const char *whole, double *out);
bool text_is_int(const char *whole, long long *out);
/* A number that printf has printed, with a point as C has it: the host's decimal point may be any bytes, and all that
 * is no part of a C number is that point. `out` has room for as many characters. */
void text_with_point(char *out, const char *printed);

/* Shell-like match: '*' any run, '?' one character. Case-sensitive. */
bool text_glob(const char *pattern, const char *subject);
/* Is the string valid UTF-8? */
bool text_is_utf8(const char *bytes, size_t size);
/* How many bytes of a byte order mark the text begins with: 3 or 0. */
size_t text_byte_order_mark(const char *bytes, size_t size);
/* The candidate nearest to `name` by edit distance, or NULL when none is near enough to suggest. */
const char *text_nearest(const char *name, const char *const *candidates, size_t count);

/* Control characters but line ends and tabs become "\x1b", those that turn text round "\u202e", and bytes that are no
 * whole UTF-8 go, such as those of a character that was cut, so that what files have in their names and texts is shown
 * and not done. `size` is the array's; what has no room is cut off. */
void text_escape_controls(char *text, size_t size);

#endif
