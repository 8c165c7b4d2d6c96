#include "base/locate.h"

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

/* The value behind one step; `*found` is where the member or element begins. NULL when it is not there. */
static const char *follow(const char *at, const char *end, const locate_step *step, const char **found)
{
    at = skip_blanks(at, end);
    if (at >= end || *at != (step->key ? '{' : '['))
        return NULL;
    at++;
    for (size_t index = 0; (at = skip_blanks(at, end)) < end && *at != '}' && *at != ']'; index++) {
        const char *start = at;
        bool        here = index == step->index;
        if (step->key) {
            at = skip_string(at, end);
            size_t length = strlen(step->key);
            here = (size_t)(at - start) == length + 2 && memcmp(start + 1, step->key, length) == 0;
            at = skip_blanks(at, end);
        }
        if (here) {
            *found = start;
            return at;
        }
        at = skip_value(at, end);
    }
    return NULL;
}

void locate(const char *text, size_t size, const locate_step *steps, size_t count, int *line, int *column)
{
    const char *end = text + size, *found = skip_blanks(text, end), *value = found;
    for (size_t i = 0; i < count && value; i++)
        value = follow(value, end, &steps[i], &found);
    *line = 1;
    *column = 1;
    for (const char *at = text; at < found; at++) {
        if (*at == '\n') {
            ++*line;
            *column = 1;
        } else {
            *column += ((unsigned char)*at & 0xC0) != 0x80;
        }
    }
}
