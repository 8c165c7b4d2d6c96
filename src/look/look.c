/* A look's parts: kinds, techniques and their values; making, loading by name or path, ending. */
#include "look/look.h"

#include <string.h>

#include "base/embedded.h"
#include "base/file.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"

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

bool kind_may_be_none(const kind *k)
{
    return !k->look_wide && (!k->standard || k->array);
}

/* "a, b, c" of the techniques for which `has` (NULL: any) is a parameter; false when there is none. */
static bool list_techniques(text *list, const kind *k, const char *has)
{
    bool any = false;
    for (size_t i = 0; i < k->technique_count; i++) {
        if (has && !kind_find_param(k, k->techniques[i], has))
            continue;
        text_append(list, "%s%s", any ? ", " : "", k->techniques[i]->name);
        any = true;
    }
    return any;
}

void kind_hint_techniques(const kind *k, lmn_error *error)
{
    text list = {0};
    list_techniques(&list, k, NULL);
    error_hint(error, "%s has: %s%s", k->name, list.data ? list.data : "?", kind_may_be_none(k) ? ", none" : "");
    text_release(&list);
}

lmn_status kind_unknown_technique(const kind *k, const char *name, lmn_error *error)
{
    const char *names[64];
    size_t count = 0;
    for (; count < k->technique_count && count < PARAM_COUNT(names); count++)
        names[count] = k->techniques[count]->name;
    const char *near = text_nearest(name, names, count);
    lmn_status status = error_set(error, LMN_USAGE, "there is no %s technique '%.60s'", k->name, name);
    if (near)
        error_hint(error, "did you mean '%s'?", near);
    else
        kind_hint_techniques(k, error);
    return status;
}

lmn_status kind_missing_param(const kind *k, const technique *t, const char *key, lmn_error *error)
{
    text having = {0};
    lmn_status status;
    if (list_techniques(&having, k, key)) {
        status = error_set(error, LMN_USAGE, "%s technique '%s' has no parameter '%.60s'; these have it: %.200s", k->name,
                           t->name, key, having.data ? having.data : "others");
        error_hint(error, "set %s.%s first, or see `limner looks` for what '%s' has", k->name, k->selector_key, t->name);
        text_release(&having);
        return status;
    }
    text_release(&having);
    const char *names[256];
    size_t count = 0;
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

/* Embedded looks lie in the order of their file names, where "sketch-blueprint.json" comes before "sketch.json". */
const char *look_name_at(size_t index)
{
    for (size_t i = 0; i < embedded_looks_count; i++) {
        size_t before = 0;
        for (size_t k = 0; k < embedded_looks_count; k++)
            before += strcmp(embedded_looks[k].path, embedded_looks[i].path) < 0;
        if (before == index)
            return embedded_looks[i].path;
    }
    return NULL;
}

static lmn_status unknown_name(const char *name, lmn_error *error)
{
    const char **names = mem_calloc(embedded_looks_count + 1, sizeof *names);
    if (!names)
        return error_memory(error);
    for (size_t i = 0; i < embedded_looks_count; i++)
        names[i] = embedded_looks[i].path;
    lmn_status status = error_set(error, LMN_USAGE, "there is no look '%.80s'", name);
    const char *near = text_nearest(name, names, embedded_looks_count);
    if (near)
        error_hint(error, "did you mean '%s'? `limner looks` lists all; a file's path contains '/' or ends in .json", near);
    else
        error_hint(error, "`limner looks` lists all; a file's path contains '/' or ends in .json");
    mem_free(names);
    return status;
}

static lmn_status load_file(lmn_look **out, const char *path, lmn_error *error)
{
    file_data data;
    lmn_status status = file_load(&data, path, error);
    if (status != LMN_OK)
        return status;
    status = look_parse(out, (const char *)data.data, data.size, path, error);
    file_data_release(&data);
    return status;
}

lmn_status look_load(lmn_look **out, const char *name_or_path, lmn_error *error)
{
    *out = NULL;
    char ending[8];
    file_ending(name_or_path, ending, sizeof ending);
    if (strchr(name_or_path, '/') || strcmp(ending, ".json") == 0)
        return load_file(out, name_or_path, error);
    for (size_t i = 0; i < embedded_looks_count; i++)
        if (strcmp(embedded_looks[i].path, name_or_path) == 0)
            return look_parse(out, embedded_looks[i].data, embedded_looks[i].size, name_or_path, error);
    return unknown_name(name_or_path, error);
}
