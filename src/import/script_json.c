#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/colour.h"
#include "base/memory.h"
#include "base/text.h"
#include "import/script.h"

lmn_status script_fail(script_reader *r, lmn_status status, const char *format, ...)
{
    if (r->status != LMN_OK)
        return r->status;
    char    message[400];
    int     line = 0, column = 0;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    locate((const char *)r->file->data.data, r->file->data.size, r->steps, r->step_count, &line, &column);
    r->status = error_in_file(r->error, status, r->file->path, line, "%s", message);
    if (r->error)
        r->error->column = column;
    return r->status;
}

bool script_out_of_memory(script_reader *r)
{
    if (r->status == LMN_OK)
        r->status = error_memory(r->error);
    return false;
}

bool script_enter(script_reader *r, const char *key, size_t index)
{
    if (r->step_count == SCRIPT_STEPS_MAX)
        script_fail(r, LMN_LIMIT, "nested deeper than %d levels", SCRIPT_STEPS_MAX);
    if (r->status != LMN_OK)
        return false;
    r->steps[r->step_count++] = (locate_step){key, index};
    return true;
}

void script_leave(script_reader *r)
{
    r->step_count--;
}

static const char *type_name(json_type type)
{
    switch (type) {
    case JSON_OBJECT: return "an object";
    case JSON_ARRAY: return "an array";
    case JSON_STRING: return "a text";
    case JSON_TRUE: return "true or false";
    default: return "a number";
    }
}

json_t *script_member(script_reader *r, json_t *object, const char *key, json_type type)
{
    json_t *value = r->status == LMN_OK ? json_object_get(object, key) : NULL;
    if (!value)
        return NULL;
    bool fits = type == JSON_REAL   ? json_is_number(value)
                : type == JSON_TRUE ? json_is_boolean(value)
                                    : json_typeof(value) == type;
    if (fits)
        return value;
    if (script_enter(r, key, 0)) {
        script_fail(r, LMN_FORMAT, "'%s' has to be %s", key, type_name(type));
        script_leave(r);
    }
    return NULL;
}

static bool is_word(const char *words, const char *key)
{
    size_t length = strlen(key);
    for (const char *at = words; length && (at = strstr(at, key)); at += length)
        if ((at == words || at[-1] == ' ') && (at[length] == ' ' || !at[length]))
            return true;
    return false;
}

void script_check_keys(script_reader *r, json_t *object, const char *words)
{
    const char *key;
    json_t     *value;
    json_object_foreach(object, key, value)
    {
        if (is_word(words, key) || strcmp(key, "doc") == 0 || !script_enter(r, key, 0))
            continue;
        script_fail(r, LMN_FORMAT, "'%.60s' is not known here", key);
        if (r->error)
            error_hint(r->error, "known are: %.200s", words);
        script_leave(r);
        return;
    }
}

bool script_number(script_reader *r, json_t *object, const char *key, double unit, double *out)
{
    json_t *value = script_member(r, object, key, JSON_REAL);
    if (!value)
        return false;
    double number = json_number_value(value) * unit;
    if (isfinite(number) && fabs(number) <= 1e18) {
        *out = number;
        return true;
    }
    if (script_enter(r, key, 0)) {
        script_fail(r, LMN_FORMAT, "'%s' is too large", key);
        script_leave(r);
    }
    return false;
}

bool script_vector(script_reader *r, json_t *object, const char *key, size_t count, double unit, double *out)
{
    json_t *value = r->status == LMN_OK ? json_object_get(object, key) : NULL;
    bool    right = json_is_array(value) && json_array_size(value) == count;
    for (size_t i = 0; right && i < count; i++) {
        double number = json_number_value(json_array_get(value, i)) * unit;
        right = json_is_number(json_array_get(value, i)) && isfinite(number) && fabs(number) <= 1e18;
        if (right)
            out[i] = number;
    }
    if (value && !right && script_enter(r, key, 0)) {
        script_fail(r, LMN_FORMAT, "'%s' has to be %zu numbers", key, count);
        script_leave(r);
    }
    return right;
}

bool script_flag(script_reader *r, json_t *object, const char *key)
{
    return json_is_true(script_member(r, object, key, JSON_TRUE));
}

const char *script_text(script_reader *r, json_t *object, const char *key)
{
    json_t *value = script_member(r, object, key, JSON_STRING);
    return value ? json_string_value(value) : NULL;
}

int script_choice(script_reader *r, json_t *object, const char *key, const char *const *words, int otherwise)
{
    const char *text = script_text(r, object, key);
    size_t      count = 0;
    for (; text && words[count]; count++)
        if (strcmp(words[count], text) == 0)
            return (int)count;
    if (text && script_enter(r, key, 0)) {
        const char *nearest = text_nearest(text, words, count);
        char        all[300] = "";
        size_t      used = 0;
        for (size_t i = 0; i < count && used < sizeof all; i++)
            used += (size_t)snprintf(all + used, sizeof all - used, "%s%s", i ? ", " : "", words[i]);
        script_fail(r, LMN_FORMAT, "'%s' cannot be '%.60s'; it is one of %s%s%s%s", key, text, all,
                    nearest ? "; did you mean '" : "", nearest ? nearest : "", nearest ? "'?" : "");
        script_leave(r);
    }
    return otherwise;
}

bool script_colour(script_reader *r, json_t *value, double out[3])
{
    colour parsed;
    if (!json_is_string(value) || !colour_parse(json_string_value(value), &parsed)) {
        script_fail(r, LMN_FORMAT, "a colour is a text such as \"#c03020\"");
        return false;
    }
    const float encoded[3] = {parsed.r, parsed.g, parsed.b};
    for (int k = 0; k < 3; k++)
        out[k] = (double)colour_to_linear(encoded[k]);
    return true;
}
