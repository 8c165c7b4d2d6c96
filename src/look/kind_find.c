/* Finding techniques and parameters in the tables, and what to say when there is none. */
#include <string.h>

#include "base/error.h"
#include "base/text.h"
#include "look/look.h"

size_t kind_param_count(const kind *k, const technique *t)
{
    return k->common_count + t->param_count;
}

const param *kind_param_at(const kind *k, const technique *t, size_t index)
{
    return index < k->common_count ? &k->common[index] : &t->params[index - k->common_count];
}

const param *kind_find_param(const kind *k, const technique *t, const char *key)
{
    for (size_t i = 0; i < kind_param_count(k, t); i++) {
        const param *p = kind_param_at(k, t, i);
        if (strcmp(p->key, key) == 0 || (p->was && strcmp(p->was, key) == 0))
            return p;
    }
    return NULL;
}

const technique *kind_find_technique(const kind *k, const char *name)
{
    for (size_t i = 0; i < k->technique_count; i++)
        if (strcmp(k->techniques[i]->name, name) == 0)
            return k->techniques[i];
    return NULL;
}

const kind *kind_find(const char *name)
{
    for (size_t i = 0; i < KIND_COUNT; i++)
        if (strcmp(kinds[i]->name, name) == 0)
            return kinds[i];
    return NULL;
}

lmn_status kind_unknown(const char *name, const char *key, lmn_error *error)
{
    const char *names[KIND_COUNT];
    for (size_t i = 0; i < KIND_COUNT; i++)
        names[i] = kinds[i]->name;
    lmn_status  status = error_set(error, LMN_USAGE, "there is no kind '%.60s'", name);
    const char *near = text_nearest(name, names, KIND_COUNT);
    text        list = {0};
    for (size_t i = 0; i < KIND_COUNT; i++)
        text_append(&list, "%s%s", i == 0 ? "" : i + 1 < KIND_COUNT ? ", " : " and ", names[i]);
    if (near)
        error_hint(error, "did you mean '%s%s%s'?", near, key ? "." : "", key ? key : "");
    else
        error_hint(error, "the kinds are %s", list.data ? list.data : "few");
    text_release(&list);
    return status;
}

bool kind_may_be_none(const kind *k)
{
    return !k->look_wide && (!k->standard || k->array);
}

/* "a, b, c" of the techniques for which `has` (NULL: any) is a parameter; false when there is none. */
static bool list_techniques(text *list, const kind *k, const lmn_techniques *set, const char *has)
{
    bool any = false;
    for (size_t i = 0; i < k->technique_count + techniques_count(set, k); i++) {
        const technique *t = i < k->technique_count ? k->techniques[i] : techniques_at(set, k, i - k->technique_count);
        if (has && !kind_find_param(k, t, has))
            continue;
        text_append(list, "%s%s", any ? ", " : "", t->name);
        any = true;
    }
    return any;
}

void kind_hint_techniques(const kind *k, const lmn_techniques *set, lmn_error *error)
{
    text list = {0};
    list_techniques(&list, k, set, NULL);
    error_hint(error, "%s has: %s%s", k->name, list.data ? list.data : "?", kind_may_be_none(k) ? ", none" : "");
    text_release(&list);
}

lmn_status kind_unknown_technique(const kind *k, const lmn_techniques *set, const char *name, lmn_error *error)
{
    const char *names[64];
    size_t      count = 0;
    for (size_t i = 0; i < techniques_count(set, k) && count < PARAM_COUNT(names); i++)
        names[count++] = techniques_at(set, k, i)->name;
    for (size_t i = 0; i < k->technique_count && count < PARAM_COUNT(names); i++)
        names[count++] = k->techniques[i]->name;
    const char *near = text_nearest(name, names, count);
    lmn_status  status = error_set(error, LMN_USAGE, "there is no %s technique '%.60s'", k->name, name);
    if (near)
        error_hint(error, "did you mean '%s'?", near);
    else
        kind_hint_techniques(k, set, error);
    return status;
}

lmn_status kind_missing_param(const kind *k, const technique *t, const char *key, lmn_error *error)
{
    text       having = {0};
    lmn_status status;
    if (list_techniques(&having, k, NULL, key)) {
        status = error_set(error, LMN_USAGE, "%s technique '%s' has no parameter '%.60s'; these have it: %.200s",
                           k->name, t->name, key, having.data ? having.data : "others");
        error_hint(error, "set %s.%s first, or see `limner looks` for what '%s' has", k->name, k->selector_key,
                   t->name);
        text_release(&having);
        return status;
    }
    text_release(&having);
    const char *names[256];
    size_t      count = 0;
    for (size_t i = 0; i < kind_param_count(k, t) && count < PARAM_COUNT(names); i++)
        names[count++] = kind_param_at(k, t, i)->key;
    if (count < PARAM_COUNT(names))
        names[count++] = k->selector_key;
    for (size_t i = 0; i < k->technique_count; i++)
        for (size_t m = 0; m < k->techniques[i]->param_count && count < PARAM_COUNT(names); m++)
            names[count++] = k->techniques[i]->params[m].key;
    const char *near = text_nearest(key, names, count);
    status = error_set(error, LMN_USAGE, "%s has no parameter '%.60s'", k->name, key);
    if (near)
        error_hint(error, "did you mean '%s'?", near);
    else
        error_hint(error, "`limner looks` lists the parameters");
    return status;
}
