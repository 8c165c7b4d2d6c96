/* A look's memory: techniques with their values, and the end of it all. */
#include "look/look.h"

#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "look/look_change.h"

/* The rows decide too, so that a technique whose struct was declared too small cannot write behind it. */
static size_t values_size(const kind *k, const technique *t)
{
    size_t size = t->params_size;
    for (size_t i = 0; i < kind_param_count(k, t); i++) {
        const param *p = kind_param_at(k, t, i);
        if (p->offset + param_size(p->type) > size)
            size = p->offset + param_size(p->type);
    }
    return size;
}

bool use_create(technique_use *out, const kind *k, const technique *t)
{
    *out = (technique_use){t, mem_calloc(1, values_size(k, t))};
    if (!out->values)
        return false;
    params_set_defaults(k->common, k->common_count, out->values);
    params_set_defaults(t->params, t->param_count, out->values);
    return true;
}

void use_release(technique_use *use)
{
    mem_free(use->values);
    *use = (technique_use){0};
}

bool use_copy(technique_use *out, const kind *k, const technique_use *from)
{
    *out = (technique_use){0};
    if (!from->technique)
        return true;
    *out = (technique_use){from->technique, mem_copy(from->values, values_size(k, from->technique))};
    return out->values;
}

bool use_exchange(technique_use *use, const kind *k, const technique *t)
{
    technique_use fresh;
    if (!use_create(&fresh, k, t))
        return false;
    for (size_t i = 0; use->technique && i < kind_param_count(k, t); i++) {
        const param *to = kind_param_at(k, t, i), *from = kind_find_param(k, use->technique, to->key);
        char         printed[PARAM_TEXT_MAX];
        if (!from || from->type != to->type || param_is_default(from, use->values))
            continue;
        param_print(from, use->values, printed, sizeof printed);
        param_set_text(to, fresh.values, printed, NULL); /* refused: outside the new range, so the default stays */
    }
    use_release(use);
    *use = fresh;
    return true;
}

lmn_status rule_add_standards(rule *r, lmn_error *error)
{
    for (size_t i = 0; i < KIND_COUNT; i++) {
        const kind *k = kinds[i];
        if (k->look_wide || r->uses[i] || !k->standard)
            continue;
        r->uses[i] = mem_calloc(1, sizeof *r->uses[i]);
        if (!r->uses[i] || !use_create(r->uses[i], k, k->standard))
            return error_memory(error);
        r->use_counts[i] = 1;
    }
    return LMN_OK;
}

void rule_release(rule *r)
{
    for (size_t k = 0; k < KIND_COUNT; k++) {
        for (size_t i = 0; i < r->use_counts[k]; i++)
            use_release(&r->uses[k][i]);
        mem_free(r->uses[k]);
    }
    selector_destroy(&r->selector);
    mem_free(r->select);
    mem_free(r->name);
}

static lmn_status copy_uses(rule *out, const rule *from, const kind *k, lmn_error *error)
{
    size_t count = from->use_counts[k->id];
    if (!from->uses[k->id])
        return LMN_OK;
    out->uses[k->id] = mem_calloc(count, sizeof(technique_use));
    if (!out->uses[k->id])
        return error_memory(error);
    for (size_t i = 0; i < count; i++) {
        if (!use_copy(&out->uses[k->id][i], k, &from->uses[k->id][i]))
            return error_memory(error);
        out->use_counts[k->id]++;
    }
    return LMN_OK;
}

static lmn_status copy_rule(rule *out, const rule *from, lmn_error *error)
{
    out->name = mem_copy_text(from->name);
    out->select = mem_copy_text(from->select);
    if ((from->name && !out->name) || !out->select)
        return error_memory(error);
    lmn_status status = selector_parse(&out->selector, out->select, error);
    for (size_t k = 0; k < KIND_COUNT && status == LMN_OK; k++)
        status = copy_uses(out, from, kinds[k], error);
    return status;
}

static lmn_status copy_content(lmn_look *out, const lmn_look *from, lmn_error *error)
{
    out->techniques = techniques_hold(from->techniques);
    out->name = mem_copy_text(from->name);
    out->doc = mem_copy_text(from->doc);
    out->rules = mem_calloc(from->rule_count, sizeof *out->rules);
    if (!out->name || (from->doc && !out->doc) || !out->rules)
        return error_memory(error);
    out->rule_count = from->rule_count;
    if (!controls_copy(out->controls, from->controls))
        return error_memory(error);
    for (size_t k = 0; k < KIND_COUNT; k++)
        if (!use_copy(&out->wide[k], kinds[k], &from->wide[k]))
            return error_memory(error);
    for (size_t i = 0; i < from->rule_count; i++) {
        lmn_status status = copy_rule(&out->rules[i], &from->rules[i], error);
        if (status != LMN_OK)
            return status;
    }
    return LMN_OK;
}

lmn_status look_copy(lmn_look **out, const lmn_look *look, lmn_error *error)
{
    lmn_look *copy = *out = mem_calloc(1, sizeof *copy);
    if (!copy)
        return error_memory(error);
    lmn_status status = copy_content(copy, look, error);
    if (status == LMN_OK)
        look_mark_changed(copy, LOOK_CHANGE_ALL);
    else
        look_destroy(out);
    return status;
}

void look_destroy(lmn_look **look)
{
    if (!look || !*look)
        return;
    for (size_t i = 0; i < (*look)->rule_count; i++)
        rule_release(&(*look)->rules[i]);
    for (size_t k = 0; k < KIND_COUNT; k++)
        use_release(&(*look)->wide[k]);
    controls_release((*look)->controls);
    mem_free((*look)->rules);
    mem_free((*look)->name);
    mem_free((*look)->doc);
    techniques_release((*look)->techniques); /* behind all that uses one */
    mem_free(*look);
    *look = NULL;
}
