/* Setting one parameter of a look from text: "KIND.PARAM", "KIND[i].PARAM" or "RULE:KIND.PARAM". */
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
    error_hint(error, "the form is KIND.PARAM, KIND[i].PARAM or RULE:KIND.PARAM, for example lines.width");
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

/* What a walk over the uses that an address means has met. */
typedef struct walk {
    const technique *without; /* a technique in use that has no such parameter */
    size_t           met;     /* uses that have it */
} walk;

/* Sets the value in one use, on a copy when only trying. */
static lmn_status set_in_use(const address *a, technique_use *use, const char *value, bool trying, walk *w,
                             lmn_error *error)
{
    const param *p = kind_find_param(a->kind, use->technique, a->key);
    if (!p) {
        w->without = use->technique;
        return LMN_OK;
    }
    w->met++;
    if (!trying)
        return value_set_text(p, use->values, value, error);
    technique_use scratch;
    if (!use_create(&scratch, a->kind, use->technique))
        return error_memory(error);
    lmn_status status = value_set_text(p, scratch.values, value, error);
    use_release(&scratch);
    return status;
}

static lmn_status set_in_all(lmn_look *look, const address *a, const char *value, bool trying, walk *w,
                             lmn_error *error)
{
    const kind *k = a->kind;
    lmn_status  status = LMN_OK;
    if (k->look_wide)
        return set_in_use(a, &look->wide[k->id], value, trying, w, error);
    for (size_t i = 0; i < look->rule_count; i++)
        for (size_t u = 0; rule_is_meant(look, a, i) && u < look->rules[i].use_counts[k->id] && status == LMN_OK; u++)
            if (a->index == ALL || a->index == (long long)u)
                status = set_in_use(a, &look->rules[i].uses[k->id][u], value, trying, w, error);
    return status;
}

static lmn_status set_value(lmn_look *look, const address *a, const char *value, lmn_error *error)
{
    walk w = {0};
    if (!a->kind->look_wide && a->index != ALL) {
        lmn_status status = check_index(look, a, false, error);
        if (status != LMN_OK)
            return status;
    }
    lmn_status status = set_in_all(look, a, value, true, &w, error);
    error_name_kind(a->kind, status, error);
    if (status != LMN_OK)
        return status;
    if (w.met)
        return set_in_all(look, a, value, false, &w, error);
    if (w.without)
        return kind_missing_param(a->kind, w.without, a->key, error);
    status = error_set(error, LMN_USAGE, "'%.120s': look '%.60s' has no %s", a->whole, look->name, a->kind->name);
    error_hint(error, "set %s.%s first", a->kind->name, a->kind->selector_key);
    return status;
}

static lmn_status set_anywhere(lmn_look *look, const char *key, const char *value, lmn_error *error)
{
    address    a;
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
