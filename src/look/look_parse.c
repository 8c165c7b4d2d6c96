/* Look files: JSON to rules. The tables of the kinds say which keys there are and what they hold. */
#include "look/look.h"

#include <jansson.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/locate.h"
#include "look/look_change.h"
#include "look/look_version.h"
#include "look/value.h"

enum { STEPS_MAX = 6 };

typedef struct reader {
    const char     *text, *file;
    size_t          size;
    lmn_error      *error;
    lmn_techniques *set;              /* that the look may have besides the library's; NULL: none */
    locate_step     steps[STEPS_MAX]; /* where the reader is in the document */
    size_t          depth;
} reader;

static void enter_key(reader *r, const char *key)
{
    r->steps[r->depth++] = (locate_step){.key = key};
}

static void enter_index(reader *r, size_t index)
{
    r->steps[r->depth++] = (locate_step){.index = index};
}

static void leave(reader *r)
{
    r->depth--;
}

static void print_position(const reader *r, char *out, size_t size)
{
    size_t length = 0;
    out[0] = '\0';
    for (size_t i = 0; i < r->depth && length < size; i++) {
        const locate_step *s = &r->steps[i];
        int written = s->key ? snprintf(out + length, size - length, "%s%.60s", length ? "." : "", s->key)
                             : snprintf(out + length, size - length, "[%zu]", s->index);
        length += written > 0 ? (size_t)written : 0;
    }
}

/* An error at the reader's position. `key` (may be NULL) is a member of it that is to blame. */
static lmn_status fail(reader *r, const char *key, const char *format, ...) __attribute__((format(printf, 3, 4)));
static lmn_status fail(reader *r, const char *key, const char *format, ...)
{
    char    message[400], position[200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    print_position(r, position, sizeof position);
    if (key)
        enter_key(r, key);
    int line, column;
    locate(r->text, r->size, r->steps, r->depth, &line, &column);
    if (key)
        leave(r);
    lmn_status status =
        error_in_file(r->error, LMN_FORMAT, r->file, line, "%s%s%.400s", position, *position ? ": " : "", message);
    if (r->error)
        r->error->column = column;
    return status;
}

static lmn_status fail_limit(reader *r, const char *what, size_t count, int limit)
{
    fail(r, NULL, "has %zu %s; the limit is %d", count, what, limit);
    if (r->error)
        r->error->status = LMN_LIMIT;
    return LMN_LIMIT;
}

/* Turns an error about an argument into one about the file. */
static lmn_status fail_with(reader *r, const char *key, const lmn_error *inner)
{
    if (inner->status == LMN_MEMORY)
        return error_memory(r->error);
    lmn_status status = fail(r, key, "%s", inner->message);
    if (inner->hint[0])
        error_hint(r->error, "%s", inner->hint);
    return status;
}

static bool is_foreign(const char *key)
{
    return strncmp(key, "x-", 2) == 0;
}

static bool is_selector_key(const kind *k, const char *key)
{
    return strcmp(key, "technique") == 0 || strcmp(key, k->selector_key) == 0;
}

/* A member that must be text, copied. */
static lmn_status read_text(reader *r, const char *key, const json_t *json, char **out)
{
    if (!json_is_string(json))
        return fail(r, key, "%s must be text in quotes", key);
    mem_free(*out);
    *out = mem_copy_text(json_string_value(json));
    return *out ? LMN_OK : error_memory(r->error);
}

static lmn_status read_technique(reader *r, const kind *k, const json_t *json, const char *key, const technique **out)
{
    lmn_error inner = {0};
    if (!json_is_string(json))
        return fail(r, key, "the technique's name must be text in quotes");
    *out = techniques_find(r->set, k, json_string_value(json));
    if (*out)
        return LMN_OK;
    kind_unknown_technique(k, r->set, json_string_value(json), &inner);
    return fail_with(r, key, &inner);
}

/* The technique that an object names, or the kind's standard one. */
static lmn_status find_technique_of(reader *r, const kind *k, const json_t *object, const technique **out)
{
    const char   *key = k->selector_key;
    const json_t *named = json_object_get(object, key);
    if (!named)
        named = json_object_get(object, key = "technique");
    else if (strcmp(key, "technique") != 0 && json_object_get(object, "technique"))
        return fail(r, "technique", "'%s' and 'technique' say the same; leave one out", key);
    if (named)
        return read_technique(r, k, named, key, out);
    *out = k->standard;
    if (*out)
        return LMN_OK;
    lmn_status status = fail(r, NULL, "'%s' is missing", k->selector_key);
    kind_hint_techniques(k, r->set, r->error);
    return status;
}

/* A file's path counts from the look's folder; words that name no file stay what they are. */
static lmn_status read_path(const reader *r, const param *p, void *values, const json_t *json, lmn_error *error)
{
    const char *given = json_string_value(json);
    if (!given || (!strchr(given, '.') && !strchr(given, '/')))
        return value_set_json(p, values, json, error);
    char      *path = file_beside(r->file, given);
    lmn_status status = path ? value_set_text(p, values, path, error) : error_memory(error);
    mem_free(path);
    return status;
}

/* One technique: its name, or an object with the name and values. */
static lmn_status read_use(reader *r, const kind *k, json_t *json, technique_use *out)
{
    const technique *t;
    lmn_status       status;
    if (!json_is_object(json) && !json_is_string(json))
        return fail(r, NULL, "must be a technique's name or an object");
    if (json_is_string(json))
        status = read_technique(r, k, json, NULL, &t);
    else
        status = find_technique_of(r, k, json, &t);
    if (status != LMN_OK)
        return status;
    if (!use_create(out, k, t))
        return error_memory(r->error);
    const char *key;
    json_t     *value;
    json_object_foreach(json, key, value)
    {
        lmn_error inner = {0};
        if (is_foreign(key) || is_selector_key(k, key))
            continue;
        const param *p = kind_find_param(k, t, key);
        if (p)
            status = p->is_file ? read_path(r, p, out->values, value, &inner)
                                : value_set_json(p, out->values, value, &inner);
        else
            status = kind_missing_param(k, t, key, &inner);
        if (status != LMN_OK)
            return fail_with(r, key, &inner);
    }
    return LMN_OK;
}

static bool is_none(const kind *k, const json_t *json)
{
    return json_is_null(json) ||
           (json_is_string(json) && strcmp(json_string_value(json), "none") == 0 && !kind_find_technique(k, "none"));
}

/* A rule's value for a kind: one technique, several, or none. */
static lmn_status read_uses(reader *r, const kind *k, json_t *json, technique_use **uses, size_t *use_count)
{
    size_t count = json_is_array(json) ? json_array_size(json) : is_none(k, json) ? 0 : 1;
    if (json_is_array(json) && !k->array)
        return fail(r, NULL, "holds one technique, not an array");
    if (count == 0 && !kind_may_be_none(k))
        return fail(r, NULL, "cannot be none");
    if (count > LIMIT_LOOK_TECHNIQUES)
        return fail_limit(r, "techniques", count, LIMIT_LOOK_TECHNIQUES);
    *uses = mem_calloc(count, sizeof **uses);
    if (!*uses)
        return error_memory(r->error);
    *use_count = count;
    if (!json_is_array(json))
        return count ? read_use(r, k, json, *uses) : LMN_OK;
    for (size_t i = 0; i < count; i++) {
        enter_index(r, i);
        lmn_status status = read_use(r, k, json_array_get(json, i), &(*uses)[i]);
        leave(r);
        if (status != LMN_OK)
            return status;
    }
    return LMN_OK;
}

/* An unknown key, with the nearest of the keys that are allowed here: `words` and the kinds of this position. */
static lmn_status unknown_key(reader *r, const char *key, const char *const *words, size_t word_count, bool look_wide)
{
    const char *allowed[KIND_COUNT + 8];
    size_t      count = 0;
    for (; count < word_count; count++)
        allowed[count] = words[count];
    for (size_t i = 0; i < KIND_COUNT; i++)
        if (kinds[i]->look_wide == look_wide)
            allowed[count++] = kinds[i]->name;
    lmn_status  status = fail(r, key, "unknown key '%.60s'", key);
    const kind *elsewhere = kind_find(key);
    const char *near = text_nearest(key, allowed, count);
    if (elsewhere)
        error_hint(r->error,
                   look_wide ? "'%s' belongs into a rule" : "'%s' holds for the whole look: write it beside 'rules'",
                   key);
    else if (near)
        error_hint(r->error, "did you mean '%s'?", near);
    return status;
}

static lmn_status read_select(reader *r, rule *out)
{
    lmn_error  inner = {0};
    lmn_status status = selector_parse(&out->selector, out->select, &inner);
    return status == LMN_OK ? LMN_OK : fail_with(r, "select", &inner);
}

static lmn_status read_rule_member(reader *r, const char *key, json_t *value, rule *out)
{
    static const char *const words[] = {"name", "select"};
    if (strcmp(key, "name") == 0)
        return read_text(r, key, value, &out->name);
    if (strcmp(key, "select") == 0)
        return read_text(r, key, value, &out->select);
    const kind *k = kind_find(key);
    if (!k || k->look_wide)
        return unknown_key(r, key, words, PARAM_COUNT(words), false);
    enter_key(r, key);
    lmn_status status = read_uses(r, k, value, &out->uses[k->id], &out->use_counts[k->id]);
    leave(r);
    return status;
}

static lmn_status read_rule(reader *r, json_t *json, rule *out)
{
    const char *key;
    json_t     *value;
    if (!json_is_object(json))
        return fail(r, NULL, "must be an object");
    json_object_foreach(json, key, value)
    {
        lmn_status status = is_foreign(key) ? LMN_OK : read_rule_member(r, key, value, out);
        if (status != LMN_OK)
            return status;
    }
    if (!out->select && !(out->select = mem_copy_text("*")))
        return error_memory(r->error);
    lmn_status status = read_select(r, out);
    return status == LMN_OK ? rule_add_standards(out, r->error) : status;
}

static lmn_status read_rules(reader *r, json_t *json, lmn_look *look)
{
    size_t count = json_array_size(json);
    if (!json_is_array(json))
        return fail(r, NULL, "must be an array of rules");
    if (count > LIMIT_LOOK_RULES)
        return fail_limit(r, "rules", count, LIMIT_LOOK_RULES);
    look->rules = mem_calloc(count, sizeof *look->rules);
    if (!look->rules)
        return error_memory(r->error);
    look->rule_count = count;
    for (size_t i = 0; i < count; i++) {
        enter_index(r, i);
        lmn_status status = read_rule(r, json_array_get(json, i), &look->rules[i]);
        leave(r);
        if (status != LMN_OK)
            return status;
    }
    return LMN_OK;
}

/* The text stays the document's. */
static lmn_status read_map(reader *r, const json_t *json, lmn_control_map *out)
{
    const json_t *times = json_object_get(json, "times"), *ends = times ? times : json_object_get(json, "plus");
    const char   *key = times ? "times" : "plus";
    *out = (lmn_control_map){.param = json_string_value(json_object_get(json, "param")), .times = times};
    if (!json_is_object(json) || !out->param || !ends || json_object_size(json) != 2)
        return fail(r, NULL, "must be an object with 'param' and either 'times' or 'plus'");
    if (json_array_size(ends) != 2 || !json_is_number(json_array_get(ends, 0)) ||
        !json_is_number(json_array_get(ends, 1)))
        return fail(r, key, "%s must be two numbers, for -1 and for 1", key);
    out->low = json_number_value(json_array_get(ends, 0));
    out->high = json_number_value(json_array_get(ends, 1));
    return LMN_OK;
}

static lmn_status read_maps(reader *r, lmn_look *look, const json_t *json, size_t index)
{
    lmn_error       inner = {0};
    lmn_control_map maps[LIMIT_LOOK_TECHNIQUES];
    size_t          count = json_array_size(json);
    if (count == 0)
        return fail(r, NULL, "must be an array of what the control changes");
    if (count > LIMIT_LOOK_TECHNIQUES)
        return fail_limit(r, "maps", count, LIMIT_LOOK_TECHNIQUES);
    for (size_t i = 0; i < count; i++) {
        enter_index(r, i);
        lmn_status status = read_map(r, json_array_get(json, i), &maps[i]);
        leave(r);
        if (status != LMN_OK)
            return status;
    }
    if (look_set_control_maps(look, index, maps, count, &inner) == LMN_OK)
        return LMN_OK;
    enter_index(r, look->controls[index].map_count); /* the one that is wrong */
    lmn_status status = fail_with(r, NULL, &inner);
    leave(r);
    return status;
}

static lmn_status read_control(reader *r, lmn_look *look, const json_t *json, size_t index)
{
    lmn_error     inner = {0};
    const json_t *value = json_object_get(json, "value"), *maps = json_object_get(json, "maps");
    if (!json_is_object(json) || !maps || json_object_size(json) != (value ? 2u : 1u))
        return fail(r, NULL, "must be an object with 'maps' and at most 'value' besides");
    enter_key(r, "maps");
    lmn_status status = read_maps(r, look, maps, index);
    leave(r);
    if (status != LMN_OK || !value)
        return status;
    if (!json_is_number(value))
        return fail(r, "value", "value must be a number from -1 to 1");
    status = look_set_control(look, index, json_number_value(value), &inner);
    return status == LMN_OK ? LMN_OK : fail_with(r, "value", &inner);
}

/* Behind the rules, whose techniques may have parameters that no other has. */
static lmn_status read_controls(reader *r, json_t *json, lmn_look *look)
{
    const char *key;
    json_t     *value;
    lmn_status  status = json_is_object(json) ? LMN_OK : fail(r, NULL, "must be an object");
    json_object_foreach(json, key, value)
    {
        lmn_error inner = {0};
        size_t    index;
        if (status != LMN_OK || is_foreign(key))
            continue;
        if (control_find(&index, key, &inner) != LMN_OK)
            return fail_with(r, key, &inner);
        enter_key(r, key);
        status = read_control(r, look, value, index);
        leave(r);
    }
    return status;
}

static lmn_status read_wide(reader *r, const kind *k, json_t *value, technique_use *out)
{
    use_release(out);
    return read_use(r, k, value, out);
}

static lmn_status read_root_member(reader *r, const char *key, json_t *value, lmn_look *look)
{
    static const char *const words[] = {"version", "name", "doc", "rules", "controls"};
    lmn_status               status;
    if (strcmp(key, "version") == 0 || strcmp(key, "controls") == 0)
        return LMN_OK;
    if (strcmp(key, "name") == 0)
        return read_text(r, key, value, &look->name);
    if (strcmp(key, "doc") == 0)
        return read_text(r, key, value, &look->doc);
    const kind *k = kind_find(key);
    bool        rules = strcmp(key, "rules") == 0;
    if (!rules && (!k || !k->look_wide))
        return unknown_key(r, key, words, PARAM_COUNT(words), true);
    enter_key(r, key);
    status = rules ? read_rules(r, value, look) : read_wide(r, k, value, &look->wide[k->id]);
    leave(r);
    return status;
}

static lmn_status read_version(reader *r, json_t *root)
{
    const json_t *version = json_object_get(root, "version");
    if (!version) {
        lmn_status status = fail(r, NULL, "'version' is missing");
        error_hint(r->error, "add \"version\": %d", LOOK_VERSION);
        return status;
    }
    json_int_t number = json_integer_value(version);
    if (!json_is_integer(version) || number < 1)
        return fail(r, "version", "version must be a whole number from 1 to %d", LOOK_VERSION);
    if (number > LOOK_VERSION) {
        lmn_status status =
            fail(r, "version", "version is %lld; this Limner reads versions up to %d", (long long)number, LOOK_VERSION);
        error_hint(r->error, "the look was made for a newer Limner");
        return status;
    }
    return look_bring_forward(root, number, r->error);
}

static lmn_status read_root(reader *r, json_t *root, lmn_look *look)
{
    if (!json_is_object(root))
        return fail(r, NULL, "a look must be an object");
    lmn_status status = read_version(r, root);
    for (size_t i = 0; i < KIND_COUNT && status == LMN_OK; i++)
        if (kinds[i]->look_wide && kinds[i]->standard && !use_create(&look->wide[i], kinds[i], kinds[i]->standard))
            status = error_memory(r->error);
    const char *key;
    json_t     *value;
    json_object_foreach(root, key, value) if (status == LMN_OK && !is_foreign(key)) status =
        read_root_member(r, key, value, look);
    if (status == LMN_OK && look->rule_count == 0) {
        status = fail(r, NULL, "there is no rule, so nothing would be drawn");
        error_hint(r->error, "add \"rules\": [{\"select\": \"*\"}]");
    }
    json_t *controls = json_object_get(root, "controls");
    if (status == LMN_OK && controls) {
        enter_key(r, "controls");
        status = read_controls(r, controls, look);
        leave(r);
    }
    return status;
}

/* The file's name without folder and ending. */
static char *stem_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    char       *stem = mem_copy_text(slash ? slash + 1 : path);
    char       *dot = stem ? strrchr(stem, '.') : NULL;
    if (dot && dot != stem)
        *dot = '\0';
    return stem;
}

static lmn_status fail_syntax(reader *r, const json_error_t *wrong)
{
    /* jansson leaves the text empty when an allocation inside it fails */
    if (json_error_code(wrong) == json_error_out_of_memory || !wrong->text[0])
        return error_memory(r->error);
    lmn_status status = error_in_file(r->error, LMN_FORMAT, r->file, wrong->line, "not valid JSON: %s", wrong->text);
    if (r->error)
        r->error->column = wrong->column > 0 ? wrong->column : 1;
    return status;
}

/* The deepest nesting, strings left out. */
static int depth_of(const char *at, const char *end)
{
    int depth = 0, deepest = 0;
    for (bool inside = false; at < end; at++) {
        if (inside && *at == '\\')
            at++;
        else if (*at == '"')
            inside = !inside;
        else if (!inside && (*at == '{' || *at == '['))
            deepest = ++depth > deepest ? depth : deepest;
        else if (!inside && (*at == '}' || *at == ']'))
            depth--;
    }
    return deepest;
}

static lmn_status check_limits(const reader *r)
{
    if (r->size > LIMIT_LOOK_BYTES)
        return error_in_file(r->error, LMN_LIMIT, r->file, 0, "the look has %zu bytes; the limit is %zu", r->size,
                             LIMIT_LOOK_BYTES);
    int depth = depth_of(r->text, r->text + r->size);
    if (depth > LIMIT_JSON_DEPTH)
        return error_in_file(r->error, LMN_LIMIT, r->file, 0, "the look is nested %d deep; the limit is %d", depth,
                             LIMIT_JSON_DEPTH);
    return LMN_OK;
}

lmn_status look_parse(lmn_look **out, const char *json, size_t size, const char *name, lmn_techniques *set,
                      lmn_error *error)
{
    reader       r = {.text = json, .file = name, .size = size, .error = error, .set = set};
    json_error_t wrong;
    *out = NULL;
    if (size >= 3 && memcmp(json, "\xEF\xBB\xBF", 3) == 0) { /* some editors put a byte order mark */
        r.text += 3;
        r.size -= 3;
    }
    lmn_status status = check_limits(&r);
    if (status != LMN_OK)
        return status;
    json_t *root = json_loadb(r.text, r.size, JSON_REJECT_DUPLICATES | JSON_DECODE_ANY, &wrong);
    if (!root)
        return fail_syntax(&r, &wrong);
    lmn_look *look = mem_calloc(1, sizeof *look);
    if (look)
        look->techniques = techniques_hold(set);
    status = look ? read_root(&r, root, look) : error_memory(error);
    if (status == LMN_OK && !look->name && !(look->name = stem_of(name)))
        status = error_memory(error);
    json_decref(root);
    if (status == LMN_OK)
        look_mark_changed(look, LOOK_CHANGE_ALL);
    else
        look_destroy(&look);
    *out = look;
    return status;
}

lmn_status look_create(lmn_look **out, lmn_techniques *set, lmn_error *error)
{
    static const char empty[] = "{\"version\": 2, \"rules\": [{\"select\": \"*\"}]}";
    return look_parse(out, empty, sizeof empty - 1, "look", set, error);
}
