/* limner/rules.h: all parameters of all techniques are enumerated, set, refused and reset; looks built by calls are
 * those that files say; what changes ask of the next drawing; and that nothing is left half done. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "base/limits.h"
#include "base/memory.h"
#include "limner/limner.h"
#include "look/look.h"

static lmn_error error;

static void check(lmn_status status, const char *what)
{
    if (status != LMN_OK)
        fail_msg("%s: %s (%s)", what, error.message, error.hint);
}

#define DO(call) check(call, #call)

static void refused(lmn_status status, const char *message, const char *hint)
{
    assert_int_equal(status, LMN_USAGE);
    assert_int_equal(error.status, LMN_USAGE);
    if (!strstr(error.message, message) || !strstr(error.hint, hint))
        fail_msg("'%s' (%s) instead of '%s' (%s)", error.message, error.hint, message, hint);
}

static lmn_look *create(void)
{
    lmn_look *look = NULL;
    DO(lmn_look_create(&look, &error));
    return look;
}

static lmn_look *parse(const char *json)
{
    lmn_look *look = NULL;
    DO(lmn_look_parse(&look, json, "test", &error));
    return look;
}

static void assert_alike(const lmn_look *a, const lmn_look *b)
{
    char *one = lmn_look_json(a), *other = lmn_look_json(b);
    assert_string_equal(one, other);
    lmn_text_free(one);
    lmn_text_free(other);
}

/* --- every parameter ------------------------------------------------------------------------------------ */

/* A parameter in a look. */
typedef struct place {
    lmn_look      *look;
    size_t         rule;
    const char    *kind, *technique;
    lmn_param_info info;
} place;

#define AT(p) (p)->look, (p)->rule, (p)->kind, 0, (p)->info.key

static void assert_text(const place *p, const char *expected)
{
    char text[LMN_VALUE_TEXT_MAX];
    DO(lmn_look_get_text(AT(p), text, sizeof text, &error));
    assert_string_equal(text, expected);
}

/* The call was refused, with the key in its message, and nothing changed. */
static void assert_refused(const place *p, uint64_t revision, const char *text, lmn_status status)
{
    assert_int_equal(status, LMN_USAGE);
    assert_non_null(strstr(error.message, p->info.key));
    assert_int_equal(strncmp(error.message, p->kind, strlen(p->kind)), 0);
    assert_int_equal(lmn_look_revision(p->look), revision);
    assert_text(p, text);
}

static void set_and_get(const place *p, double value)
{
    double got = NAN;
    DO(lmn_look_set_number(AT(p), value, &error));
    DO(lmn_look_get_number(AT(p), &got, &error));
    if (got != (p->info.type == LMN_PARAM_FLOAT ? (double)(float)value : value))
        fail_msg("%s.%s: set to %.9g, it is %.9g", p->kind, p->info.key, value, got);
}

static void try_number(const place *p)
{
    const lmn_param_info *i = &p->info;
    double low = i->min, high = i->max, beside = 1 + fabs(i->min) / 64, behind = 1 + fabs(i->max) / 64, given;
    if (i->type == LMN_PARAM_BOOL)
        low = 0, high = 1;
    if (i->type == LMN_PARAM_ENUM)
        low = 0, high = (double)i->name_count - 1;
    DO(lmn_look_get_number(AT(p), &given, &error));
    assert_true(given == i->default_number || (isnan(given) && i->default_auto));
    assert_true(low < high);
    if (i->soft_min < i->min || i->soft_max > i->max ||
        (i->type <= LMN_PARAM_FLOAT && i->type != LMN_PARAM_BOOL && i->soft_min >= i->soft_max))
        fail_msg("%s.%s: a slider from %g to %g", p->kind, i->key, i->soft_min, i->soft_max);
    set_and_get(p, high);
    set_and_get(p, low);
    char        text[LMN_VALUE_TEXT_MAX];
    uint64_t    revision = lmn_look_revision(p->look);
    const float black[4] = {0, 0, 0, 1};
    DO(lmn_look_get_text(AT(p), text, sizeof text, &error));
    assert_refused(p, revision, text, lmn_look_set_number(AT(p), low - beside, &error));
    assert_refused(p, revision, text, lmn_look_set_number(AT(p), high + behind, &error));
    assert_refused(p, revision, text, lmn_look_set_number(AT(p), NAN, &error));
    assert_refused(p, revision, text, lmn_look_set_number(AT(p), INFINITY, &error));
    if (i->type != LMN_PARAM_FLOAT)
        assert_refused(p, revision, text, lmn_look_set_number(AT(p), low + 0.5, &error));
    assert_refused(p, revision, text, lmn_look_set_colours(AT(p), black, 1, &error));
    assert_refused(p, revision, text, lmn_look_set_text(AT(p), "perhaps", &error));
    set_and_get(p, high);
}

static void try_names(const place *p)
{
    for (size_t i = 0; i < p->info.name_count; i++) {
        double got;
        DO(lmn_look_set_number(AT(p), (double)i, &error));
        assert_text(p, p->info.names[i]);
        DO(lmn_look_set_text(AT(p), p->info.names[p->info.name_count - 1 - i], &error));
        DO(lmn_look_get_number(AT(p), &got, &error));
        assert_true(got == (double)(p->info.name_count - 1 - i));
    }
    assert_null(p->info.names[p->info.name_count]);
    set_and_get(p, (double)p->info.name_count - 1 - p->info.default_number);
}

static void try_colours(const place *p)
{
    const float given[8] = {1, 0.2f, 0, 1, 51 / 255.0f, 0.4f, 1, 0.6f}, wrong[4] = {0, 0, 1.01f, 1};
    float       got[4 * LMN_PALETTE_MAX];
    size_t      count = 99, used = p->info.type == LMN_PARAM_PALETTE ? 2 : 1;
    DO(lmn_look_get_colours(AT(p), got, &count, &error));
    assert_int_equal(count == 0, p->info.default_auto);
    DO(lmn_look_set_colours(AT(p), given, used, &error));
    DO(lmn_look_get_colours(AT(p), got, &count, &error));
    assert_int_equal(count, used);
    for (size_t i = 0; i < 4 * used; i++)
        assert_true(fabsf(got[i] - given[i]) < 1e-6f);
    assert_text(p, used == 2 ? "#ff3300,#3366ff99" : "#ff3300");
    uint64_t revision = lmn_look_revision(p->look);
    assert_refused(p, revision, used == 2 ? "#ff3300,#3366ff99" : "#ff3300",
                   lmn_look_set_colours(AT(p), wrong, 1, &error));
    assert_int_equal(lmn_look_set_colours(AT(p), given, 0, &error), LMN_USAGE);
    assert_int_equal(lmn_look_set_colours(AT(p), given, used == 2 ? 9 : 2, &error), LMN_USAGE);
    assert_int_equal(lmn_look_set_number(AT(p), 0, &error), LMN_USAGE);
    assert_int_equal(lmn_look_revision(p->look), revision);
}

static void try_direction(const place *p)
{
    const double given[3] = {-0.25, 0.1, 0.5}, none[3] = {0, 0, 0}, wrong[3] = {0, NAN, 1};
    double       got[3];
    DO(lmn_look_set_direction(AT(p), given, &error));
    DO(lmn_look_get_direction(AT(p), got, &error));
    for (int i = 0; i < 3; i++)
        assert_true(got[i] == (double)(float)given[i]);
    uint64_t revision = lmn_look_revision(p->look);
    assert_refused(p, revision, "-0.25,0.1,0.5", lmn_look_set_direction(AT(p), none, &error));
    assert_refused(p, revision, "-0.25,0.1,0.5", lmn_look_set_direction(AT(p), wrong, &error));
}

static void try_words(const place *p)
{
    const kind  *k = kind_find(p->kind);
    const param *row = kind_find_param(k, kind_find_technique(k, p->technique), p->info.key);
    const char  *example = row->example ? row->example : p->info.is_selector ? "Wheel*" : "x";
    double       number;
    DO(lmn_look_set_text(AT(p), example, &error));
    assert_text(p, example);
    assert_int_equal(lmn_look_get_number(AT(p), &number, &error), LMN_USAGE);
    assert_refused(p, lmn_look_revision(p->look), example, lmn_look_set_text(AT(p), "\001", &error));
}

static void try_auto(const place *p)
{
    lmn_param_state s;
    uint64_t        before = lmn_look_revision(p->look);
    char            text[LMN_VALUE_TEXT_MAX];
    double          number = 0;
    DO(lmn_look_get_text(AT(p), text, sizeof text, &error));
    if (!p->info.can_auto) {
        assert_refused(p, before, text, lmn_look_set_auto(AT(p), &error));
        return;
    }
    DO(lmn_look_set_auto(AT(p), &error));
    DO(lmn_look_param_state(AT(p), &s, &error));
    assert_true(s.is_auto && s.is_default == p->info.default_auto);
    assert_text(p, "auto");
    if (p->info.type == LMN_PARAM_FLOAT) {
        DO(lmn_look_get_number(AT(p), &number, &error));
        assert_true(isnan(number));
    }
    DO(lmn_look_set_text(AT(p), text, &error));
}

/* Leaves it other than its default where that has a text. */
static void try_param(const place *p)
{
    lmn_param_state s = {.is_default = false};
    lmn_param_info  found;
    DO(lmn_param_find(p->kind, p->technique, p->info.key, &found, &error));
    assert_ptr_equal(found.key, p->info.key);
    assert_true(p->info.doc[0] && p->info.doc[strlen(p->info.doc) - 1] == '.');
    assert_text(p, p->info.default_text);
    DO(lmn_look_param_state(AT(p), &s, &error));
    assert_true(s.is_default && s.is_auto == p->info.default_auto);
    assert_true(s.applies || p->info.only_if);
    switch (p->info.type) {
    case LMN_PARAM_BOOL:
    case LMN_PARAM_INT:
    case LMN_PARAM_FLOAT: try_number(p); break;
    case LMN_PARAM_ENUM:
        try_number(p);
        try_names(p);
        break;
    case LMN_PARAM_COLOUR:
    case LMN_PARAM_PALETTE: try_colours(p); break;
    case LMN_PARAM_DIRECTION: try_direction(p); break;
    case LMN_PARAM_TEXT: try_words(p); break;
    }
    try_auto(p);
    char text[LMN_VALUE_TEXT_MAX];
    DO(lmn_look_get_text(AT(p), text, sizeof text, &error));
    DO(lmn_look_param_state(AT(p), &s, &error));
    assert_int_equal(s.is_default, strcmp(text, p->info.default_text) == 0);
    DO(lmn_look_reset(AT(p), &error));
    DO(lmn_look_param_state(AT(p), &s, &error));
    assert_true(s.is_default);
    assert_text(p, p->info.default_text);
    DO(lmn_look_set_text(AT(p), text, &error));
}

/* A look whose only technique of the kind is this one. */
static lmn_look *look_with(const lmn_kind_info *k, const char *technique)
{
    lmn_look *look = create();
    size_t    rule = k->whole_look ? LMN_WHOLE_LOOK : 0;
    if (lmn_look_technique_count(look, rule, k->name))
        DO(lmn_look_set_technique(look, rule, k->name, 0, technique, &error));
    else
        DO(lmn_look_add_technique(look, rule, k->name, technique, LMN_AT_END, &error));
    assert_int_equal(lmn_look_technique_count(look, rule, k->name), 1);
    assert_string_equal(lmn_look_technique(look, rule, k->name, 0), technique);
    return look;
}

static void try_technique(const lmn_kind_info *k, const lmn_technique_info *t, size_t *count)
{
    lmn_look *look = look_with(k, t->name), *plain = look_with(k, t->name);
    place     p = {look, k->whole_look ? LMN_WHOLE_LOOK : 0, k->name, t->name, {0}};
    for (size_t i = 0; lmn_param_at(k->name, t->name, i, &p.info); i++, ++*count) {
        assert_int_equal(p.info.common, i < t->common_count);
        try_param(&p);
    }
    char     *json = lmn_look_json(look);
    lmn_look *again = parse(json);
    lmn_text_free(json);
    assert_alike(look, again);
    DO(lmn_look_reset(look, p.rule, k->name, 0, NULL, &error));
    assert_alike(look, plain);
    lmn_look_destroy(&again);
    lmn_look_destroy(&plain);
    lmn_look_destroy(&look);
}

static void test_every_parameter(void **state)
{
    (void)state;
    size_t             count = 0, rows = 0;
    lmn_kind_info      k;
    lmn_technique_info t;
    for (size_t i = 0; lmn_kind_at(i, &k); i++) {
        size_t techniques = 0;
        for (; lmn_technique_at(k.name, techniques, &t); techniques++)
            try_technique(&k, &t, &count);
        assert_int_equal(techniques, k.technique_count);
    }
    for (size_t i = 0; i < KIND_COUNT; i++)
        for (size_t n = 0; n < kinds[i]->technique_count; n++)
            rows += kind_param_count(kinds[i], kinds[i]->techniques[n]);
    assert_int_equal(count, rows);
    assert_true(count > 300);
}

/* --- conditions ----------------------------------------------------------------------------------------- */

static void test_conditions(void **state)
{
    (void)state;
    lmn_look       *look = create();
    lmn_param_info  info;
    lmn_param_state s;
    DO(lmn_param_find("finish", "sheet", "relief", &info, &error));
    assert_string_equal(info.only_if, "paper");
    DO(lmn_look_param_state(look, LMN_WHOLE_LOOK, "finish", 0, "relief", &s, &error));
    assert_false(s.applies);
    DO(lmn_look_set_number(look, LMN_WHOLE_LOOK, "finish", 0, "paper", 1, &error));
    DO(lmn_look_param_state(look, LMN_WHOLE_LOOK, "finish", 0, "relief", &s, &error));
    assert_true(s.applies);
    lmn_look_destroy(&look);
}

/* --- whole looks ---------------------------------------------------------------------------------------- */

static void copy_values(lmn_look *to, const lmn_look *from, size_t rule, const lmn_kind_info *k, size_t index)
{
    lmn_param_info info;
    const char    *technique = lmn_look_technique(from, rule, k->name, index);
    for (size_t i = 0; lmn_param_at(k->name, technique, i, &info); i++) {
        lmn_param_state s;
        char            text[LMN_VALUE_TEXT_MAX];
        double          number;
        DO(lmn_look_param_state(from, rule, k->name, index, info.key, &s, &error));
        if (s.is_default)
            continue;
        if (info.type <= LMN_PARAM_ENUM && !s.is_auto) {
            DO(lmn_look_get_number(from, rule, k->name, index, info.key, &number, &error));
            DO(lmn_look_set_number(to, rule, k->name, index, info.key, number, &error));
        } else {
            DO(lmn_look_get_text(from, rule, k->name, index, info.key, text, sizeof text, &error));
            DO(lmn_look_set_text(to, rule, k->name, index, info.key, text, &error));
        }
    }
}

static void copy_kind(lmn_look *to, const lmn_look *from, size_t rule, const lmn_kind_info *k)
{
    size_t count = lmn_look_technique_count(from, rule, k->name);
    for (size_t i = 0; i < count; i++) {
        const char *technique = lmn_look_technique(from, rule, k->name, i);
        if (i < lmn_look_technique_count(to, rule, k->name))
            DO(lmn_look_set_technique(to, rule, k->name, i, technique, &error));
        else
            DO(lmn_look_add_technique(to, rule, k->name, technique, LMN_AT_END, &error));
        copy_values(to, from, rule, k, i);
    }
    while (lmn_look_technique_count(to, rule, k->name) > count)
        DO(lmn_look_remove_technique(to, rule, k->name, count, &error));
}

/* The same by calls alone, as a user interface would. */
static void copy_controls(lmn_look *to, const lmn_look *from)
{
    lmn_control_info info;
    lmn_control_map  maps[64];
    for (size_t i = 0; lmn_control_at(i, &info); i++) {
        size_t count = 0;
        double value;
        while (lmn_look_control_map(from, info.name, count, &maps[count]))
            count++;
        DO(lmn_look_set_control_maps(to, info.name, count ? maps : NULL, count, &error));
        DO(lmn_look_get_control(from, info.name, &value, &error));
        if (count)
            DO(lmn_look_set_control(to, info.name, value, &error));
    }
}

static lmn_look *built(const lmn_look *from)
{
    lmn_look     *to = create();
    lmn_kind_info k;
    DO(lmn_look_set_name(to, lmn_look_name(from), &error));
    DO(lmn_look_set_doc(to, lmn_look_doc(from), &error));
    for (size_t i = 0; i < lmn_look_rule_count(from); i++) {
        size_t at = 99;
        DO(lmn_look_add_rule(to, lmn_look_rule_selector(from, i), i, &at, &error));
        assert_int_equal(at, i);
        DO(lmn_look_set_rule_name(to, i, lmn_look_rule_name(from, i), &error));
    }
    DO(lmn_look_remove_rule(to, lmn_look_rule_count(from), &error));
    for (size_t i = 0; lmn_kind_at(i, &k); i++)
        for (size_t r = 0; r < (k.whole_look ? 1 : lmn_look_rule_count(from)); r++)
            copy_kind(to, from, k.whole_look ? LMN_WHOLE_LOOK : r, &k);
    copy_controls(to, from);
    return to;
}

static void test_looks_by_calls(void **state)
{
    (void)state;
    for (size_t i = 0; i < lmn_look_count(); i++) {
        lmn_look *file = NULL;
        DO(lmn_look_load(&file, lmn_look_name_at(i), &error));
        lmn_look *made = built(file);
        assert_alike(file, made);
        lmn_look_destroy(&made);
        lmn_look_destroy(&file);
    }
    assert_true(lmn_look_count() > 20);
}

static void test_one_look_by_calls(void **state)
{
    (void)state;
    lmn_look *file =
        parse("{\"version\": 2, \"name\": \"two\", \"doc\": \"Two.\", \"finish\": {\"ground\": \"#eeeeff\"},"
              " \"rules\": [{\"select\": \"*\", \"surface\": \"lit\", \"lines\": null},"
              " {\"name\": \"wheels\", \"select\": \"Wheel*\", \"surface\": {\"technique\": \"toon\", "
              "\"bands\": 4}, \"lines\": [\"four-tap\", {\"operator\": \"id\", \"width\": 3, "
              "\"colour\": \"red\"}]}]}");
    lmn_look   *made = create();
    size_t      wheels;
    const float red[4] = {1, 0, 0, 1}, ground[4] = {238 / 255.0f, 238 / 255.0f, 1, 1};
    DO(lmn_look_set_name(made, "two", &error));
    DO(lmn_look_set_doc(made, "Two.", &error));
    DO(lmn_look_set_colours(made, LMN_WHOLE_LOOK, "finish", 0, "ground", ground, 1, &error));
    DO(lmn_look_set_technique(made, 0, "surface", 0, "lit", &error));
    while (lmn_look_technique_count(made, 0, "lines"))
        DO(lmn_look_remove_technique(made, 0, "lines", 0, &error));
    DO(lmn_look_add_rule(made, "Wheel*", LMN_AT_END, &wheels, &error));
    assert_int_equal(wheels, 1);
    DO(lmn_look_set_rule_name(made, 1, "wheels", &error));
    DO(lmn_look_set_technique(made, 1, "surface", 0, "toon", &error));
    DO(lmn_look_set_number(made, 1, "surface", 0, "bands", 4, &error));
    while (lmn_look_technique_count(made, 1, "lines"))
        DO(lmn_look_remove_technique(made, 1, "lines", 0, &error));
    DO(lmn_look_add_technique(made, 1, "lines", "id", LMN_AT_END, &error));
    DO(lmn_look_set_number(made, 1, "lines", 0, "width", 3, &error));
    DO(lmn_look_set_colours(made, 1, "lines", 0, "colour", red, 1, &error));
    DO(lmn_look_add_technique(made, 1, "lines", "four-tap", 0, &error));
    assert_alike(file, made);
    DO(lmn_look_move_technique(made, 1, "lines", 0, 1, &error));
    assert_string_equal(lmn_look_technique(made, 1, "lines", 0), "id");
    assert_string_equal(lmn_look_technique(made, 1, "lines", 1), "four-tap");
    lmn_look_destroy(&made);
    lmn_look_destroy(&file);
}

/* --- rules and techniques ------------------------------------------------------------------------------- */

static void assert_order(const lmn_look *look, const char *expected)
{
    char   order[64] = "";
    size_t used = 0;
    for (size_t i = 0; i < lmn_look_rule_count(look); i++)
        used += (size_t)snprintf(order + used, sizeof order - used, "%s", lmn_look_rule_selector(look, i));
    assert_string_equal(order, expected);
}

static void test_rules(void **state)
{
    (void)state;
    lmn_look *look = create();
    size_t    at;
    assert_order(look, "*");
    refused(lmn_look_remove_rule(look, 0, &error), "no other rule", "add another one");
    DO(lmn_look_add_rule(look, "b", LMN_AT_END, &at, &error));
    DO(lmn_look_add_rule(look, "a", 1, &at, &error));
    DO(lmn_look_add_rule(look, "c", 3, NULL, &error));
    assert_order(look, "*abc");
    DO(lmn_look_move_rule(look, 0, 3, &error));
    assert_order(look, "abc*");
    DO(lmn_look_move_rule(look, 2, 0, &error));
    assert_order(look, "cab*");
    DO(lmn_look_set_rule_selector(look, 1, "[key=x]", &error));
    DO(lmn_look_remove_rule(look, 0, &error));
    assert_order(look, "[key=x]b*");
    uint64_t revision = lmn_look_revision(look);
    refused(lmn_look_set_rule_selector(look, 1, "[key", &error), "']' is missing", "for example");
    refused(lmn_look_add_rule(look, ",", LMN_AT_END, &at, &error), "nothing stands before", "");
    refused(lmn_look_add_rule(look, "*", 4, &at, &error), "before rule 4", "");
    refused(lmn_look_remove_rule(look, 3, &error), "rules 0 to 2", "");
    refused(lmn_look_move_rule(look, 0, 3, &error), "there is no rule 3", "");
    refused(lmn_look_set_rule_name(look, LMN_WHOLE_LOOK, "x", &error), "no rule", "");
    assert_order(look, "[key=x]b*");
    DO(lmn_look_move_rule(look, 1, 1, &error));
    DO(lmn_look_set_rule_selector(look, 1, "b", &error));
    assert_int_equal(lmn_look_revision(look), revision);
    DO(lmn_look_set_rule_name(look, 1, "bees", &error));
    assert_string_equal(lmn_look_rule_name(look, 1), "bees");
    DO(lmn_look_set_rule_name(look, 1, NULL, &error));
    assert_null(lmn_look_rule_name(look, 1));
    while (lmn_look_rule_count(look) < LIMIT_LOOK_RULES)
        DO(lmn_look_add_rule(look, "*", LMN_AT_END, NULL, &error));
    assert_int_equal(lmn_look_add_rule(look, "*", LMN_AT_END, NULL, &error), LMN_LIMIT);
    lmn_look_destroy(&look);
}

static void test_techniques(void **state)
{
    (void)state;
    lmn_look *look = create();
    double    width;
    refused(lmn_look_set_technique(look, 0, "surfaces", 0, "lit", &error), "no kind 'surfaces'", "surface");
    refused(lmn_look_set_technique(look, 0, "surface", 0, "tonn", &error), "no surface technique 'tonn'", "toon");
    refused(lmn_look_add_technique(look, 0, "surface", "toon", LMN_AT_END, &error), "one technique", "exchange");
    refused(lmn_look_remove_technique(look, 0, "surface", 0, &error), "cannot be none", "lit");
    refused(lmn_look_set_technique(look, 0, "surface", 1, "lit", &error), "no surface[1]", "");
    refused(lmn_look_set_technique(look, 0, "finish", 0, "sheet", &error), "whole look", "LMN_WHOLE_LOOK");
    refused(lmn_look_add_technique(look, LMN_WHOLE_LOOK, "finish", "sheet", 0, &error), "exchange", "");
    refused(lmn_look_remove_technique(look, LMN_WHOLE_LOOK, "finish", 0, &error), "cannot be none", "");
    refused(lmn_look_set_technique(look, LMN_WHOLE_LOOK, "surface", 0, "lit", &error), "no rule", "");
    while (lmn_look_technique_count(look, 0, "lines"))
        DO(lmn_look_remove_technique(look, 0, "lines", 0, &error));
    refused(lmn_look_set_number(look, 0, "lines", 0, "width", 1, &error), "no technique", "");
    DO(lmn_look_add_technique(look, 0, "lines", "four-tap", LMN_AT_END, &error));
    DO(lmn_look_set_number(look, 0, "lines", 0, "width", 1.25, &error));
    DO(lmn_look_set_technique(look, 0, "lines", 0, "sobel", &error));
    DO(lmn_look_get_number(look, 0, "lines", 0, "width", &width, &error));
    assert_true(width == 1.25);
    refused(lmn_look_set_number(look, 0, "lines", 0, "widht", 1, &error), "no parameter 'widht'", "width");
    refused(lmn_look_set_number(look, 0, "lines", 0, "width", 1e9, &error), "lines.width", "");
    refused(lmn_look_add_technique(look, 0, "lines", "id", 2, &error), "before lines[2]", "");
    while (lmn_look_technique_count(look, 0, "lines") < LIMIT_LOOK_TECHNIQUES)
        DO(lmn_look_add_technique(look, 0, "lines", "id", 0, &error));
    assert_int_equal(lmn_look_add_technique(look, 0, "lines", "id", 0, &error), LMN_LIMIT);
    assert_null(lmn_look_technique(look, 0, "lines", LIMIT_LOOK_TECHNIQUES));
    assert_int_equal(lmn_look_technique_count(look, 7, "lines"), 0);
    lmn_look_destroy(&look);
}

/* --- changes -------------------------------------------------------------------------------------------- */

static unsigned last;

/* What has changed since this was asked last. */
static unsigned news(const lmn_look *look)
{
    static uint64_t seen;
    last = lmn_look_changes(look, seen);
    seen = lmn_look_revision(look);
    return last;
}

static void test_changes(void **state)
{
    (void)state;
    const unsigned values = LMN_CHANGE_VALUES, all = LOOK_CHANGE_ALL;
    lmn_look *look = parse("{\"version\": 2, \"rules\": [{\"surface\": \"pencil\", \"lines\": \"discontinuity\"}]}");
    assert_int_equal(news(look), all);
    assert_int_equal(news(look), 0);
    DO(lmn_look_set_number(look, 0, "lines", 0, "gain", 1.75, &error));
    assert_int_equal(news(look), values);
    uint64_t revision = lmn_look_revision(look);
    DO(lmn_look_set_number(look, 0, "lines", 0, "gain", 1.75, &error));
    DO(lmn_look_set(look, "lines.gain", "1.75", &error));
    assert_int_equal(lmn_look_revision(look), revision);
    DO(lmn_look_set(look, "lines.gain", "2", &error));
    assert_true(lmn_look_revision(look) > revision);
    assert_int_equal(news(look), values);
    DO(lmn_look_set_technique(look, 0, "lines", 0, "four-tap", &error)); /* passes for lines of several pixels */
    news(look);
    DO(lmn_look_set_number(look, 0, "lines", 0, "width", 2, &error));
    assert_int_equal(news(look), values | LMN_CHANGE_PLAN | LMN_CHANGE_PROGRAMS);
    DO(lmn_look_set_technique(look, 0, "lines", 0, "discontinuity", &error));
    news(look);
    DO(lmn_look_set_number(look, 0, "lines", 0, "parts", 0, &error)); /* a variant */
    assert_true(news(look) & LMN_CHANGE_PROGRAMS);
    assert_false(last & (LMN_CHANGE_MESHES | LMN_CHANGE_TEXTURES));
    DO(lmn_look_set_number(look, 0, "surface", 0, "ragged", 0, &error)); /* toggles */
    DO(lmn_look_set_number(look, 0, "surface", 0, "ragged", 0.5, &error));
    assert_true(news(look) & LMN_CHANGE_PROGRAMS);
    DO(lmn_look_set_number(look, 0, "surface", 0, "ragged", 0.75, &error));
    assert_int_equal(news(look), values);
    DO(lmn_look_set_number(look, 0, "surface", 0, "map_seed", 77, &error));
    news(look);
    DO(lmn_look_set_number(look, 0, "surface", 0, "map_seed", 78, &error));
    assert_int_equal(news(look), values | LMN_CHANGE_TEXTURES);
    DO(lmn_look_set_number(look, LMN_WHOLE_LOOK, "scene", 0, "crease_angle", 61, &error));
    assert_int_equal(news(look), values | LMN_CHANGE_MESHES);
    DO(lmn_look_set_text(look, LMN_WHOLE_LOOK, "scene", 0, "cut", "x=0.5", &error));
    assert_int_equal(news(look), values | LMN_CHANGE_MESHES | LMN_CHANGE_PLAN | LMN_CHANGE_PROGRAMS);
    DO(lmn_look_set_rule_selector(look, 0, "Wheel*", &error));
    assert_int_equal(news(look), all);
    DO(lmn_look_set_rule_name(look, 0, "wheels", &error));
    assert_int_equal(news(look), values);
    DO(lmn_look_set_technique(look, 0, "lines", 0, "sobel", &error));
    assert_int_equal(news(look), all);
    lmn_look_destroy(&look);
}

static void test_copies(void **state)
{
    (void)state;
    lmn_look *look = NULL, *copy = NULL;
    for (size_t i = 0; i < lmn_look_count(); i++) {
        DO(lmn_look_load(&look, lmn_look_name_at(i), &error));
        DO(lmn_look_copy(&copy, look, &error));
        assert_alike(look, copy);
        assert_true(lmn_look_revision(copy) > lmn_look_revision(look));
        uint64_t revision = lmn_look_revision(look);
        DO(lmn_look_set_text(copy, LMN_WHOLE_LOOK, "finish", 0, "ground", "#010203", &error));
        DO(lmn_look_add_rule(copy, "x", LMN_AT_END, NULL, &error));
        assert_int_equal(lmn_look_revision(look), revision);
        lmn_look *again = NULL;
        DO(lmn_look_load(&again, lmn_look_name_at(i), &error));
        assert_alike(look, again);
        lmn_look_destroy(&again);
        lmn_look_destroy(&look);
        assert_int_equal(lmn_look_rule_count(copy) > 1, true);
        lmn_look_destroy(&copy);
    }
}

/* --- what goes wrong ------------------------------------------------------------------------------------ */

static lmn_status edit(lmn_look *look, int which)
{
    lmn_look  *copy = NULL;
    lmn_status status;
    switch (which) {
    case 0: return lmn_look_add_rule(look, "a [b=c]", 0, NULL, &error);
    case 1: return lmn_look_set_rule_selector(look, 0, "Wheel*, !a", &error);
    case 2: return lmn_look_set_rule_name(look, 0, "other", &error);
    case 3: return lmn_look_set_technique(look, 0, "surface", 0, "hatch", &error);
    case 4: return lmn_look_add_technique(look, 0, "lines", "id", 0, &error);
    case 5: return lmn_look_set_number(look, 0, "lines", 0, "width", 3, &error);
    case 6: return lmn_look_set(look, "lines.width", "4", &error);
    case 7: return lmn_look_set(look, "surface.technique", "flat", &error);
    case 8: return lmn_look_set_text(look, LMN_WHOLE_LOOK, "scene", 0, "cut_keep", "Wheel*", &error);
    case 9: return lmn_look_set_doc(look, "Other.", &error);
    case 10:
        status = lmn_look_copy(&copy, look, &error);
        lmn_look_destroy(&copy);
        return status;
    default: return LMN_USAGE;
    }
}

static void test_memory(void **state)
{
    (void)state;
    static const char json[] =
        "{\"version\": 2, \"rules\": [{\"lines\": [\"four-tap\", \"sobel\"]}, {\"select\": \"a\", "
        "\"surface\": \"toon\", \"lines\": \"id\"}]}";
    for (int which = 0; which <= 10; which++) {
        lmn_look  *look = parse(json), *same = parse(json);
        lmn_status status = LMN_MEMORY;
        for (long n = 1; status == LMN_MEMORY && n < 1000; n++) {
            mem_fail_at(n);
            status = edit(look, which);
            mem_fail_at(0);
            if (status == LMN_MEMORY)
                assert_alike(look, same);
        }
        check(status, "edit");
        lmn_look_destroy(&same);
        lmn_look_destroy(&look);
    }
}

/* Several rules are set one after the other; the second refuses. */
static void test_all_or_nothing(void **state)
{
    (void)state;
    static const char json[] = "{\"version\": 2, \"rules\": [{\"surface\": \"toon\"}, {\"surface\": \"lit\"}]}";
    lmn_look         *look = parse(json), *same = parse(json);
    uint64_t          revision = lmn_look_revision(look);
    assert_int_equal(lmn_look_set(look, "surface.bands", "1000", &error), LMN_USAGE);
    assert_alike(look, same);
    assert_int_equal(lmn_look_revision(look), revision);
    lmn_look_destroy(&same);
    lmn_look_destroy(&look);
}

/* Each way is told again by the look that has it, also after each other one and with another exposure; what it does not
 * set stays, and what is refused changes nothing. */
static void test_motion_ways(void **state)
{
    (void)state;
    static const char json[] =
        "{\"version\": 2, \"rules\": [{\"motion\": {\"technique\": \"traces\", "
        "\"colour\": \"#ff0000\", \"stretch\": 0.25}}, {\"select\": \"a\", \"motion\": \"blur\"}]}";
    lmn_motion_way_info way, other;
    lmn_look           *look = parse(json), *same;
    char                text[LMN_VALUE_TEXT_MAX];
    size_t              count = 0;
    for (; lmn_motion_way_at(count, &way); count++)
        for (size_t i = 0; lmn_motion_way_at(i, &other); i++) {
            assert_int_equal(lmn_look_set_motion_way(look, other.name, &error), LMN_OK);
            assert_string_equal(lmn_look_motion_way(look), other.name);
            assert_int_equal(lmn_look_set_motion_way(look, way.name, &error), LMN_OK);
            assert_int_equal(lmn_look_set(look, "motion.exposure", "0.125", &error), LMN_OK);
            assert_string_equal(lmn_look_motion_way(look), way.name);
            assert_string_equal(lmn_look_technique(look, 1, "motion", 0), way.technique);
        }
    assert_int_equal(count, 11);
    assert_false(lmn_motion_way_at(count, &way));
    lmn_look_destroy(&look);
    look = parse(json);
    assert_int_equal(lmn_look_set_motion_way(look, "ghosts", &error), LMN_OK);
    assert_int_equal(lmn_look_get_text(look, 0, "motion", 0, "colour", text, sizeof text, &error), LMN_OK);
    assert_string_equal(text, "#ff0000");
    assert_int_equal(lmn_look_get_text(look, 0, "motion", 0, "stretch", text, sizeof text, &error), LMN_OK);
    assert_string_equal(text, "0.25");
    assert_int_equal(lmn_look_set_motion_way(look, "speed-lines", &error), LMN_OK);
    assert_int_equal(lmn_look_get_text(look, 0, "motion", 0, "lines", text, sizeof text, &error), LMN_OK);
    assert_string_equal(text, "24"); /* not the ghosts' 0 */
    assert_int_equal(lmn_look_copy(&same, look, &error), LMN_OK);
    refused(lmn_look_set_motion_way(look, "gosts", &error), "there is no motion technique 'gosts'", "");
    assert_alike(look, same);
    assert_int_equal(lmn_look_set_motion_way(look, "streaks", &error), LMN_OK);
    assert_string_equal(lmn_look_technique(look, 0, "motion", 0), "streaks");
    assert_null(lmn_look_motion_way(look));
    assert_int_equal(lmn_look_set_motion_way(look, "none", &error), LMN_OK);
    assert_int_equal(lmn_look_technique_count(look, 0, "motion"), 0);
    lmn_look_destroy(&same);
    lmn_look_destroy(&look);
}

static void test_missing_arguments(void **state)
{
    (void)state;
    lmn_look       *look = create();
    double          number = 0, three[3] = {1, 0, 0};
    float           rgba[4 * LMN_PALETTE_MAX] = {0};
    size_t          count;
    char            text[8];
    lmn_param_state s;
    lmn_param_info  info;
    assert_false(lmn_kind_at(KIND_COUNT, &(lmn_kind_info){0}) || lmn_kind_at(0, NULL));
    assert_false(lmn_technique_at(NULL, 0, &(lmn_technique_info){0}) ||
                 lmn_technique_at("lines", 999, &(lmn_technique_info){0}));
    assert_false(lmn_param_at("lines", NULL, 0, &info) || lmn_param_at("lines", "id", 0, NULL) ||
                 lmn_param_at("lines", "id", 999, &info));
    refused(lmn_param_find("lines", "id", "colour", NULL, &error), "out is NULL", "");
    refused(lmn_param_find("lines", "id", "colur", &info, &error), "no parameter", "colour");
    refused(lmn_look_create(NULL, &error), "out is NULL", "");
    refused(lmn_look_copy(&look, NULL, &error), "look is NULL", "");
    refused(lmn_look_set_name(look, NULL, &error), "name is NULL", "");
    refused(lmn_look_add_rule(look, NULL, 0, NULL, &error), "selector is NULL", "");
    refused(lmn_look_set_technique(look, 0, NULL, 0, "id", &error), "kind is NULL", "");
    refused(lmn_look_set_technique(look, 0, "lines", 0, NULL, &error), "technique is NULL", "");
    refused(lmn_look_set_number(NULL, 0, "lines", 0, "width", 1, &error), "look is NULL", "");
    refused(lmn_look_set_number(look, 0, "surface", 0, NULL, 1, &error), "key is NULL", "");
    refused(lmn_look_get_number(look, 0, "surface", 0, "x", NULL, &error), "out is NULL", "");
    refused(lmn_look_set_text(look, 0, "surface", 0, "x", NULL, &error), "value is NULL", "");
    refused(lmn_look_set_colours(look, 0, "surface", 0, "x", NULL, 1, &error), "rgba is NULL", "");
    refused(lmn_look_get_colours(look, 0, "surface", 0, "x", rgba, NULL, &error), "count is NULL", "");
    refused(lmn_look_get_colours(look, 0, "surface", 0, "x", NULL, &count, &error), "rgba is NULL", "");
    refused(lmn_look_set_direction(look, 0, "surface", 0, "x", NULL, &error), "value is NULL", "");
    refused(lmn_look_get_direction(look, LMN_WHOLE_LOOK, "finish", 0, "ground", three, &error), "finish.ground", "");
    refused(lmn_look_param_state(NULL, 0, "surface", 0, "x", &s, &error), "look is NULL", "");
    refused(lmn_look_get_text(look, LMN_WHOLE_LOOK, "finish", 0, "ground", text, 7, &error), "8 bytes",
            "LMN_VALUE_TEXT_MAX");
    DO(lmn_look_get_text(look, LMN_WHOLE_LOOK, "finish", 0, "ground", text, 8, &error));
    assert_int_equal(lmn_look_set_number(look, 0, "lines", 0, "width", number, NULL), LMN_USAGE);
    assert_int_equal(lmn_look_revision(NULL), 0);
    assert_int_equal(lmn_look_changes(NULL, 0), 0);
    assert_int_equal(lmn_look_rule_count(NULL), 0);
    assert_null(lmn_look_rule_selector(look, 1));
    assert_null(lmn_look_doc(NULL));
    lmn_look_destroy(&look);
}

/* A slider is drawn at up to 240 pictures a second: setting what it shows takes next to nothing of that. */
static void test_time(void **state)
{
    (void)state;
    enum { TIMES = 2000 };
    struct timespec begin, end;
    lmn_look       *look = NULL;
    DO(lmn_look_load(&look, "pencil", &error));
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
    for (int i = 0; i < TIMES; i++)
        DO(lmn_look_set_number(look, 0, "surface", 0, "opacity", 0.25 + 0.5 * i / TIMES, &error));
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
    double ms = ((double)(end.tv_sec - begin.tv_sec) * 1e3 + (double)(end.tv_nsec - begin.tv_nsec) / 1e6) / TIMES;
    print_message("setting a number: %.4f ms\n", ms);
    assert_true(ms < 0.1);
    lmn_look_destroy(&look);
}

/* --- controls ------------------------------------------------------------------------------------------- */

static const char with_controls[] =
    "{\"version\": 2, \"controls\": {\"weight\": {\"value\": 0.5, \"maps\": [\n"
    "  {\"param\": \"lines.width\", \"times\": [0.25, 4]}, {\"param\": \"surface.ambient\", \"plus\": [0.5, "
    "-0.5]}]}},\n"
    " \"rules\": [{\"select\": \"*\", \"surface\": \"lit\", \"lines\": \"discontinuity\"}]}";

/* What a control makes of a number, by the laws that the header gives. */
static void check_applied(double value, double width, double ambient)
{
    lmn_look *look = parse(with_controls);
    double    is;
    DO(lmn_look_set_control(look, "weight", value, &error));
    look_apply_controls(look);
    DO(lmn_look_get_number(look, 0, "lines", 0, "width", &is, &error));
    assert_true(fabs(is - width) < 1e-5);
    DO(lmn_look_get_number(look, 0, "surface", 0, "ambient", &is, &error));
    assert_true(fabs(is - ambient) < 1e-5);
    lmn_look_destroy(&look);
}

static void controls_change_numbers(void **state)
{
    (void)state;
    check_applied(0, 1.5, 0.35);
    check_applied(1, 6, 0); /* 0.35 - 0.5 ends at the range */
    check_applied(0.5, 3, 0.1);
    check_applied(-0.5, 0.75, 0.6);
    check_applied(-1, 0.375, 0.85);
}

static void controls_stay_beside_values(void **state)
{
    (void)state;
    lmn_look *look = parse(with_controls), *other = NULL;
    double    is;
    DO(lmn_look_get_control(look, "weight", &is, &error));
    assert_true(is == 0.5);
    DO(lmn_look_get_number(look, 0, "lines", 0, "width", &is, &error));
    assert_true(is == 1.5);
    DO(lmn_look_copy(&other, look, &error));
    assert_alike(look, other);
    char     *json = lmn_look_json(look);
    lmn_look *again = parse(json);
    assert_alike(look, again);
    DO(lmn_look_get_control(again, "weight", &is, &error));
    assert_true(is == 0.5);
    uint64_t since = lmn_look_revision(look);
    DO(lmn_look_set(look, "weight", "0.5", &error));
    assert_int_equal(lmn_look_changes(look, since), 0);
    DO(lmn_look_set(look, "weight", "-0.25", &error));
    assert_int_equal(lmn_look_changes(look, since) & LMN_CHANGE_VALUES, LMN_CHANGE_VALUES);
    lmn_text_free(json);
    lmn_look_destroy(&again);
    lmn_look_destroy(&other);
    lmn_look_destroy(&look);
}

static void wrong_file(const char *controls, const char *message)
{
    char      json[512];
    lmn_look *look = NULL;
    snprintf(json, sizeof json, "{\"version\": 2, \"controls\": %s, \"rules\": [{\"lines\": \"discontinuity\"}]}",
             controls);
    assert_int_equal(lmn_look_parse(&look, json, "test", &error), LMN_FORMAT);
    if (!strstr(error.message, message))
        fail_msg("'%s' instead of '%s'", error.message, message);
    assert_null(look);
}

static void controls_are_refused(void **state)
{
    (void)state;
    lmn_look *look = parse(with_controls), *bare = create();
    double    is;
    refused(lmn_look_set(look, "weight", "1.5", &error), "allowed is -1 to 1", "");
    refused(lmn_look_set(look, "weight", "nan", &error), "weight is", "");
    refused(lmn_look_set(look, "weight", "heavy", &error), "weight is 'heavy'", "");
    refused(lmn_look_set(look, "scale", "1", &error), "has no control 'scale'", "it has weight");
    refused(lmn_look_set(bare, "weight", "1", &error), "has no control 'weight'", "controls");
    refused(lmn_look_set_control(look, "wieght", 1, &error), "no control 'wieght'", "weight");
    refused(lmn_look_get_control(look, "heft", &is, &error), "no control 'heft'", "");
    assert_true(lmn_look_has_control(look, "weight") && !lmn_look_has_control(look, "scale"));
    refused(lmn_look_set_control_maps(look, "scale", &(lmn_control_map){"lines.width", true, -1, 2}, 1, &error),
            "above 0", "");
    refused(lmn_look_set_control_maps(look, "scale", &(lmn_control_map){"lines", true, 1, 2}, 1, &error),
            "does not name", "");
    refused(lmn_look_set_control_maps(look, "scale", &(lmn_control_map){NULL, true, 1, 2}, 1, &error), "NULL", "");
    assert_true(lmn_look_has_control(look, "weight") && !lmn_look_has_control(look, "scale"));
    DO(lmn_look_set_control_maps(look, "weight", NULL, 0, &error));
    assert_false(lmn_look_has_control(look, "weight"));
    lmn_look_destroy(&look);
    look = parse(with_controls);
    wrong_file("[]", "must be an object");
    wrong_file("{\"heft\": {\"maps\": []}}", "no control 'heft'");
    wrong_file("{\"weight\": {\"maps\": []}}", "controls.weight.maps: must be an array");
    wrong_file("{\"weight\": {\"maps\": [{\"param\": \"lines.widht\", \"times\": [1, 2]}]}}", "widht");
    wrong_file("{\"weight\": {\"maps\": [{\"param\": \"lines.colour\", \"times\": [1, 2]}]}}", "is no number");
    wrong_file("{\"weight\": {\"maps\": [{\"param\": \"lines.width\", \"times\": [0, 2]}]}}", "above 0");
    wrong_file("{\"weight\": {\"maps\": [{\"param\": \"lines.width\", \"times\": [1]}]}}", "two numbers");
    wrong_file("{\"weight\": {\"maps\": [{\"param\": \"lines.width\", \"plus\": [0, 1], \"times\": [1, 2]}]}}",
               "either 'times' or 'plus'");
    wrong_file("{\"weight\": {\"value\": 2, \"maps\": [{\"param\": \"lines.width\", \"times\": [1, 2]}]}}",
               "weight is 2");
    lmn_look_destroy(&bare);
    lmn_look_destroy(&look);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(controls_change_numbers),
        cmocka_unit_test(controls_stay_beside_values),
        cmocka_unit_test(controls_are_refused),
        cmocka_unit_test(test_every_parameter),
        cmocka_unit_test(test_conditions),
        cmocka_unit_test(test_looks_by_calls),
        cmocka_unit_test(test_one_look_by_calls),
        cmocka_unit_test(test_rules),
        cmocka_unit_test(test_techniques),
        cmocka_unit_test(test_changes),
        cmocka_unit_test(test_copies),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_all_or_nothing),
        cmocka_unit_test(test_motion_ways),
        cmocka_unit_test(test_missing_arguments),
        cmocka_unit_test(test_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
