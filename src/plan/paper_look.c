#include "plan/paper_look.h"

#include <string.h>

#include "base/memory.h"

static bool copy_use(technique_use *out, const technique_use *from)
{
    const technique *t = from->technique;
    *out = (technique_use){t, t ? mem_copy(from->values, t->params_size) : NULL};
    if (!t)
        return true;
    return out->values;
}

bool paper_rule_create(rule *out, const rule *from)
{
    *out = *from;
    memset(out->uses, 0, sizeof out->uses);
    for (int k = 0; k < KIND_COUNT; k++) {
        size_t count = from->use_counts[k];
        out->uses[k] = mem_calloc(count, sizeof(technique_use));
        if (!out->uses[k])
            return false;
        for (size_t i = 0; i < count; i++)
            if (!copy_use(&out->uses[k][i], &from->uses[k][i]))
                return false;
    }
    return true;
}

void paper_rule_release(rule *r)
{
    for (int k = 0; k < KIND_COUNT; k++) {
        for (size_t i = 0; r->uses[k] && i < r->use_counts[k]; i++)
            mem_free(r->uses[k][i].values);
        mem_free(r->uses[k]);
    }
}

static void scale_use(const technique_use *use, const kind *k, double factor)
{
    const technique *t = use->technique;
    if (!t)
        return;
    params_scale_lengths(t->params, t->param_count, use->values, factor);
    params_scale_lengths(k->common, k->common_count, use->values, factor);
}

static void scale_look(const lmn_look *look, double factor)
{
    for (int k = 0; k < KIND_COUNT; k++) {
        scale_use(&look->wide[k], kinds[k], factor);
        for (size_t i = 0; i < look->rule_count; i++)
            for (size_t u = 0; u < look->rules[i].use_counts[k]; u++)
                scale_use(&look->rules[i].uses[k][u], kinds[k], factor);
    }
}

lmn_look *paper_look_create(const lmn_look *look, double pixels_per_point)
{
    lmn_look *out = mem_copy(look, sizeof *look);
    if (!out)
        return NULL;
    memset(out->wide, 0, sizeof out->wide);
    out->rule_count = 0;
    out->rules = mem_calloc(look->rule_count, sizeof *out->rules);
    bool whole = out->rules;
    for (int k = 0; k < KIND_COUNT && whole; k++)
        whole = copy_use(&out->wide[k], &look->wide[k]);
    while (whole && out->rule_count < look->rule_count) {
        whole = paper_rule_create(&out->rules[out->rule_count], &look->rules[out->rule_count]);
        out->rule_count++;
    }
    if (!whole) {
        paper_look_destroy(&out);
        return NULL;
    }
    look_apply_controls(out);
    scale_look(out, pixels_per_point);
    return out;
}

void paper_look_destroy(lmn_look **look)
{
    lmn_look *l = *look;
    *look = NULL;
    if (!l)
        return;
    for (size_t i = 0; i < l->rule_count; i++)
        paper_rule_release(&l->rules[i]);
    for (int k = 0; k < KIND_COUNT; k++)
        mem_free(l->wide[k].values);
    mem_free(l->rules);
    mem_free(l);
}
