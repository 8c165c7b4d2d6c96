/* Looks by name, from those that travel inside the library, or by path. */
#include <string.h>

#include "base/embedded.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "look/look.h"

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

/* The first kind that has a technique of this name; NULL: none. */
static const kind *kind_with(const char *technique_name)
{
    for (size_t k = 0; k < KIND_COUNT; k++)
        for (size_t i = 0; kinds[k]->selector_key && i < kinds[k]->technique_count; i++)
            if (strcmp(kinds[k]->techniques[i]->name, technique_name) == 0)
                return kinds[k];
    return NULL;
}

static lmn_status unknown_name(const char *name, lmn_error *error)
{
    const char **names = mem_calloc(embedded_looks_count + 1, sizeof *names);
    if (!names)
        return error_memory(error);
    for (size_t i = 0; i < embedded_looks_count; i++)
        names[i] = embedded_looks[i].path;
    lmn_status  status = error_set(error, LMN_USAGE, "there is no look '%.80s'", name);
    const char *near = text_nearest(name, names, embedded_looks_count);
    const kind *known = kind_with(name);
    if (known)
        error_hint(error,
                   "it is a technique, not a look: --set %s.%s=%s; its parameters are in `limner looks --markdown`",
                   known->name, known->selector_key, name);
    else if (near)
        error_hint(error, "did you mean '%s'? `limner looks` lists all; a file's path contains '/' or ends in .json",
                   near);
    else
        error_hint(error, "`limner looks` lists all; a file's path contains '/' or ends in .json");
    mem_free(names);
    return status;
}

static lmn_status load_file(lmn_look **out, const char *path, lmn_techniques *set, lmn_error *error)
{
    file_data  data;
    lmn_status status = file_load(&data, path, error);
    if (status != LMN_OK)
        return status;
    status = look_parse(out, (const char *)data.data, data.size, path, set, error);
    file_data_release(&data);
    return status;
}

lmn_status look_load(lmn_look **out, const char *name_or_path, lmn_techniques *set, lmn_error *error)
{
    *out = NULL;
    char ending[8];
    file_ending(name_or_path, ending, sizeof ending);
    if (strchr(name_or_path, '/') || strcmp(ending, ".json") == 0)
        return load_file(out, name_or_path, set, error);
    for (size_t i = 0; i < embedded_looks_count; i++)
        if (strcmp(embedded_looks[i].path, name_or_path) == 0)
            return look_parse(out, embedded_looks[i].data, embedded_looks[i].size, name_or_path, set, error);
    return unknown_name(name_or_path, error);
}
