#include "names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool name_has_name(const char *pattern)
{
    return pattern && strstr(pattern, NAME_PLACEHOLDER);
}

bool name_has_frame(const char *pattern)
{
    return pattern && strstr(pattern, FRAME_PLACEHOLDER);
}

const char *name_unknown_placeholder(const char *pattern, int *length)
{
    for (const char *at = pattern ? strchr(pattern, '{') : NULL; at; at = strchr(at + 1, '{')) {
        size_t letters = strspn(at + 1, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-");
        bool   known = strncmp(at, NAME_PLACEHOLDER, strlen(NAME_PLACEHOLDER)) == 0 ||
                     strncmp(at, FRAME_PLACEHOLDER, strlen(FRAME_PLACEHOLDER)) == 0;
        *length = (int)letters + 2;
        if (letters > 0 && at[letters + 1] == '}' && !known)
            return at;
    }
    return NULL;
}

/* First character of the stem and its length. */
static const char *stem_at(const char *path, size_t *length)
{
    const char *end = path + strlen(path);
    while (end > path + 1 && end[-1] == '/')
        end--;
    const char *start = end;
    while (start > path && start[-1] != '/')
        start--;
    const char *dot = end;
    while (dot > start && *dot != '.')
        dot--;
    *length = (size_t)((dot > start ? dot : end) - start);
    return start;
}

char *name_stem(const char *path)
{
    size_t      length;
    const char *start = stem_at(path, &length);
    char       *stem = malloc(length + 1);
    if (stem) {
        memcpy(stem, start, length);
        stem[length] = '\0';
    }
    return stem;
}

char *name_expand(const char *pattern, const char *input, long frame)
{
    char        number[24];
    size_t      stem_length, number_length, size = 1;
    const char *stem = stem_at(input, &stem_length);
    snprintf(number, sizeof number, "%04ld", frame);
    number_length = strlen(number);
    for (const char *at = pattern; *at; at++)
        size += 1 + (*at == '{' ? stem_length + number_length : 0);
    char *result = malloc(size), *to = result;
    for (const char *at = pattern; result && *at;) {
        if (strncmp(at, NAME_PLACEHOLDER, strlen(NAME_PLACEHOLDER)) == 0) {
            memcpy(to, stem, stem_length);
            to += stem_length;
            at += strlen(NAME_PLACEHOLDER);
        } else if (strncmp(at, FRAME_PLACEHOLDER, strlen(FRAME_PLACEHOLDER)) == 0) {
            memcpy(to, number, number_length);
            to += number_length;
            at += strlen(FRAME_PLACEHOLDER);
        } else {
            *to++ = *at++;
        }
    }
    if (result)
        *to = '\0';
    return result;
}

unsigned long name_find_same_stem(const char *const *paths, unsigned long count)
{
    for (unsigned long i = 1; i < count; i++)
        for (unsigned long k = 0; k < i; k++) {
            size_t      a_length, b_length;
            const char *a = stem_at(paths[i], &a_length), *b = stem_at(paths[k], &b_length);
            if (a_length == b_length && strncmp(a, b, a_length) == 0)
                return i;
        }
    return 0;
}
