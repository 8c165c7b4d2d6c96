/* Looks: parsing, positions of errors, setting, printing, the reference, and what happens when memory runs out. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <jansson.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "limner/look.h"
#include "look/look.h"
#include "look/value.h"

static const char two_rules[] =
    "{\"version\": 1, \"name\": \"two\", \"doc\": \"Two rules.\", \"x-author\": {\"any\": 1},\n"
    " \"scene\": {\"crease_angle\": 45}, \"finish\": {\"ground\": \"#eeeeff\"},\n"
    " \"controls\": {\"scale\": {\"value\": 0.5, \"maps\": [{\"param\": \"lines.width\", \"times\": [0.5, 2]}]}},"
    " \"rules\": [\n"
    "  {\"name\": \"wheels\", \"select\": \"Wheel*\", \"surface\": {\"technique\": \"toon\", \"bands\": 4, \"x-note\": "
    "null},\n"
    "   \"lines\": [\"four-tap\", {\"operator\": \"id\", \"width\": 3, \"colour\": \"red\"}]},\n"
    "  {\"select\": \"*\", \"surface\": \"lit\", \"lines\": null}\n"
    " ]}\n";

static lmn_look *parse(const char *json)
{
    lmn_error error = {0};
    lmn_look *look = NULL;
    if (lmn_look_parse(&look, json, "test.json", &error) != LMN_OK)
        fail_msg("%d:%d: %s (%s)", error.line, error.column, error.message, error.hint);
    return look;
}

static const char *value_of(const lmn_look *look, size_t rule_index, kind_id id, size_t use, const char *key,
                            char out[128])
{
    const technique_use *u = kinds[id]->look_wide ? &look->wide[id] : &look->rules[rule_index].uses[id][use];
    const param         *p = kind_find_param(kinds[id], u->technique, key);
    assert_non_null(p);
    param_print(p, u->values, out, 128);
    return out;
}

static void test_parse(void **state)
{
    (void)state;
    char      out[128];
    lmn_look *look = parse(two_rules);
    assert_string_equal(lmn_look_name(look), "two");
    assert_int_equal(look->rule_count, 2);
    assert_int_equal(look->rules[0].use_counts[KIND_LINES], 2);
    assert_int_equal(look->rules[1].use_counts[KIND_LINES], 0);
    assert_int_equal(look->rules[1].use_counts[KIND_COMPOSE], 1);
    assert_string_equal(value_of(look, 0, KIND_SURFACE, 0, "bands", out), "4");
    assert_string_equal(value_of(look, 0, KIND_LINES, 1, "width", out), "2.25");
    assert_string_equal(value_of(look, 0, KIND_LINES, 1, "colour", out), "#ff0000");
    assert_string_equal(value_of(look, 0, KIND_SCENE, 0, "crease_angle", out), "45");
    assert_string_equal(value_of(look, 0, KIND_FINISH, 0, "ground", out), "#eeeeff");
    lmn_look_destroy(&look);
    assert_null(look);
    lmn_look_destroy(&look);
    lmn_look_destroy(NULL);
}

static void test_wrong_files(void **state)
{
    (void)state;
    static const struct {
        const char *json, *message, *hint;
        int         line, column;
    } cases[] = {
        {"{\"version\": 1,\n \"rules\": [}", "not valid JSON", "", 2, 12},
        {"", "not valid JSON", "", -1, -1},
        {"[]", "must be an object", "", 1, 1},
        {"{\"rules\": [{}]}", "'version' is missing", "\"version\": 2", 1, 1},
        {"{\"version\": 3}", "version is 3", "newer", 1, 2},
        {"{\"version\": \"1\"}", "whole number", "", 1, 2},
        {"{\"version\": 1, \"version\": 1}", "not valid JSON: duplicate", "", 1, -1},
        {"{\"version\": 1}", "no rule", "add", 1, 1},
        {"{\"version\": 1,\n  \"rules\": [{\"surfce\": \"lit\"}]}", "rules[0]: unknown key 'surfce'", "'surface'", 2,
         14},
        {"{\"version\": 1, \"rule\": []}", "unknown key 'rule'", "'rules'", 1, 16},
        {"{\"version\": 1, \"lines\": \"id\"}", "unknown key 'lines'", "into a rule", 1, 16},
        {"{\"version\": 1, \"rules\": [{\"scene\": {}}]}", "unknown key 'scene'", "beside 'rules'", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"surface\":\n {\"technique\": \"lit\",\n  \"bands\": 3}}]}",
         "rules[0].surface: surface technique 'lit' has no parameter 'bands'; these have it: ", "surface.technique", 3,
         3},
        {"{\"version\": 1, \"rules\": [{\"surface\": {\"technique\": \"toon\", \"band\": 3}}]}", "no parameter 'band'",
         "'bands'", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"surface\": {\"technique\": \"toon\", \"bands\": 300}}]}",
         "bands is '300'; allowed is a whole number from 1 to 16", "", 1, 60},
        {"{\"version\": 1, \"rules\": [{\"surface\": {\"technique\": \"toon\", \"bands\": \"3\"}}]}",
         "bands must be a whole number", "", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"surface\": {\"technique\": \"toon\", \"bands\": 3.5}}]}",
         "bands must be a whole number", "", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"surface\": \"tooon\"}]}", "no surface technique 'tooon'", "'toon'", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"surface\": null}]}", "rules[0].surface: cannot be none", "", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"surface\": [\"lit\"]}]}", "holds one technique", "", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"surface\": 3}]}", "technique's name or an object", "", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"lines\": {\"width\": 3}}]}", "'operator' is missing", "four-tap", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"lines\": [\"id\", {\"operator\": \"id\", \"technique\": \"id\"}]}]}",
         "rules[0].lines[1]: ", "", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"lines\": {\"operator\": 1}}]}", "text in quotes", "", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"select\": \"a,\"}]}", "selector 'a,'", "", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"select\": 1}]}", "select must be text", "", 1, -1},
        {"{\"version\": 1, \"rules\": [{\"select\": \"a\"},\n {\"select\": \"b\"},\n {\"surfce\": 1}]}",
         "rules[2]: unknown key", "", 3, 3},
        {"{\"version\": 1, \"rules\": {}}", "array of rules", "", 1, -1},
        {"{\"version\": 1, \"rules\": [1]}", "rules[0]: must be an object", "", 1, 26},
        {"{\"version\": 1, \"scene\": {\"light_direction\": [0, 0, 0]}, \"rules\": [{}]}", "scene: light_direction is",
         "", 1, -1},
        {"{\"version\": 1, \"scene\": {\"light_direction\": [0, \"1\", 0]}, \"rules\": [{}]}", "array of three numbers",
         "", 1, -1},
        {"{\"version\": 1, \"scene\": null, \"rules\": [{}]}", "scene: must be", "", 1, -1},
    };
    for (size_t i = 0; i < PARAM_COUNT(cases); i++) {
        lmn_error error = {0};
        lmn_look *look = (lmn_look *)&error; /* must become NULL */
        assert_int_equal(lmn_look_parse(&look, cases[i].json, "test.json", &error), LMN_FORMAT);
        assert_null(look);
        assert_string_equal(error.file, "test.json");
        if (!strstr(error.message, cases[i].message) || !strstr(error.hint, cases[i].hint) ||
            (cases[i].line >= 0 && error.line != cases[i].line) ||
            (cases[i].column >= 0 && error.column != cases[i].column))
            fail_msg("case %zu: %d:%d: %s (%s)", i, error.line, error.column, error.message, error.hint);
    }
}

/* "[x,x,…]" in a look that is otherwise right. */
static void check_limit(const char *before, const char *item, size_t count, const char *after)
{
    text      json = {0};
    lmn_look *look = NULL;
    lmn_error error = {0};
    text_append(&json, "{\"version\": 1, %s", before);
    for (size_t i = 0; i < count; i++)
        text_append(&json, "%s%s", i && *item != '[' ? "," : "", item);
    text_append(&json, "%s}", after);
    assert_int_equal(lmn_look_parse(&look, json.data, "test.json", &error), LMN_LIMIT);
    assert_int_equal(error.status, LMN_LIMIT);
    assert_non_null(strstr(error.message, "the limit is"));
    text_release(&json);
}

static void test_limits(void **state)
{
    (void)state;
    check_limit("\"rules\": [", "{}", LIMIT_LOOK_RULES + 1, "]");
    check_limit("\"rules\": [{\"lines\": [", "\"id\"", LIMIT_LOOK_TECHNIQUES + 1, "]}]");
    check_limit("\"x-deep\": ", "[", LIMIT_JSON_DEPTH, "");
    check_limit("\"x-long\": [", "\"0123456789\"", LIMIT_LOOK_BYTES / 13 + 1, "]");
}

static void test_load(void **state)
{
    (void)state;
    lmn_error error = {0};
    lmn_look *look = NULL;
    assert_true(lmn_look_count() > 0);
    assert_null(lmn_look_name_at(lmn_look_count()));
    for (size_t i = 0; i < lmn_look_count(); i++) {
        const char *name = lmn_look_name_at(i);
        assert_true(i == 0 || strcmp(lmn_look_name_at(i - 1), name) < 0);
        if (lmn_look_load(&look, name, &error) != LMN_OK)
            fail_msg("%s:%d:%d: %s (%s)", error.file, error.line, error.column, error.message, error.hint);
        assert_string_equal(lmn_look_name(look), name);
        assert_non_null(look->doc);
        assert_int_equal(look->doc[strlen(look->doc) - 1], '.');
        lmn_look_destroy(&look);
    }
    assert_int_equal(lmn_look_load(&look, "edgs", &error), LMN_USAGE);
    assert_non_null(strstr(error.hint, "'edges'"));
    assert_int_equal(lmn_look_load(&look, "no/such/file", &error), LMN_READ);
    assert_int_equal(lmn_look_load(&look, "nosuch.json", &error), LMN_READ);
    assert_int_equal(lmn_look_load(&look, NULL, &error), LMN_USAGE);
}

static void test_round_trip(void **state)
{
    (void)state;
    lmn_look *look = parse(two_rules);
    char     *first = lmn_look_json(look);
    lmn_look_destroy(&look);
    look = parse(first);
    char *second = lmn_look_json(look);
    assert_string_equal(first, second);
    assert_non_null(strstr(first, "\"crease_angle\": 45"));
    assert_null(strstr(first, "x-"));
    assert_null(strstr(first, "threshold"));
    assert_null(strstr(first, "null"));
    lmn_look_destroy(&look);
    mem_free(first);
    mem_free(second);
}

/* A choice that was yes or no takes true and false as it did, and prints them so; others take no such thing. */
static void test_truth_among_choices(void **state)
{
    (void)state;
    static const char *const says[][2] = {{"true", "\"round\": true"},
                                          {"\"true\"", "\"round\": true"},
                                          {"false", NULL},
                                          {"\"forms\"", "\"round\": \"forms\""}};
    char                     json[128];
    for (size_t i = 0; i < PARAM_COUNT(says); i++) {
        snprintf(json, sizeof json, "{\"version\": 2, \"scene\": {\"round\": %s}, \"rules\": [{}]}", says[i][0]);
        lmn_look *look = parse(json);
        char     *printed = lmn_look_json(look);
        if (says[i][1])
            assert_non_null(strstr(printed, says[i][1]));
        else
            assert_null(strstr(printed, "round"));
        mem_free(printed);
        lmn_look_destroy(&look);
    }
    static const char *const wrong[] = {"\"round\": 1", "\"round\": \"yes\"", "\"ground\": true"};
    for (size_t i = 0; i < PARAM_COUNT(wrong); i++) {
        lmn_look *look = NULL;
        snprintf(json, sizeof json, "{\"version\": 2, \"scene\": {%s}, \"rules\": [{}]}", wrong[i]);
        assert_int_not_equal(lmn_look_parse(&look, json, "wrong", NULL), LMN_OK);
        assert_null(look);
    }
}

/* Every parameter of every technique, set to something else than its default, survives print and parse. */
static void test_every_parameter_round_trips(void **state)
{
    (void)state;
    for (size_t k = 0; k < KIND_COUNT; k++)
        for (size_t t = 0; t < kinds[k]->technique_count; t++) {
            const technique *tech = kinds[k]->techniques[t];
            char             key[64];
            lmn_error        error = {0};
            lmn_look        *look = parse("{\"version\": 1, \"rules\": [{\"lines\": \"id\"}]}"), *again = NULL;
            snprintf(key, sizeof key, "%s.technique", kinds[k]->name);
            assert_int_equal(lmn_look_set(look, key, tech->name, &error), LMN_OK);
            technique_use *use = kinds[k]->look_wide ? &look->wide[k] : look->rules[0].uses[k];
            for (size_t i = 0; i < kind_param_count(kinds[k], tech); i++) {
                const param             *p = kind_param_at(kinds[k], tech, i);
                static const char *const tries[] = {"true", "false", "#123456", "0.1,-2,3", "0.7", "1", "2", "7", "-1"};
                for (size_t n = 0; n < PARAM_COUNT(tries) && param_is_default(p, use->values); n++)
                    param_set_text(p, use->values, tries[n], NULL);
                if (p->type == PARAM_ENUM && p->names[1])
                    param_set_text(p, use->values, p->names[1], NULL);
            }
            char *first = lmn_look_json(look);
            if (lmn_look_parse(&again, first, "again", &error) != LMN_OK)
                fail_msg("%s", error.message);
            char *second = lmn_look_json(again);
            assert_string_equal(first, second);
            mem_free(first);
            mem_free(second);
            lmn_look_destroy(&look);
            lmn_look_destroy(&again);
        }
}

/* Lengths of version 1 are pixels of 1/96 inch, those of version 2 points, or what they say. */
static void test_versions(void **state)
{
    (void)state;
    static const char rules[] = "\"finish\": {\"grain_size\": 4}, \"rules\": [{\"surface\": {\"technique\": \"hatch\", "
                                "\"scale\": 8, \"series\": 2}, \"lines\": [{\"operator\": \"strokes\", \"taper\": 40, "
                                "\"crease_width\": 0.5}, \"id\"], \"compose\": {\"technique\": \"wire\", "
                                "\"hidden_width\": \"auto\"}}]}";
    static const struct {
        const char *grain, *scale, *taper;
    } wanted[] = {{"3", "6", "30"}, {"4", "8", "40"}};
    for (int version = 1; version <= 2; version++) {
        char text[512], out[128];
        snprintf(text, sizeof text, "{\"version\": %d, %s", version, rules);
        lmn_look *look = parse(text);
        assert_string_equal(value_of(look, 0, KIND_FINISH, 0, "grain_size", out), wanted[version - 1].grain);
        assert_string_equal(value_of(look, 0, KIND_SURFACE, 0, "scale", out), wanted[version - 1].scale);
        assert_string_equal(value_of(look, 0, KIND_SURFACE, 0, "series", out), "2");
        assert_string_equal(value_of(look, 0, KIND_LINES, 0, "taper", out), wanted[version - 1].taper);
        assert_string_equal(value_of(look, 0, KIND_LINES, 0, "crease_width", out), "0.5");
        assert_string_equal(value_of(look, 0, KIND_COMPOSE, 0, "hidden_width", out), "auto");
        lmn_look_destroy(&look);
    }
    char      out[128];
    lmn_look *look = parse("{\"version\": 2, \"rules\": [{\"lines\": {\"operator\": \"id\", \"width\": \"0.25in\"}}]}");
    assert_string_equal(value_of(look, 0, KIND_LINES, 0, "width", out), "18");
    lmn_look_destroy(&look);
}

static void test_set(void **state)
{
    (void)state;
    char      out[128];
    lmn_look *look = parse(two_rules);
    assert_int_equal(lmn_look_set(look, "lines.width", "5px", NULL), LMN_OK);
    assert_string_equal(value_of(look, 0, KIND_LINES, 0, "width", out), "3.75");
    assert_string_equal(value_of(look, 0, KIND_LINES, 1, "width", out), "3.75");
    assert_int_equal(lmn_look_set(look, "lines[1].width", "6.5px", NULL), LMN_OK);
    assert_string_equal(value_of(look, 0, KIND_LINES, 0, "width", out), "3.75");
    assert_string_equal(value_of(look, 0, KIND_LINES, 1, "width", out), "4.875");
    assert_int_equal(lmn_look_set(look, "wheels:surface.bands", "9", NULL), LMN_OK);
    assert_string_equal(value_of(look, 0, KIND_SURFACE, 0, "bands", out), "9");
    assert_int_equal(lmn_look_set(look, "0:surface.bands", "8", NULL), LMN_OK);
    assert_string_equal(value_of(look, 0, KIND_SURFACE, 0, "bands", out), "8");
    assert_int_equal(lmn_look_set(look, "surface.bands", "7", NULL), LMN_OK); /* only the toon rule has it */
    assert_string_equal(value_of(look, 0, KIND_SURFACE, 0, "bands", out), "7");
    assert_int_equal(lmn_look_set(look, "scene.light_direction", "1,2,3", NULL), LMN_OK);
    assert_string_equal(value_of(look, 0, KIND_SCENE, 0, "light_direction", out), "1,2,3");
    lmn_look_destroy(&look);
}

static void test_exchange(void **state)
{
    (void)state;
    char      out[128];
    lmn_look *look = parse(two_rules);
    assert_int_equal(lmn_look_set(look, "lines[1].operator", "sobel", NULL), LMN_OK);
    assert_string_equal(look->rules[0].uses[KIND_LINES][1].technique->name, "sobel");
    assert_string_equal(value_of(look, 0, KIND_LINES, 1, "width", out), "2.25");
    assert_string_equal(value_of(look, 0, KIND_LINES, 1, "colour", out), "#ff0000");
    assert_int_equal(lmn_look_set(look, "lines[2].technique", "id", NULL), LMN_OK);
    assert_int_equal(look->rules[0].use_counts[KIND_LINES], 3);
    assert_int_equal(look->rules[1].use_counts[KIND_LINES], 0);
    assert_int_equal(lmn_look_set(look, "lines[0].operator", "none", NULL), LMN_OK);
    assert_int_equal(look->rules[0].use_counts[KIND_LINES], 2);
    assert_string_equal(look->rules[0].uses[KIND_LINES][0].technique->name, "sobel");
    assert_int_equal(lmn_look_set(look, "lines.operator", "saito", NULL), LMN_OK);
    assert_int_equal(look->rules[0].use_counts[KIND_LINES], 1);
    assert_int_equal(look->rules[1].use_counts[KIND_LINES], 0);
    assert_int_equal(lmn_look_set(look, "1:lines.operator", "saito", NULL), LMN_OK);
    assert_int_equal(look->rules[1].use_counts[KIND_LINES], 1);
    assert_int_equal(lmn_look_set(look, "lines.operator", "none", NULL), LMN_OK);
    assert_int_equal(look->rules[0].use_counts[KIND_LINES], 0);
    assert_int_equal(look->rules[1].use_counts[KIND_LINES], 0);
    assert_int_equal(lmn_look_set(look, "lines.operator", "four-tap", NULL), LMN_OK);
    assert_int_equal(look->rules[0].use_counts[KIND_LINES], 1);
    assert_int_equal(look->rules[1].use_counts[KIND_LINES], 1);
    assert_int_equal(lmn_look_set(look, "surface.technique", "gooch", NULL), LMN_OK);
    assert_string_equal(look->rules[1].uses[KIND_SURFACE]->technique->name, "gooch");
    /* a value that nobody set is the new technique's default, not the old one's */
    const param *specular =
        kind_find_param(kinds[KIND_SURFACE], look->rules[1].uses[KIND_SURFACE]->technique, "specular");
    assert_true(param_is_default(specular, look->rules[1].uses[KIND_SURFACE]->values));
    lmn_look_destroy(&look);
}

static void test_set_refused(void **state)
{
    (void)state;
    static const struct {
        const char *key, *value, *message, *hint;
    } cases[] = {
        {"line.width", "3", "no kind 'line'", "'lines.width'"},
        {"lines.widht", "3", "lines has no parameter 'widht'", "'width'"},
        {"lines.width", "300px", "lines.width is '300px'; allowed is a number from 0 to 24 pt", ""},
        {"lines.width", "nan", "0 to 24 pt", ""},
        {"wheels:surface.hardness", "1", "no parameter 'hardness'", ""},
        {"1:surface.bands", "3", "technique 'lit' has no parameter 'bands'; these have it: ", "surface.technique"},
        {"1:lines.width", "3", "has no lines", "lines.operator"},
        {"lines[5].width", "3px", "lines[0] to [1] only", ""},
        {"1:lines[0].width", "3", "has no lines", ""},
        {"wheel:lines.width", "3", "no rule 'wheel'", "'wheels'"},
        {"7:lines.width", "3", "no rule '7'", "0 to 1"},
        {"0:scene.crease_angle", "3", "whole look", "scene.crease_angle"},
        {"scene[0].crease_angle", "3", "whole look", ""},
        {"lines.operator", "four-tip", "no lines technique 'four-tip'", "'four-tap'"},
        {"surface.technique", "none", "no surface technique 'none'", ""},
        {"lines", "3", "does not name a parameter", "KIND.PARAM"},
        {"lines.", "3", "does not name", ""},
        {".width", "3", "does not name", ""},
        {":lines.width", "3", "does not name", ""},
        {"lines[x].width", "3", "does not name", ""},
        {"lines[1.width", "3", "does not name", ""},
        {"lines[-1].width", "3", "does not name", ""},
        {"", "3", "does not name", ""},
    };
    lmn_look *look = parse(two_rules);
    char     *before = lmn_look_json(look);
    for (size_t i = 0; i < PARAM_COUNT(cases); i++) {
        lmn_error  error = {0};
        lmn_status status = lmn_look_set(look, cases[i].key, cases[i].value, &error);
        if (status != LMN_USAGE || !strstr(error.message, cases[i].message) || !strstr(error.hint, cases[i].hint))
            fail_msg("%s=%s: %s (%s)", cases[i].key, cases[i].value, error.message, error.hint);
    }
    char *after = lmn_look_json(look);
    assert_string_equal(before, after);
    mem_free(before);
    mem_free(after);
    lmn_look_destroy(&look);
}

static void test_reference(void **state)
{
    (void)state;
    lmn_error error = {0};
    char     *text = NULL;
    assert_int_equal(lmn_look_reference_json(&text, NULL, &error), LMN_OK);
    json_t *root = json_loads(text, 0, NULL);
    assert_non_null(root);
    assert_int_equal(json_array_size(json_object_get(root, "kinds")), KIND_COUNT);
    assert_int_equal(json_array_size(json_object_get(root, "looks")), lmn_look_count());
    json_decref(root);
    mem_free(text);
    assert_int_equal(lmn_look_reference_json(&text, "edges", &error), LMN_OK);
    assert_non_null(strstr(text, "\"lines.width\""));
    assert_non_null(strstr(text, "\"scene.crease_angle\""));
    mem_free(text);
    assert_int_equal(lmn_look_reference_json(&text, "nosuch", &error), LMN_USAGE);
}

/* What must hold for every row, so that no technique needs a test of its own for it. */
static void check_row(const kind *k, const technique *t, size_t index)
{
    const param *p = kind_param_at(k, t, index);
    const char  *where = p->key;
    for (size_t i = 0; i < index; i++)
        if (strcmp(kind_param_at(k, t, i)->key, p->key) == 0)
            fail_msg("%s.%s: %s is declared twice", k->name, t->name, where);
    if (!p->doc || !*p->doc || p->doc[strlen(p->doc) - 1] != '.')
        fail_msg("%s.%s: %s has no doc that ends in a full stop", k->name, t->name, where);
    technique_use use;
    char          printed[128];
    assert_true(use_create(&use, k, t));
    param_print(p, use.values, printed, sizeof printed);
    if (param_set_text(p, use.values, printed, NULL) != LMN_OK)
        fail_msg("%s.%s: the default of %s, %s, is refused", k->name, t->name, where, printed);
    if ((p->type == PARAM_INT || p->type == PARAM_FLOAT) &&
        (p->max <= p->min || p->soft_min > p->soft_max || (p->soft_max != 0 && p->soft_max > p->max) ||
         (p->soft_min != 0 && p->soft_min < p->min)))
        fail_msg("%s.%s: the ranges of %s are wrong", k->name, t->name, where);
    if (p->can_auto && p->type != PARAM_FLOAT && p->type != PARAM_COLOUR && p->type != PARAM_DIRECTION)
        fail_msg("%s.%s: %s cannot be auto", k->name, t->name, where);
    if (p->def_auto && !p->can_auto)
        fail_msg("%s.%s: %s is auto but may not be", k->name, t->name, where);
    if (p->auto_from && !kind_find_param(k, t, p->auto_from))
        fail_msg("%s.%s: auto_from of %s is unknown", k->name, t->name, where);
    use_release(&use);
}

static void test_tables(void **state)
{
    (void)state;
    for (size_t i = 0; i < KIND_COUNT; i++) {
        const kind *k = kinds[i];
        assert_int_equal(k->id, i);
        for (size_t n = 0; n < k->technique_count; n++) {
            const technique *t = k->techniques[n];
            char             json[1024];
            lmn_look        *look = NULL;
            lmn_error        error = {0};
            assert_non_null(t->doc);
            assert_int_equal(t->doc[strlen(t->doc) - 1], '.');
            assert_ptr_equal(kind_find_technique(k, t->name), t);
            for (size_t p = 0; p < kind_param_count(k, t); p++)
                check_row(k, t, p);
            if (!t->example)
                continue;
            snprintf(json, sizeof json, "{\"version\": 1, \"rules\": [%s]}", t->example);
            if (lmn_look_parse(&look, json, t->name, &error) != LMN_OK)
                fail_msg("example of %s.%s: %s", k->name, t->name, error.message);
            lmn_look_destroy(&look);
        }
    }
}

/* Each allocation fails once, jansson's too: an error, nothing leaked (the sanitizer looks), nothing half made. */
static void test_memory(void **state)
{
    (void)state;
    json_set_alloc_funcs(mem_alloc, mem_free);
    bool done = false;
    for (long n = 1; !done && n < 100000; n++) {
        lmn_look *look = NULL;
        lmn_error error = {0};
        mem_fail_at(n);
        lmn_status status = lmn_look_parse(&look, two_rules, "test.json", &error);
        char      *printed = NULL, *reference = NULL;
        if (status == LMN_OK)
            status = lmn_look_set(look, "lines.operator", "sobel", &error);
        if (status == LMN_OK)
            status = lmn_look_set(look, "wheels:lines[1].technique", "id", &error);
        if (status == LMN_OK && !(printed = lmn_look_json(look)))
            status = LMN_MEMORY;
        if (status == LMN_OK)
            status = lmn_look_reference_json(&reference, "edges", &error);
        mem_fail_at(0);
        done = status == LMN_OK;
        /* jansson takes memory that ran out inside a string for a wrong token */
        bool mistaken = status == LMN_FORMAT && strstr(error.message, "not valid JSON");
        if (!done && status != LMN_MEMORY && !mistaken)
            fail_msg("allocation %ld: %s", n, error.message);
        lmn_look_destroy(&look);
        mem_free(printed);
        mem_free(reference);
    }
    assert_true(done);
    json_set_alloc_funcs(malloc, free);
}

/* Damaged looks and keys give an error or a look, never a crash; what was parsed prints and parses again. */
static void test_damage(void **state)
{
    (void)state;
    static const char spice[] = "{}[]\",:-.0123456789eE\\ \ntfnulx\xff";
    uint32_t          random = 1;
    for (int round = 0; round < 20000; round++) {
        char      json[sizeof two_rules], key[] = "wheels:lines[1].width";
        lmn_look *look = NULL, *again = NULL;
        memcpy(json, two_rules, sizeof json);
        for (int i = 0; i < 1 + round % 3; i++) {
            random = random * 1664525u + 1013904223u;
            json[(random >> 8) % (sizeof json - 1)] = spice[(random >> 3) % (sizeof spice - 1)];
            key[(random >> 9) % (sizeof key - 1)] = spice[(random >> 5) % (sizeof spice - 1)];
        }
        if (look_parse(&look, json, sizeof json - 1, "test.json", NULL, NULL) == LMN_OK) {
            look_set(look, key, "3", NULL);
            char *printed = lmn_look_json(look);
            assert_non_null(printed);
            assert_int_equal(lmn_look_parse(&again, printed, "again", NULL), LMN_OK);
            mem_free(printed);
        }
        lmn_look_destroy(&look);
        lmn_look_destroy(&again);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parse),
        cmocka_unit_test(test_wrong_files),
        cmocka_unit_test(test_load),
        cmocka_unit_test(test_limits),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_every_parameter_round_trips),
        cmocka_unit_test(test_truth_among_choices),
        cmocka_unit_test(test_versions),
        cmocka_unit_test(test_set),
        cmocka_unit_test(test_exchange),
        cmocka_unit_test(test_set_refused),
        cmocka_unit_test(test_reference),
        cmocka_unit_test(test_tables),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_damage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
