/* include/limner/techniques.h: checks arguments and forwards. */
#include "limner/techniques.h"

#include <string.h>

#include "api/complete.h"
#include "base/error.h"
#include "base/memory.h"
#include "look/look.h"
#include "look/technique_set.h"
#include "look/typed.h"

static lmn_status missing(const char *caller, const char *what, lmn_error *error)
{
    return error_set(error, LMN_USAGE, "%s: `%s` is NULL", caller, what);
}

lmn_status lmn_techniques_create(lmn_techniques **out, lmn_error *error)
{
    return out ? techniques_create(out, error) : missing("lmn_techniques_create", "out", error);
}

void lmn_techniques_destroy(lmn_techniques **set)
{
    if (!set)
        return;
    techniques_release(*set);
    *set = NULL;
}

/* Rows as the caller's header has them: shorter ones lack what they do not know. */
static lmn_status complete_rows(lmn_param_desc **out, const lmn_technique_desc *desc, lmn_error *error)
{
    size_t size = desc->param_size;
    *out = NULL;
    if (!desc->params || !desc->param_count)
        return LMN_OK;
    if (size < sizeof(const char *) || size > sizeof **out)
        return error_set(error, LMN_USAGE, "param_size is %zu, of a row of LMN_TECHNIQUE_DESC_INIT it is %zu", size,
                         sizeof **out);
    lmn_param_desc *rows = *out = mem_calloc(desc->param_count, sizeof *rows);
    if (!rows)
        return error_memory(error);
    for (size_t i = 0; i < desc->param_count; i++)
        memcpy(&rows[i], (const char *)desc->params + i * size, size);
    return LMN_OK;
}

lmn_status lmn_techniques_add(lmn_techniques *set, const lmn_technique_desc *desc, lmn_error *error)
{
    lmn_technique_desc full = LMN_TECHNIQUE_DESC_INIT;
    lmn_param_desc    *rows;
    if (!set)
        return missing("lmn_techniques_add", "techniques", error);
    lmn_status status = desc_complete(&full, sizeof full, desc, "LMN_TECHNIQUE_DESC_INIT", error);
    if (status == LMN_OK)
        status = complete_rows(&rows, &full, error);
    if (status != LMN_OK)
        return status;
    status = techniques_add(set, &full, rows, error);
    mem_free(rows);
    return status;
}

bool lmn_techniques_at(const lmn_techniques *set, size_t index, lmn_technique_info *out)
{
    const kind      *k = kinds[KIND_SURFACE];
    const technique *t = techniques_at(set, k, index);
    if (!t || !out)
        return false;
    *out = (lmn_technique_info){t->name, t->doc, kind_param_count(k, t), k->common_count};
    return true;
}

bool lmn_techniques_param_at(const lmn_techniques *set, const char *name, size_t index, lmn_param_info *out)
{
    const kind *k = kinds[KIND_SURFACE];
    for (size_t i = 0; name && out && i < techniques_count(set, k); i++) {
        const technique *t = techniques_at(set, k, i);
        if (strcmp(t->name, name) != 0 || index >= kind_param_count(k, t))
            continue;
        typed_info(out, k, t, kind_param_at(k, t, index));
        return true;
    }
    return false;
}

lmn_status lmn_look_open(lmn_look **out, const lmn_look_desc *desc, lmn_error *error)
{
    lmn_look_desc full = LMN_LOOK_DESC_INIT;
    if (!out)
        return missing("lmn_look_open", "out", error);
    *out = NULL;
    lmn_status status = desc_complete(&full, sizeof full, desc, "LMN_LOOK_DESC_INIT", error);
    if (status != LMN_OK)
        return status;
    if (full.name_or_path && full.json)
        return error_set(error, LMN_USAGE, "lmn_look_open: `name_or_path` and `json` are both given");
    if (full.name_or_path)
        return look_load(out, full.name_or_path, full.techniques, error);
    if (!full.json)
        return look_create(out, full.techniques, error);
    return look_parse(out, full.json, strlen(full.json), full.name ? full.name : "look", full.techniques, error);
}
