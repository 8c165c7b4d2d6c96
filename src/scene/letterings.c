#include "scene/letterings.h"

#include <string.h>

#include "base/memory.h"

int letterings_find(const letterings *l, const char *text)
{
    for (size_t i = 0; i < l->count; i++)
        if (strcmp(l->lines[i].text, text) == 0)
            return (int)i;
    return LETTERING_NONE;
}

int letterings_add(letterings *l, const lettering_line *line)
{
    if (!mem_grow((void **)&l->lines, &l->capacity, l->count + 1, sizeof *l->lines))
        return LETTERING_NONE;
    l->lines[l->count++] = *line;
    return (int)l->count - 1;
}

void lettering_line_release(lettering_line *line)
{
    mem_free(line->text);
    mem_free(line->points);
    mem_free(line->triangles);
    memset(line, 0, sizeof *line);
}

void letterings_release(letterings *l)
{
    for (size_t i = 0; i < l->count; i++)
        lettering_line_release(&l->lines[i]);
    mem_free(l->lines);
    memset(l, 0, sizeof *l);
}
