/* A look's parts: kinds, techniques and their values; making, loading by name or path, ending. */
#include "look/look.h"

#include <string.h>

#include "base/embedded.h"
#include "base/file.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"

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
