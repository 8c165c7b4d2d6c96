/* The words of OBJ and MTL files. */
#include <string.h>

#include "base/text.h"
#include "import/build.h"
#include "import/obj.h"

void obj_skip_blanks(obj_text *t)
{
    while (t->at < t->end) {
        const char *p = t->at;
        if (*p == ' ' || *p == '\t')
            t->at++;
        else if (*p == '\\' && p + 1 < t->end && p[1] == '\n')
            t->at += 2;
        else if (*p == '\\' && p + 2 < t->end && p[1] == '\r' && p[2] == '\n')
            t->at += 3;
        else
            break;
    }
}

bool obj_at_line_end(obj_text *t)
{
    obj_skip_blanks(t);
    return t->at >= t->end || *t->at == '\n' || *t->at == '\r' || *t->at == '#';
}

void obj_next_line(obj_text *t)
{
    const char *next = t->at < t->end ? memchr(t->at, '\n', (size_t)(t->end - t->at)) : NULL;
    t->at = next ? next + 1 : t->end;
}

bool obj_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

bool obj_word(obj_text *t, const char **word, size_t *length)
{
    if (obj_at_line_end(t))
        return false;
    *word = t->at;
    while (t->at < t->end && !obj_is_blank(*t->at))
        t->at++;
    *length = (size_t)(t->at - *word);
    return true;
}

bool obj_is(const char *word, size_t length, const char *expected)
{
    return strlen(expected) == length && memcmp(word, expected, length) == 0;
}

bool obj_number(obj_text *t, double *out)
{
    if (obj_at_line_end(t))
        return false;
    const char *next = text_parse_double(t->at, t->end, out);
    if (!next)
        return false;
    while (next < t->end && !obj_is_blank(*next))
        next++;
    t->at = next;
    return true;
}

char *obj_rest(obj_text *t)
{
    obj_skip_blanks(t);
    const char *from = t->at;
    while (t->at < t->end && *t->at != '\n' && *t->at != '\r')
        t->at++;
    const char *end = t->at;
    while (end > from && obj_is_blank(end[-1]))
        end--;
    return scene_clean_name(from, (size_t)(end - from));
}

void obj_slash_path(char *path)
{
    for (char *p = path; *p; p++)
        if (*p == '\\')
            *p = '/';
}
