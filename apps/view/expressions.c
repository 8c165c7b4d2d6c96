#include "expressions.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- text and JSON ----------------------------------------------------------------------------------------- */

static void fail(lmn_error *error, lmn_status status, const char *format, ...) G_GNUC_PRINTF(3, 4);
static void fail(lmn_error *error, lmn_status status, const char *format, ...)
{
    va_list arguments;
    *error = (lmn_error){.status = status};
    va_start(arguments, format);
    g_vsnprintf(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
}

static json_t *parse(const char *list)
{
    json_t *array = list ? json_loads(list, 0, NULL) : NULL;
    return array ? array : json_array();
}

/* The fewest digits that give the same number again. */
static void append_number(GString *out, double number)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    for (int digits = 1; digits <= 17; digits++) {
        char format[8];
        g_snprintf(format, sizeof format, "%%.%dg", digits);
        g_ascii_formatd(text, sizeof text, format, number);
        if (g_ascii_strtod(text, NULL) == number)
            break;
    }
    g_string_append(out, text);
}

static void append_value(GString *out, const json_t *value)
{
    if (json_is_real(value)) {
        append_number(out, json_real_value(value));
        return;
    }
    char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT);
    g_string_append(out, text ? text : "null");
    free(text);
}

/* One expression a line, as people write them. */
static char *text_of(json_t *array, const char *indent)
{
    GString      *out = g_string_new("[");
    size_t        i;
    const json_t *one, *value;
    const char   *key;
    json_array_foreach(array, i, one)
    {
        bool first = true;
        g_string_append_printf(out, "%s\n%s  {", i ? "," : "", indent);
        json_object_foreach((json_t *)one, key, value)
        {
            json_t *name = json_string(key);
            g_string_append(out, first ? "" : ", ");
            append_value(out, name);
            g_string_append(out, ": ");
            append_value(out, value);
            json_decref(name);
            first = false;
        }
        g_string_append(out, "}");
    }
    if (json_array_size(array))
        g_string_append_printf(out, "\n%s", indent);
    g_string_append(out, "]");
    return g_string_free(out, FALSE);
}

/* Takes the array. */
static char *list_of(json_t *array)
{
    char *text = text_of(array, ""), *list = g_ref_string_new(text);
    g_free(text);
    json_decref(array);
    return list;
}

/* --- where they come from ---------------------------------------------------------------------------------- */

char *expressions_of_file(const char *path, double *time_s)
{
    json_t *root = g_str_has_suffix(path, ".json") ? json_load_file(path, 0, NULL) : NULL,
           *array = json_object_get(root, "limner_script") ? json_object_get(root, "expressions") : NULL,
           *time = json_object_get(json_object_get(root, "depiction"), "time");
    char *list = json_is_array(array) ? list_of(json_incref(array)) : NULL;
    *time_s = json_is_number(time) ? json_number_value(time) : -1;
    json_decref(root);
    return list;
}

bool expressions_is_script(const char *path)
{
    json_t    *root = g_str_has_suffix(path, ".json") ? json_load_file(path, 0, NULL) : NULL;
    const bool is = json_object_get(root, "limner_script") != NULL;
    json_decref(root);
    return is;
}

char *expressions_told(const char *json)
{
    json_t *root = json ? json_loads(json, 0, NULL) : NULL, *array = json_object_get(root, "expressions"), *one;
    size_t  i;
    json_array_foreach(array, i, one) json_object_del(one, "now");
    char *list = json_is_array(array) ? list_of(json_incref(array)) : NULL;
    json_decref(root);
    return list;
}

/* --- lists --------------------------------------------------------------------------------------------------- */

guint expressions_count(const char *list)
{
    json_t     *array = parse(list);
    const guint count = (guint)json_array_size(array);
    json_decref(array);
    return count;
}

expressions_read *expressions_open(const char *list)
{
    return parse(list);
}

void expressions_close(expressions_read *r)
{
    json_decref(r);
}

char *expressions_get(const char *list, guint index, const char *key)
{
    json_t *array = parse(list);
    char   *out = expressions_member(array, index, key);
    json_decref(array);
    return out;
}

char *expressions_member(const expressions_read *array, guint index, const char *key)
{
    const json_t *value = json_object_get(json_array_get(array, index), key);
    GString      *out = g_string_new(NULL);
    if (json_is_string(value))
        g_string_append(out, json_string_value(value));
    else if (value)
        append_value(out, value);
    return g_string_free(out, value == NULL);
}

static json_t *value_of(lmn_param_type type, const char *text)
{
    char        *end;
    const double number = g_ascii_strtod(text, &end);
    switch (type) {
    case LMN_PARAM_BOOL: return strcmp(text, "true") == 0 ? json_true() : json_false();
    case LMN_PARAM_INT:
    case LMN_PARAM_FLOAT:
        if (end == text || *end || !isfinite(number))
            return NULL;
        return number == trunc(number) && fabs(number) < 1e15 ? json_integer((json_int_t)number) : json_real(number);
    default: return json_string(text);
    }
}

char *expressions_set(const char *list, guint index, const char *key, lmn_param_type type, const char *value,
                      lmn_error *error)
{
    json_t *array = parse(list), *one = json_array_get(array, index);
    if (!value)
        json_object_del(one, key);
    else if (json_object_set_new(one, key, value_of(type, value)) != 0) {
        fail(error, LMN_USAGE, "%s is no such value: %.60s", key, value);
        json_decref(array);
        return NULL;
    }
    return list_of(array);
}

char *expressions_added(const char *list, const char *target, const char *depict)
{
    json_t *array = parse(list);
    json_array_append_new(array, json_pack("{s:s,s:s}", "target", target, "depict", depict));
    return list_of(array);
}

char *expressions_removed(const char *list, guint index)
{
    json_t *array = parse(list);
    json_array_remove(array, index);
    return list_of(array);
}

bool expressions_depiction(const char *list, guint index, size_t *out)
{
    char              *name = expressions_get(list, index, "depict");
    lmn_depiction_info info;
    bool               found = false;
    for (size_t i = 0; name && !found && lmn_depiction_at(i, &info); i++) {
        found = !info.semantics && strcmp(info.name, name) == 0;
        *out = i;
    }
    g_free(name);
    return found;
}

/* --- saving -------------------------------------------------------------------------------------------------- */

static const char *skip_blanks(const char *at)
{
    while (*at && strchr(" \t\r\n", *at))
        at++;
    return at;
}

/* Behind a text, a list or object, or another value of valid JSON. */
static const char *skip_value(const char *at)
{
    int depth = 0;
    if (!strchr("\"{[", *at))
        return at + strcspn(at, ",}] \t\r\n");
    do {
        if (*at == '"')
            for (at++; *at && *at != '"'; at++)
                at += *at == '\\' && at[1];
        depth += (*at == '{' || *at == '[') - (*at == '}' || *at == ']');
        at += *at != '\0';
    } while (*at && depth > 0);
    return at;
}

/* Of an object: where the value of a member begins; NULL: it has none. `last` gets where its last value ends. */
static const char *find_member(const char *text, const char *name, const char **last)
{
    char       *wanted = g_strdup_printf("\"%s\"", name);
    const char *at = skip_blanks(text) + 1, *found = NULL;
    *last = NULL;
    for (at = skip_blanks(at); *at == '"' && !found; at = skip_blanks(at)) {
        const char *key = at, *value = skip_blanks(skip_blanks(skip_value(at)) + 1);
        if (strncmp(key, wanted, strlen(wanted)) == 0)
            found = value;
        *last = skip_value(value);
        at = skip_blanks(*last);
        at += *at == ',';
    }
    g_free(wanted);
    return found;
}

static char *with_expressions(const char *script, const char *array)
{
    const char *last, *begin = find_member(script, "expressions", &last);
    GString    *out = g_string_new(NULL);
    if (begin) {
        g_string_append_len(out, script, begin - script);
        g_string_append(out, array);
        g_string_append(out, skip_value(begin));
    } else {
        const char *at = last ? last : skip_blanks(script) + 1;
        g_string_append_len(out, script, at - script);
        g_string_append_printf(out, "%s\n  \"expressions\": %s", last ? "," : "", array);
        g_string_append(out, at);
    }
    return g_string_free(out, FALSE);
}

bool expressions_save(const char *list, const char *path, lmn_error *error)
{
    char   *script = NULL;
    GError *wrong = NULL;
    json_t *array = parse(list);
    json_t *root = g_file_get_contents(path, &script, NULL, NULL) ? json_loads(script, 0, NULL) : NULL;
    bool    is_script = json_is_object(root) && json_object_get(root, "limner_script"), done = false;
    char   *text = text_of(array, is_script ? "  " : "");
    char   *whole = is_script ? with_expressions(script, text) : g_strconcat(text, "\n", NULL);
    if (is_script && json_equal(json_object_get(root, "expressions"), array))
        done = true; /* as they are written there */
    else if (root && !is_script && !json_is_array(root))
        fail(error, LMN_USAGE, "%s is no script, and no list of expressions: it stays as it is", path);
    else
        done = g_file_set_contents(path, whole, -1, &wrong);
    if (wrong)
        fail(error, LMN_WRITE, "%s", wrong->message);
    g_clear_error(&wrong);
    g_free(whole);
    g_free(text);
    g_free(script);
    json_decref(root);
    json_decref(array);
    return done;
}
