/* The text format of stroke textures (.stx): a line of seven numbers a stroke. Row EX-24. */
#include "stroke_texture/strokes_private.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

enum { FIELDS = 7 };

static const char *const field_names[FIELDS] = {"u0", "v0", "u1", "v1", "light", "perspective", "layer"};

typedef struct reader {
    const char *name, *at, *end; /* of the line, without its comment */
    int         line;
    lmn_error  *error;
} reader;

static void skip_blanks(reader *r)
{
    while (r->at < r->end && (*r->at == ' ' || *r->at == '\t' || *r->at == '\r' || *r->at == '\v' || *r->at == '\f'))
        r->at++;
}

/* The word that the reader stands at, for a message. */
static int word_size(const reader *r)
{
    const char *at = r->at;
    while (at < r->end && (unsigned char)*at > ' ' && at - r->at < 40)
        at++;
    return (int)(at - r->at);
}

static lmn_status refuse(const reader *r, int field, const char *word, int size, const char *allowed)
{
    error_in_file(r->error, LMN_FORMAT, r->name, r->line, "%s is '%.*s'; allowed is %s", field_names[field], size, word,
                  allowed);
    error_hint(r->error, "a line is u0 v0 u1 v1 light perspective layer: six numbers and a whole number");
    return LMN_FORMAT;
}

static lmn_status refuse_count(const reader *r, const char *how_many)
{
    error_in_file(r->error, LMN_FORMAT, r->name, r->line, "%s numbers; a stroke has %d", how_many, FIELDS);
    error_hint(r->error, "a line is u0 v0 u1 v1 light perspective layer, with blanks between");
    return LMN_FORMAT;
}

static lmn_status read_field(reader *r, int field, texture_stroke *out)
{
    double      value = 0;
    const char *word = r->at;
    int         size = word_size(r);
    const char *behind = text_parse_double(word, r->end, &value);
    if (!behind || behind != word + size)
        return refuse(r, field, word, size, "a number");
    float *const positions[] = {&out->u0, &out->v0, &out->u1, &out->v1, &out->light, &out->perspective};
    r->at = behind;
    if (field == FIELDS - 1) {
        if (!(value >= 0 && value < LIMIT_STROKE_LAYERS) || value != floor(value))
            return refuse(r, field, word, size, "a whole number from 0 to 65535");
        out->layer = (int32_t)value;
    } else if (field < 4) {
        if (!(fabs(value) <= LIMIT_STROKE_REACH))
            return refuse(r, field, word, size, "a number from -16 to 16");
        *positions[field] = (float)value;
    } else {
        if (!isfinite((float)value))
            return refuse(r, field, word, size, "a finite number");
        *positions[field] = (float)value;
    }
    return LMN_OK;
}

static lmn_status read_line(reader *r, strokes *out)
{
    texture_stroke item = {0};
    int            field = 0;
    for (skip_blanks(r); r->at < r->end; skip_blanks(r)) {
        if (field == FIELDS)
            return refuse_count(r, "more than seven");
        lmn_status status = read_field(r, field, &item);
        if (status != LMN_OK)
            return status;
        field++;
    }
    static const char *const counts[] = {"no", "one", "two", "three", "four", "five", "six"};
    if (field == 0)
        return LMN_OK;
    if (field < FIELDS)
        return refuse_count(r, counts[field]);
    if (out->count >= LIMIT_STROKES)
        return strokes_too_many(r->name, r->line, r->error);
    return strokes_add(out, item) ? LMN_OK : error_memory(r->error);
}

lmn_status strokes_read(strokes *out, const char *name, const char *bytes, size_t size, lmn_error *error)
{
    static const char mark[] = "\xEF\xBB\xBF"; /* some editors begin UTF-8 with it */
    const char       *at = bytes, *end = bytes + size;
    lmn_status        status = LMN_OK;
    *out = (strokes){.width = 1};
    if (size >= 3 && memcmp(bytes, mark, 3) == 0)
        at += 3;
    for (int line = 1; at < end && status == LMN_OK; line += line < INT_MAX) {
        const char *newline = memchr(at, '\n', (size_t)(end - at));
        const char *line_end = newline ? newline : end;
        const char *comment = memchr(at, '#', (size_t)(line_end - at));
        reader      r = {name, at, comment ? comment : line_end, line, error};
        status = read_line(&r, out);
        at = newline ? newline + 1 : end;
    }
    if (status != LMN_OK)
        strokes_release(out);
    return status;
}

/* The point is whatever the locale says, in one or more bytes. */
static size_t replace_point(char *number)
{
    size_t to = 0;
    for (const char *from = number; *from; from++) {
        if (strchr("0123456789+-e", *from))
            number[to++] = *from;
        else if (to > 0 && number[to - 1] != '.')
            number[to++] = '.';
    }
    number[to] = '\0';
    return to;
}

void stroke_write_number(text *out, float value)
{
    char   number[48];
    size_t size = 0;
    /* Nine digits are always enough. */
    for (int digits = 1; digits <= 9; digits++) {
        double back = 0;
        snprintf(number, sizeof number, "%.*g", digits, (double)value);
        size = replace_point(number);
        text_parse_double(number, number + size, &back);
        if ((float)back == value)
            break;
    }
    text_append_bytes(out, number, size);
}

void strokes_write(text *out, const strokes *s)
{
    text_append(out, "# u0 v0 u1 v1 light perspective layer\n");
    for (size_t i = 0; i < s->count; i++) {
        const texture_stroke *t = &s->items[i];
        const float           numbers[] = {t->u0, t->v0, t->u1, t->v1, t->light, t->perspective};
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
            stroke_write_number(out, numbers[k]);
            text_append_bytes(out, " ", 1);
        }
        text_append(out, "%d\n", (int)t->layer);
    }
}
