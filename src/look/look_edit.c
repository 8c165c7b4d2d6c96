#include "look/look_edit.h"

#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "look/look_change.h"
#include "look/value.h"

/* --- finding -------------------------------------------------------------------------------------------- */

lmn_status look_check_rule(const lmn_look *look, size_t index, lmn_error *error)
{
    if (index < look->rule_count)
        return LMN_OK;
    if (index == LMN_WHOLE_LOOK)
        return error_set(error, LMN_USAGE, "the whole look is no rule; look '%.60s' has rules 0 to %zu", look->name,
                         look->rule_count - 1);
    return error_set(error, LMN_USAGE, "there is no rule %zu; look '%.60s' has rules 0 to %zu", index, look->name,
                     look->rule_count - 1);
}

lmn_status look_find_uses(use_list *out, const lmn_look *look, size_t rule_index, const char *kind_name,
                          lmn_error *error)
{
    const kind *k = kind_find(kind_name);
    *out = (use_list){.kind = k};
    if (!k)
        return kind_unknown(kind_name, NULL, error);
    if (k->look_wide && rule_index != LMN_WHOLE_LOOK) {
        lmn_status status = error_set(error, LMN_USAGE, "%s holds for the whole look, not for a rule", k->name);
        error_hint(error, "give LMN_WHOLE_LOOK as the rule");
        return status;
    }
    if (k->look_wide) {
        out->uses = (technique_use *)&look->wide[k->id];
        out->count = out->uses->technique != NULL;
        return LMN_OK;
    }
    lmn_status status = look_check_rule(look, rule_index, error);
    if (status != LMN_OK)
        return status;
    out->rule = &look->rules[rule_index];
    out->uses = out->rule->uses[k->id];
    out->count = out->rule->use_counts[k->id];
    return LMN_OK;
}

static lmn_status check_use(const use_list *uses, size_t index, lmn_error *error)
{
    if (index < uses->count)
        return LMN_OK;
    if (uses->count == 0)
        return error_set(error, LMN_USAGE, "there is no %s[%zu]: it has no technique of this kind", uses->kind->name,
                         index);
    return error_set(error, LMN_USAGE, "there is no %s[%zu]; allowed is 0 to %zu", uses->kind->name, index,
                     uses->count - 1);
}

lmn_status look_find_param(param_place *out, const lmn_look *look, size_t rule_index, const char *kind_name,
                           size_t index, const char *key, lmn_error *error)
{
    use_list   uses;
    lmn_status status = look_find_uses(&uses, look, rule_index, kind_name, error);
    if (status == LMN_OK)
        status = check_use(&uses, index, error);
    if (status != LMN_OK)
        return status;
    *out = (param_place){.kind = uses.kind, .use = &uses.uses[index]};
    out->param = key ? kind_find_param(uses.kind, out->use->technique, key) : NULL;
    return !key || out->param ? LMN_OK : kind_missing_param(uses.kind, out->use->technique, key, error);
}

/* --- parameters ----------------------------------------------------------------------------------------- */

lmn_status error_name_kind(const kind *k, lmn_status status, lmn_error *error)
{
    if (status != LMN_USAGE || !error)
        return status;
    char hint[sizeof error->hint], message[sizeof error->message];
    memcpy(hint, error->hint, sizeof hint);
    memcpy(message, error->message, sizeof message);
    error_set(error, LMN_USAGE, "%s.%.400s", k->name, message);
    if (hint[0])
        error_hint(error, "%s", hint);
    return status;
}

static void set_defaults(const param_place *place)
{
    const technique *t = place->use->technique;
    for (size_t i = 0; i < kind_param_count(place->kind, t); i++)
        if (!place->param || place->param == kind_param_at(place->kind, t, i))
            params_set_defaults(kind_param_at(place->kind, t, i), 1, place->use->values);
}

lmn_status look_change_param(lmn_look *look, const param_place *place, const char *value, lmn_error *error)
{
    technique_use before;
    lmn_status    status = LMN_OK;
    if (!use_copy(&before, place->kind, place->use))
        return error_memory(error);
    if (value)
        status = value_set_text(place->param, place->use->values, value, error);
    else
        set_defaults(place);
    if (status == LMN_OK)
        look_mark_changed(look, use_changes(place->kind, &before, place->use));
    use_release(&before);
    return error_name_kind(place->kind, status, error);
}

/* --- rules ---------------------------------------------------------------------------------------------- */

static bool copy_text(char **out, const char *from)
{
    *out = mem_copy_text(from);
    return *out || !from;
}

lmn_status look_set_words(lmn_look *look, char **words, const char *value, lmn_error *error)
{
    char *fresh;
    if ((*words && value && strcmp(*words, value) == 0) || *words == value)
        return LMN_OK;
    if (!copy_text(&fresh, value))
        return error_memory(error);
    mem_free(*words);
    *words = fresh;
    look_mark_changed(look, LMN_CHANGE_VALUES);
    return LMN_OK;
}

static lmn_status rule_create(rule *out, const char *select, lmn_error *error)
{
    *out = (rule){0};
    lmn_status status = selector_parse(&out->selector, select, error);
    if (status == LMN_OK && !copy_text(&out->select, select))
        status = error_memory(error);
    if (status == LMN_OK)
        status = rule_add_standards(out, error);
    if (status != LMN_OK)
        rule_release(out);
    return status;
}

/* Moves element `from` to `to`; those between make room. */
static void move_element(void *array, size_t size, size_t from, size_t to, void *spare)
{
    char *at = array;
    memcpy(spare, at + from * size, size);
    if (from < to)
        memmove(at + from * size, at + (from + 1) * size, (to - from) * size);
    else
        memmove(at + (to + 1) * size, at + to * size, (from - to) * size);
    memcpy(at + to * size, spare, size);
}

static void move_rule(lmn_look *look, size_t from, size_t to)
{
    rule spare;
    move_element(look->rules, sizeof spare, from, to, &spare);
}

lmn_status look_add_rule(lmn_look *look, const char *selector, size_t before, size_t *index, lmn_error *error)
{
    rule   fresh;
    size_t at = before == LMN_AT_END ? look->rule_count : before;
    if (at > look->rule_count)
        return error_set(error, LMN_USAGE, "a rule cannot come before rule %zu; look '%.60s' has rules 0 to %zu", at,
                         look->name, look->rule_count - 1);
    if (look->rule_count >= LIMIT_LOOK_RULES)
        return error_set(error, LMN_LIMIT, "look '%.60s' has %zu rules; the limit is %d", look->name, look->rule_count,
                         LIMIT_LOOK_RULES);
    lmn_status status = rule_create(&fresh, selector, error);
    if (status != LMN_OK)
        return status;
    rule *grown = mem_realloc(look->rules, (look->rule_count + 1) * sizeof *grown);
    if (!grown) {
        rule_release(&fresh);
        return error_memory(error);
    }
    grown[look->rule_count] = fresh;
    look->rules = grown;
    move_rule(look, look->rule_count++, at);
    look_mark_changed(look, LOOK_CHANGE_ALL);
    if (index)
        *index = at;
    return LMN_OK;
}

lmn_status look_remove_rule(lmn_look *look, size_t index, lmn_error *error)
{
    lmn_status status = look_check_rule(look, index, error);
    if (status != LMN_OK)
        return status;
    if (look->rule_count == 1) {
        status = error_set(error, LMN_USAGE, "look '%.60s' has no other rule: nothing would be drawn", look->name);
        error_hint(error, "add another one first, or change this one's selector");
        return status;
    }
    move_rule(look, index, look->rule_count - 1);
    rule_release(&look->rules[--look->rule_count]);
    look_mark_changed(look, LOOK_CHANGE_ALL);
    return LMN_OK;
}

lmn_status look_move_rule(lmn_look *look, size_t index, size_t to, lmn_error *error)
{
    lmn_status status = look_check_rule(look, index, error);
    if (status == LMN_OK)
        status = look_check_rule(look, to, error);
    if (status != LMN_OK || index == to)
        return status;
    move_rule(look, index, to);
    look_mark_changed(look, LOOK_CHANGE_ALL);
    return LMN_OK;
}

lmn_status look_select(lmn_look *look, size_t index, const char *select, lmn_error *error)
{
    selector  *parsed;
    char      *copy;
    lmn_status status = look_check_rule(look, index, error);
    if (status != LMN_OK)
        return status;
    rule *r = &look->rules[index];
    if (strcmp(r->select, select) == 0)
        return LMN_OK;
    status = selector_parse(&parsed, select, error);
    if (status != LMN_OK)
        return status;
    if (!copy_text(&copy, select)) {
        selector_destroy(&parsed);
        return error_memory(error);
    }
    selector_destroy(&r->selector);
    mem_free(r->select);
    r->selector = parsed;
    r->select = copy;
    look_mark_changed(look, LOOK_CHANGE_ALL);
    return LMN_OK;
}

/* --- techniques ----------------------------------------------------------------------------------------- */

lmn_status look_set_technique(lmn_look *look, const use_list *uses, size_t index, const char *name, lmn_error *error)
{
    const technique *t = techniques_find(look->techniques, uses->kind, name);
    lmn_status       status = check_use(uses, index, error);
    if (status != LMN_OK)
        return status;
    if (!t)
        return kind_unknown_technique(uses->kind, look->techniques, name, error);
    if (uses->uses[index].technique == t)
        return LMN_OK;
    if (!use_exchange(&uses->uses[index], uses->kind, t))
        return error_memory(error);
    look_mark_changed(look, LOOK_CHANGE_ALL);
    return LMN_OK;
}

static lmn_status check_room(const use_list *uses, size_t at, lmn_error *error)
{
    const kind *k = uses->kind;
    lmn_status  status;
    if (!uses->rule)
        return error_set(error, LMN_USAGE, "%s holds for the whole look, which has one: exchange it", k->name);
    if (!k->array && uses->count) {
        status = error_set(error, LMN_USAGE, "%s holds one technique, and it has '%s'", k->name,
                           uses->uses[0].technique->name);
        error_hint(error, "exchange it instead");
        return status;
    }
    if (at > uses->count)
        return error_set(error, LMN_USAGE, "%s cannot come before %s[%zu]: it has %zu", k->name, k->name, at,
                         uses->count);
    if (uses->count >= LIMIT_LOOK_TECHNIQUES)
        return error_set(error, LMN_LIMIT, "%s has %zu techniques; the limit is %d", k->name, uses->count,
                         LIMIT_LOOK_TECHNIQUES);
    return LMN_OK;
}

lmn_status look_add_technique(lmn_look *look, const use_list *uses, const char *name, size_t before, lmn_error *error)
{
    const kind      *k = uses->kind;
    const technique *t = techniques_find(look->techniques, k, name);
    size_t           count = uses->count, at = before == LMN_AT_END ? count : before;
    technique_use    fresh, spare;
    if (!t)
        return kind_unknown_technique(k, look->techniques, name, error);
    lmn_status status = check_room(uses, at, error);
    if (status != LMN_OK)
        return status;
    if (!use_create(&fresh, k, t))
        return error_memory(error);
    technique_use *grown = mem_realloc(uses->uses, (count + 1) * sizeof *grown);
    if (!grown) {
        use_release(&fresh);
        return error_memory(error);
    }
    grown[count] = fresh;
    move_element(grown, sizeof *grown, count, at, &spare);
    uses->rule->uses[k->id] = grown;
    uses->rule->use_counts[k->id]++;
    look_mark_changed(look, LOOK_CHANGE_ALL);
    return LMN_OK;
}

lmn_status look_remove_technique(lmn_look *look, const use_list *uses, size_t index, lmn_error *error)
{
    const kind   *k = uses->kind;
    technique_use spare;
    lmn_status    status = check_use(uses, index, error);
    if (status != LMN_OK)
        return status;
    if (uses->count == 1 && !kind_may_be_none(k)) {
        status = error_set(error, LMN_USAGE, "%s cannot be none", k->name);
        kind_hint_techniques(k, look->techniques, error);
        return status;
    }
    move_element(uses->uses, sizeof spare, index, uses->count - 1, &spare);
    use_release(&uses->uses[uses->count - 1]);
    uses->rule->use_counts[k->id]--;
    look_mark_changed(look, LOOK_CHANGE_ALL);
    return LMN_OK;
}

lmn_status look_move_technique(lmn_look *look, const use_list *uses, size_t index, size_t to, lmn_error *error)
{
    technique_use spare;
    lmn_status    status = check_use(uses, index, error);
    if (status == LMN_OK)
        status = check_use(uses, to, error);
    if (status != LMN_OK || index == to)
        return status;
    move_element(uses->uses, sizeof spare, index, to, &spare);
    look_mark_changed(look, LOOK_CHANGE_ALL);
    return LMN_OK;
}
