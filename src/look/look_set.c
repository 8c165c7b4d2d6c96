/* Setting one parameter of a look from text: "KIND.PARAM", "KIND[i].PARAM" or "RULE:KIND.PARAM", or
 * one control by its name. */
#include "look/look.h"
#include "look/look_change.h"
#include "look/look_edit.h"
#include "look/value.h"

#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"

enum { WORD_SIZE = 128, ALL = -1 };

typedef struct address {
    const char *whole;           /* as given */
    char        rule[WORD_SIZE]; /* empty: all rules */
    char        kind_name[WORD_SIZE], key[WORD_SIZE];
    const kind *kind;
    long long   index; /* ALL: every technique of the array */
} address;

static bool copy_word(char out[WORD_SIZE], const char *from, size_t length)
{
    if (length >= WORD_SIZE)
        return false;
    memcpy(out, from, length);
    out[length] = '\0';
    return length > 0;
}

static lmn_status wrong_form(const address *a, lmn_error *error)
{
    lmn_status status = error_set(error, LMN_USAGE, "'%.120s' does not name a parameter", a->whole);
    error_hint(error, "the form is KIND.PARAM, KIND[i].PARAM or RULE:KIND.PARAM, for example lines.width; controls are "
                      "weight, darkness, detail, looseness and scale");
    return status;
}

/* Rule names may hold any character, kinds and keys no ':' — so the last one is the border. */
static lmn_status parse_address(address *a, const char *given, lmn_error *error)
{
    *a = (address){.whole = given, .index = ALL};
    const char *colon = strrchr(given, ':'), *at = colon ? colon + 1 : given, *dot = strchr(at, '.');
    if ((colon && !copy_word(a->rule, given, (size_t)(colon - given))) || !dot)
        return wrong_form(a, error);
    const char *bracket = memchr(at, '[', (size_t)(dot - at));
    if (!copy_word(a->kind_name, at, (size_t)((bracket ? bracket : dot) - at)) ||
        !copy_word(a->key, dot + 1, strlen(dot + 1)))
        return wrong_form(a, error);
    if (bracket && (dot[-1] != ']' || text_parse_int(bracket + 1, dot - 1, &a->index) != dot - 1 || a->index < 0))
        return wrong_form(a, error);
    a->kind = kind_find(a->kind_name);
    return a->kind ? LMN_OK : kind_unknown(a->kind_name, a->key, error);
}

static bool rule_is_meant(const lmn_look *look, const address *a, size_t index)
{
    long long number;
    bool      named = false;
    if (!a->rule[0])
        return true;
    for (size_t i = 0; i < look->rule_count; i++)
        named = named || (look->rules[i].name && strcmp(look->rules[i].name, a->rule) == 0);
    if (named)
        return look->rules[index].name && strcmp(look->rules[index].name, a->rule) == 0;
    return text_is_int(a->rule, &number) && number == (long long)index;
}

static lmn_status check_rule(const lmn_look *look, const address *a, lmn_error *error)
{
    const char *names[LIMIT_LOOK_RULES];
    size_t      count = 0;
    for (size_t i = 0; i < look->rule_count; i++) {
        if (rule_is_meant(look, a, i))
            return LMN_OK;
        if (look->rules[i].name)
            names[count++] = look->rules[i].name;
    }
    lmn_status  status = error_set(error, LMN_USAGE, "look '%.60s' has no rule '%.60s'", look->name, a->rule);
    const char *near = text_nearest(a->rule, names, count);
    if (near)
        error_hint(error, "did you mean '%s'?", near);
    else
        error_hint(error, "a rule is its name or its number, 0 to %zu", look->rule_count - 1);
    return status;
}

/* --- exchanging techniques ------------------------------------------------------------------------------ */

static void remove_uses(rule *r, const kind *k, long long index)
{
    technique_use *uses = r->uses[k->id];
    size_t         kept = 0;
    for (size_t i = 0; i < r->use_counts[k->id]; i++) {
        if (index == ALL || (long long)i == index)
            use_release(&uses[i]);
        else
            uses[kept++] = uses[i];
    }
    r->use_counts[k->id] = kept;
}

/* Makes `t` the one technique of the kind, or exchanges or appends the one at `index`. */
static lmn_status put_use(rule *r, const kind *k, long long index, const technique *t, lmn_error *error)
{
    size_t count = r->use_counts[k->id], at = index == ALL ? 0 : (size_t)index;
    if (at >= count) {
        technique_use *grown = mem_realloc(r->uses[k->id], (count + 1) * sizeof *grown);
        if (!grown)
            return error_memory(error);
        grown[count] = (technique_use){0};
        r->uses[k->id] = grown;
        if (!use_create(&grown[count], k, t))
            return error_memory(error);
        r->use_counts[k->id]++;
        return LMN_OK;
    }
    if (!use_exchange(&r->uses[k->id][at], k, t))
        return error_memory(error);
    while (index == ALL && r->use_counts[k->id] > 1)
        use_release(&r->uses[k->id][--r->use_counts[k->id]]);
    return LMN_OK;
}

/* Can the technique at this index be put there: is one there, or is it the next? */
static lmn_status check_index(const lmn_look *look, const address *a, bool appending, lmn_error *error)
{
    size_t most = 0;
    for (size_t i = 0; i < look->rule_count; i++)
        if (rule_is_meant(look, a, i) && look->rules[i].use_counts[a->kind->id] > most)
            most = look->rules[i].use_counts[a->kind->id];
    if (a->index < (long long)most ||
        (appending && a->kind->array && a->index == (long long)most && most < LIMIT_LOOK_TECHNIQUES))
        return LMN_OK;
    if (most == 0)
        return error_set(error, LMN_USAGE, "'%.120s': look '%.60s' has no %s", a->whole, look->name, a->kind->name);
    return error_set(error, LMN_USAGE, "'%.120s': look '%.60s' has %s[0] to [%zu] only", a->whole, look->name,
                     a->kind->name, most - 1);
}

static lmn_status set_technique(lmn_look *look, const address *a, const char *value, lmn_error *error)
{
    const kind      *k = a->kind;
    const technique *t = techniques_find(look->techniques, k, value);
    bool             none = !t && strcmp(value, "none") == 0 && kind_may_be_none(k), any = false;
    if (!t && !none)
        return kind_unknown_technique(k, look->techniques, value, error);
    if (k->look_wide)
        return use_exchange(&look->wide[k->id], k, t) ? LMN_OK : error_memory(error);
    lmn_status status = a->index == ALL ? LMN_OK : check_index(look, a, !none, error);
    /* A rule without the kind is left alone as long as another rule has it. */
    for (size_t i = 0; i < look->rule_count; i++)
        any = any || (rule_is_meant(look, a, i) && look->rules[i].use_counts[k->id] > 0);
    for (size_t i = 0; i < look->rule_count && status == LMN_OK; i++) {
        rule *r = &look->rules[i];
        if (!rule_is_meant(look, a, i) || (any && r->use_counts[k->id] == 0) ||
            (a->index != ALL && a->index > (long long)r->use_counts[k->id]))
            continue;
        if (none)
            remove_uses(r, k, a->index);
        else
            status = put_use(r, k, a->index, t, error);
    }
    return status;
}

/* --- setting values ------------------------------------------------------------------------------------- */

typedef void (*use_visitor)(const kind *k, technique_use *use, void *user);

/* Calls `visit` with every use that an address means. */
static void visit_uses(lmn_look *look, const address *a, use_visitor visit, void *user)
{
    const kind *k = a->kind;
    if (k->look_wide && look->wide[k->id].technique)
        visit(k, &look->wide[k->id], user);
    for (size_t i = 0; i < look->rule_count && !k->look_wide; i++)
        for (size_t u = 0; rule_is_meant(look, a, i) && u < look->rules[i].use_counts[k->id]; u++)
            if (a->index == ALL || a->index == (long long)u)
                visit(k, &look->rules[i].uses[k->id][u], user);
}

/* Sets a value in each use that is met. */
typedef struct walk {
    const char      *key, *value;
    bool             trying;  /* on copies */
    const technique *without; /* a technique in use that has no such parameter */
    size_t           met;     /* uses that have it */
    lmn_status       status;
    lmn_error       *error;
} walk;

static void set_in_use(const kind *k, technique_use *use, void *user)
{
    walk        *w = user;
    const param *p = kind_find_param(k, use->technique, w->key);
    if (w->status != LMN_OK)
        return;
    if (!p) {
        w->without = use->technique;
        return;
    }
    w->met++;
    technique_use scratch = *use;
    if (w->trying && !use_create(&scratch, k, use->technique))
        w->status = error_memory(w->error);
    else
        w->status = value_set_text(p, scratch.values, w->value, w->error);
    if (w->trying)
        use_release(&scratch);
}

static lmn_status set_value(lmn_look *look, const address *a, const char *value, lmn_error *error)
{
    walk w = {.key = a->key, .value = value, .trying = true, .error = error};
    if (!a->kind->look_wide && a->index != ALL) {
        lmn_status status = check_index(look, a, false, error);
        if (status != LMN_OK)
            return status;
    }
    visit_uses(look, a, set_in_use, &w);
    if (w.status != LMN_OK)
        return error_name_kind(a->kind, w.status, error);
    if (w.met) {
        w.trying = false;
        visit_uses(look, a, set_in_use, &w);
        return w.status;
    }
    if (w.without)
        return kind_missing_param(a->kind, w.without, a->key, error);
    lmn_status status =
        error_set(error, LMN_USAGE, "'%.120s': look '%.60s' has no %s", a->whole, look->name, a->kind->name);
    error_hint(error, "set %s.%s first", a->kind->name, a->kind->selector_key);
    return status;
}

/* --- parameters by key ---------------------------------------------------------------------------------- */

typedef struct param_walk {
    const char   *key;
    param_visitor visit;
    void         *user;
} param_walk;

static void visit_param(const kind *k, technique_use *use, void *user)
{
    const param_walk *w = user;
    const param      *p = kind_find_param(k, use->technique, w->key);
    if (p)
        w->visit(p, use->values, w->user);
}

void look_visit_params(lmn_look *look, const char *key, param_visitor visit, void *user)
{
    address a;
    if (parse_address(&a, key, NULL) == LMN_OK)
        visit_uses(look, &a, visit_param, &(param_walk){a.key, visit, user});
}

static void keep_first(const kind *k, technique_use *use, void *user)
{
    param_walk   *w = user;
    const param **out = w->user;
    if (!*out)
        *out = kind_find_param(k, use->technique, w->key);
}

lmn_status look_param_of_key(const param **out, const lmn_look *look, const char *key, lmn_error *error)
{
    address    a;
    lmn_status status = parse_address(&a, key, error);
    *out = NULL;
    if (status != LMN_OK)
        return status;
    visit_uses((lmn_look *)look, &a, keep_first, &(param_walk){a.key, NULL, out}); /* changes nothing */
    for (size_t i = 0; i < a.kind->technique_count && !*out; i++)
        *out = kind_find_param(a.kind, a.kind->techniques[i], a.key);
    return *out ? LMN_OK : kind_missing_param(a.kind, a.kind->techniques[0], a.key, error);
}

/* --- from outside --------------------------------------------------------------------------------------- */

/* Keys without a kind are controls. */
static lmn_status set_control(lmn_look *look, const char *key, const char *value, lmn_error *error)
{
    size_t     index;
    double     number;
    lmn_status status = control_find(&index, key, error);
    if (status != LMN_OK)
        return status;
    if (!text_is_double(value, &number))
        return error_set(error, LMN_USAGE, "%s is '%.60s'; allowed is -1 to 1", key, value);
    return look_set_control(look, index, number, error);
}

static bool is_control(const char *key)
{
    size_t index;
    return control_find(&index, key, NULL) == LMN_OK;
}

static lmn_status set_anywhere(lmn_look *look, const char *key, const char *value, lmn_error *error)
{
    address a;
    if (is_control(key))
        return set_control(look, key, value, error);
    lmn_status status = parse_address(&a, key, error);
    if (status != LMN_OK)
        return status;
    if (a.kind->look_wide && (a.rule[0] || a.index != ALL)) {
        status =
            error_set(error, LMN_USAGE, "'%.120s': %s holds for the whole look, not for a rule", key, a.kind->name);
        error_hint(error, "write %s.%s", a.kind->name, a.key);
        return status;
    }
    if (!a.kind->look_wide)
        status = check_rule(look, &a, error);
    if (status != LMN_OK)
        return status;
    if (strcmp(a.key, "technique") == 0 || strcmp(a.key, a.kind->selector_key) == 0)
        return set_technique(look, &a, value, error);
    return set_value(look, &a, value, error);
}

lmn_status look_set(lmn_look *look, const char *key, const char *value, lmn_error *error)
{
    lmn_look  *before;
    lmn_status status = look_edit_begin(&before, look, error);
    if (status != LMN_OK)
        return status;
    return look_edit_end(look, &before, set_anywhere(look, key, value, error));
}
