/* Lists of strokes. */
#include "stroke_texture/strokes_private.h"

#include <string.h>

#include "base/memory.h"

bool strokes_add(strokes *s, texture_stroke item)
{
    if (!mem_grow((void **)&s->items, &s->capacity, s->count + 1, sizeof *s->items))
        return false;
    s->items[s->count++] = item;
    return true;
}

void strokes_release(strokes *s)
{
    mem_free(s->items);
    *s = (strokes){.width = 1};
}

/* A start just below 0 would become 1 by rounding, which is outside again: it stays where it is then, at 0. */
static void wrap_axis(float *start, float *end)
{
    float shift = floorf(*start);
    if (shift == 0)
        return;
    if (*start - shift >= 1) {
        *start = 0;
        shift = 0;
    }
    *start -= shift;
    *end -= shift;
}

void strokes_wrap(strokes *s)
{
    for (size_t i = 0; i < s->count; i++) {
        wrap_axis(&s->items[i].u0, &s->items[i].u1);
        wrap_axis(&s->items[i].v0, &s->items[i].v1);
    }
}

double stroke_length(const texture_stroke *s)
{
    return hypot((double)s->u1 - (double)s->u0, (double)s->v1 - (double)s->v0);
}

int32_t strokes_layer_count(const strokes *s)
{
    int32_t count = 0;
    for (size_t i = 0; i < s->count; i++)
        if (s->items[i].layer >= count)
            count = s->items[i].layer + 1;
    return count;
}

/* Wrapping moves whole chords by whole numbers, with a rounding each. */
static bool same_position(float a, float b)
{
    float apart = a - b;
    return fabsf(apart - roundf(apart)) < 2e-6f;
}

bool stroke_goes_on(const texture_stroke *one, const texture_stroke *next)
{
    bool dots = (one->u0 == one->u1 && one->v0 == one->v1) || (next->u0 == next->u1 && next->v0 == next->v1);
    return !dots && one->layer == next->layer && same_position(one->u1, next->u0) && same_position(one->v1, next->v0);
}

lmn_status strokes_too_many(const char *name, int line, lmn_error *error)
{
    return error_in_file(error, LMN_LIMIT, name, line, "more than %d strokes", LIMIT_STROKES);
}
