/* A look's memory: techniques with their values, and the end of it all. */
#include "look/look.h"

#include <string.h>

#include "base/memory.h"

bool use_create(technique_use *out, const kind *k, const technique *t)
{
    /* The rows decide too, so that a technique whose struct was declared too small cannot write behind it. */
    size_t size = t->params_size;
    for (size_t i = 0; i < kind_param_count(k, t); i++) {
        const param *p = kind_param_at(k, t, i);
        if (p->offset + param_size(p->type) > size)
            size = p->offset + param_size(p->type);
    }
    *out = (technique_use){t, mem_calloc(1, size)};
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

static void rule_release(rule *r)
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

void look_destroy(lmn_look **look)
{
    if (!look || !*look)
        return;
    for (size_t i = 0; i < (*look)->rule_count; i++)
        rule_release(&(*look)->rules[i]);
    for (size_t k = 0; k < KIND_COUNT; k++)
        use_release(&(*look)->wide[k]);
    mem_free((*look)->rules);
    mem_free((*look)->name);
    mem_free((*look)->doc);
    mem_free(*look);
    *look = NULL;
}
