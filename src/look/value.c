#include "look/value.h"
#include "look/selector.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"

static int append(const char *bytes, size_t size, void *user)
{
    text *t = user;
    text_append_bytes(t, bytes, size);
    return t->failed ? -1 : 0;
}

/* Nine digits tell any two floats apart. */
static bool dump(text *out, const json_t *json, size_t flags)
{
    return json_dump_callback(json, append, out, flags | JSON_REAL_PRECISION(9)) == 0 && !out->failed;
}

char *value_text(json_t *json)
{
    text out = {0};
    bool done = json && dump(&out, json, JSON_INDENT(2));
    json_decref(json);
    text_append(&out, "\n");
    if (done)
        return text_take(&out);
    text_release(&out);
    return NULL;
}

/* Is a character part of a number in JSON? */
static bool is_of_number(char c)
{
    return (c >= '0' && c <= '9') || (c && strchr("+-.eE", c));
}

/* As JSON's readers have it, rounded to the nearest double. */
static double number_in(const char *text, size_t size)
{
    json_t      *read = json_loadb(text, size, JSON_DECODE_ANY, NULL);
    const double number = json_number_value(read);
    json_decref(read);
    return number;
}

/* The fewest digits that give the same number again; `printed` ends where the number does. */
static void append_shortest(text *out, const char *printed, const char *end)
{
    const double number = number_in(printed, (size_t)(end - printed));
    char         shorter[40], plain[40];
    for (int digits = 1; digits <= 17; digits++) {
        snprintf(shorter, sizeof shorter, "%.*g", digits, number);
        text_with_point(plain, shorter);
        if (number_in(plain, strlen(plain)) == number)
            break;
    }
    text_append(out, "%s%s", plain, strpbrk(plain, ".e") ? "" : ".0"); /* it stays a real number */
}

static void append_exactly(text *out, const char *json)
{
    bool quoted = false;
    for (const char *at = json; *at;) {
        const char *end = at + 1;
        if (*at == '"')
            quoted = !quoted;
        else if (quoted && *at == '\\' && at[1])
            end++;
        else if (!quoted && is_of_number(*at) && (*at == '-' || (*at >= '0' && *at <= '9'))) {
            bool real = false;
            for (end = at; is_of_number(*end); end++)
                real = real || *end == '.' || *end == 'e' || *end == 'E';
            if (real) {
                append_shortest(out, at, end);
                at = end;
                continue;
            }
        }
        text_append_bytes(out, at, (size_t)(end - at));
        at = end;
    }
}

char *value_text_exact(json_t *json)
{
    text printed = {0}, out = {0};
    bool done = json && json_dump_callback(json, append, &printed, JSON_INDENT(2) | JSON_REAL_PRECISION(17)) == 0 &&
                !printed.failed;
    json_decref(json);
    if (done)
        append_exactly(&out, printed.data);
    text_append(&out, "\n");
    text_release(&printed);
    if (done)
        return text_take(&out);
    text_release(&out);
    return NULL;
}

/* A choice that was yes or no once has these among its names, and files go on saying them without quotes. */
static bool names_truth(const param *p)
{
    for (size_t i = 0; p->names[i]; i++)
        if (strcmp(p->names[i], "true") == 0)
            return true;
    return false;
}

static const char *wanted_type(const param *p)
{
    switch (p->type) {
    case PARAM_INT: return "a whole number";
    case PARAM_FLOAT:
        if (p->unit == UNIT_PT)
            return p->can_auto ? "a number of points, a length as \"0.5mm\", or \"auto\""
                               : "a number of points or a length as \"0.5mm\"";
        return p->can_auto ? "a number or \"auto\"" : "a number";
    case PARAM_BOOL: return "true or false";
    case PARAM_ENUM: return names_truth(p) ? "true, false or a name in quotes" : "a name in quotes";
    case PARAM_COLOUR: return "a colour in quotes";
    case PARAM_DIRECTION: return "an array of three numbers";
    case PARAM_PALETTE: return "an array of colours";
    case PARAM_TEXT: return "a text in quotes";
    }
    return "another type";
}

/* Only the parameter's own type is taken from a file: "3" is no number there. */
static bool has_type(const param *p, const json_t *json)
{
    switch (p->type) {
    case PARAM_INT: return json_is_integer(json);
    case PARAM_FLOAT: return json_is_number(json) || ((p->can_auto || p->unit == UNIT_PT) && json_is_string(json));
    case PARAM_BOOL: return json_is_boolean(json);
    case PARAM_ENUM: return json_is_string(json) || (json_is_boolean(json) && names_truth(p));
    case PARAM_TEXT:
    case PARAM_COLOUR: return json_is_string(json);
    case PARAM_DIRECTION: return json_is_string(json) || json_array_size(json) == 3;
    case PARAM_PALETTE: return json_is_string(json) || json_is_array(json);
    }
    return false;
}

static bool append_element(text *out, const param *p, const json_t *json)
{
    if (json_is_string(json) && p->type != PARAM_DIRECTION) {
        text_append(out, "%s", json_string_value(json));
        return true;
    }
    if (!json_is_number(json) || p->type == PARAM_PALETTE)
        return false;
    if (json_dump_callback(json, append, out, JSON_ENCODE_ANY) != 0)
        out->failed = true; /* nothing else can go wrong with a number */
    return true;
}

/* False when an element of an array has another type. */
static bool value_as_text(text *out, const param *p, const json_t *json)
{
    if (json_is_string(json))
        text_append(out, "%s", json_string_value(json));
    else if (json_is_boolean(json))
        text_append(out, "%s", json_is_true(json) ? "true" : "false");
    else if (json_is_number(json))
        return append_element(out, p, json);
    for (size_t i = 0; i < json_array_size(json); i++) {
        text_append(out, "%s", i ? "," : "");
        if (!append_element(out, p, json_array_get(json, i)))
            return false;
    }
    return true;
}

lmn_status value_set_text(const param *p, void *values, const char *given, lmn_error *error)
{
    if (p->is_selector && given[0]) {
        selector  *tried = NULL;
        lmn_error  inner = {0};
        lmn_status status = selector_parse(&tried, given, &inner);
        selector_destroy(&tried);
        if (status != LMN_OK) { /* messages begin with the parameter: callers put its kind before */
            error_set(error, status, "%s: %s", p->key, inner.message);
            error_hint(error, "%s", inner.hint);
            return status;
        }
    }
    return param_set_text(p, values, given, error);
}

lmn_status value_set_json(const param *p, void *values, const json_t *json, lmn_error *error)
{
    text       as_text = {0};
    lmn_status status;
    bool       typed = has_type(p, json) && value_as_text(&as_text, p, json);
    if (as_text.failed)
        status = error_memory(error);
    else if (!typed)
        status = error_set(error, LMN_USAGE, "%s must be %s", p->key, wanted_type(p));
    else
        status = value_set_text(p, values, as_text.data ? as_text.data : "", error);
    text_release(&as_text);
    return status;
}

json_t *value_number(double number)
{
    if (number == trunc(number) && fabs(number) < 1e15)
        return json_integer((json_int_t)number);
    return json_real(number);
}

static json_t *number_of_text(const char *printed)
{
    double number = 0;
    text_is_double(printed, &number);
    return value_number(number);
}

/* "a,b,c" as an array of numbers or of strings. */
static json_t *array_of_text(const char *printed, bool numbers)
{
    json_t *array = json_array();
    for (const char *at = printed; array && *at;) {
        char   word[48];
        size_t length = strcspn(at, ",");
        size_t kept = length < sizeof word ? length : sizeof word - 1;
        memcpy(word, at, kept);
        word[kept] = '\0';
        if (json_array_append_new(array, numbers ? number_of_text(word) : json_string(word)) != 0) {
            json_decref(array);
            return NULL;
        }
        at += length + (at[length] == ',');
    }
    return array;
}

json_t *value_json(const param *p, const void *values)
{
    char printed[PARAM_TEXT_MAX];
    param_print(p, values, printed, sizeof printed);
    if (param_is_auto(p, values))
        return json_string(printed);
    switch (p->type) {
    case PARAM_INT:
    case PARAM_FLOAT: return number_of_text(printed);
    case PARAM_BOOL: return json_boolean(*(const bool *)param_field(p, values));
    case PARAM_ENUM:
        if (names_truth(p) && (strcmp(printed, "true") == 0 || strcmp(printed, "false") == 0))
            return json_boolean(printed[0] == 't');
        return json_string(printed);
    case PARAM_TEXT:
    case PARAM_COLOUR: return json_string(printed);
    case PARAM_DIRECTION: return array_of_text(printed, true);
    case PARAM_PALETTE: return array_of_text(printed, false);
    }
    return NULL;
}
