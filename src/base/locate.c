#include "base/locate.h"

#include "base/text.h"

#include <stdbool.h>
#include <string.h>

static const char *skip_blanks(const char *at, const char *end)
{
    while (at < end && strchr(" \t\r\n,:", *at) && *at)
        at++;
    return at;
}

static const char *skip_string(const char *at, const char *end)
{
    for (at++; at < end && *at != '"'; at++)
        if (*at == '\\')
            at++;
    return at < end ? at + 1 : end;
}

static const char *skip_value(const char *at, const char *end)
{
    int depth = 0;
    while (at < end) {
        if (*at == '"') {
            at = skip_string(at, end);
        } else if (*at == '{' || *at == '[') {
            depth++;
            at++;
        } else if (*at == '}' || *at == ']') {
            if (depth == 0)
                return at;
            depth--;
            at++;
        } else if (depth == 0) {
            while (at < end && !strchr(",]} \t\r\n", *at))
                at++;
            return at;
        } else {
            at++;
            continue;
        }
        if (depth == 0)
            return at;
    }
    return end;
}

static bool is_key(const char *at, const char *end, const char *key)
{
    size_t length = strlen(key);
    return *at == '"' && (size_t)(skip_string(at, end) - at) == length + 2 && memcmp(at + 1, key, length) == 0;
}

/* The value behind one step; `*found` is where the member or element begins. NULL when it is not there. It goes on
 * from what `memo` (may be NULL) has of the same array or object. */
static const char *follow(const char *at, const char *end, const locate_step *step, locate_level *memo,
                          const char **found)
{
    at = skip_blanks(at, end);
    if (at >= end || *at != (step->key ? '{' : '['))
        return NULL;
    const char *container = at++;
    size_t      index = 0;
    if (memo && memo->container == container &&
        (step->key ? is_key(memo->at, end, step->key) : memo->index <= step->index)) {
        at = memo->at;
        index = memo->index;
    }
    for (; (at = skip_blanks(at, end)) < end && *at != '}' && *at != ']'; index++) {
        const char *start = at;
        bool        here = index == step->index;
        if (step->key) {
            here = is_key(at, end, step->key);
            at = skip_blanks(skip_string(at, end), end);
        }
        if (here) {
            *found = start;
            if (memo)
                *memo = (locate_level){container, start, index};
            return at;
        }
        at = skip_value(at, end);
    }
    return NULL;
}

void locate_on(locate_memo *memo, const char *text, size_t size, const locate_step *steps, size_t count, int *line,
               int *column)
{
    const size_t mark = text_byte_order_mark(text, size);
    const char  *end = text + size, *found = skip_blanks(text + mark, end), *value = found;
    for (size_t i = 0; i < count && value; i++)
        value = follow(value, end, &steps[i], i < LOCATE_LEVELS ? &memo->levels[i] : NULL, &found);
    if (!memo->counted || found < memo->counted) {
        memo->counted = text + mark;
        memo->line = memo->column = 1;
    }
    for (; memo->counted < found; memo->counted++) {
        if (*memo->counted == '\n') {
            ++memo->line;
            memo->column = 1;
        } else {
            memo->column += ((unsigned char)*memo->counted & 0xC0) != 0x80;
        }
    }
    *line = memo->line;
    *column = memo->column;
}

void locate(const char *text, size_t size, const locate_step *steps, size_t count, int *line, int *column)
{
    locate_memo memo = {.counted = NULL};
    locate_on(&memo, text, size, steps, count, line, column);
}
