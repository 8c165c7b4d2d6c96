/* Depiction: checks arguments and forwards. */
#include "limner/depict.h"

#include <string.h>

#include "api/check_desc.h"
#include "api/complete.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "depict/depict.h"
#include "look/typed.h"
#include "look/value.h"
#include "plan/time.h"

/* NULL: there are fewer. */
static const depiction *depiction_at(size_t index)
{
    size_t count = 0;
    while (depictions[count])
        count++;
    return index < count ? depictions[index] : NULL;
}

bool lmn_depiction_at(size_t index, lmn_depiction_info *out)
{
    const depiction *d = depiction_at(index);
    if (!d || !out)
        return false;
    *out = (lmn_depiction_info){d->characteristic, d->semantics, d->doc, d->param_count};
    return true;
}

bool lmn_depiction_param_at(size_t index, size_t param_index, lmn_param_info *out)
{
    const depiction *d = depiction_at(index);
    if (!d || param_index >= d->param_count || !out)
        return false;
    typed_info(out, NULL, NULL, &d->params[param_index]);
    return true;
}

char *lmn_depiction_reference(void)
{
    return depict_reference();
}

lmn_status lmn_depict_clear(lmn_scene *scene, lmn_error *error)
{
    return scene ? depict_clear(scene, error) : error_set(error, LMN_USAGE, "lmn_depict_clear: `scene` is NULL");
}

lmn_status lmn_look_add_sign_rules(lmn_look *look, lmn_error *error)
{
    return look ? look_add_sign_rules(look, error)
                : error_set(error, LMN_USAGE, "lmn_look_add_sign_rules: `look` is NULL");
}

static lmn_status complete(lmn_depict_desc *full, const lmn_depict_desc *given, lmn_error *error)
{
    lmn_status status = desc_complete_given(full, sizeof *full, given, "LMN_DEPICT_DESC_INIT", error);
    if (status == LMN_OK && full->interval_given &&
        !(full->from_s >= 0 && full->to_s > full->from_s && full->to_s <= 1e9))
        return error_set(error, LMN_USAGE, "lmn_depict: the interval is from %g to %g seconds", full->from_s,
                         full->to_s);
    return status;
}

/* What is told: as it is given, or as the scene proposes. */
static lmn_status find_expressions(expression_list *out, json_t **reasons, const lmn_scene *scene,
                                   const lmn_depict_desc *d, const lmn_draw_desc *draw, warnings *warnings,
                                   lmn_error *error)
{
    moment     when;
    lmn_status status = time_moment(&when, scene, draw, NULL, error);
    if (status != LMN_OK)
        return status;
    if (!d->expressions) {
        const double end = moment_duration(&when, scene), from = d->interval_given ? d->from_s : 0,
                     to = d->interval_given ? d->to_s : end;
        if (end > 0 && from >= end)
            return error_set(error, LMN_USAGE, "the interval, from %g to %g, lies behind the end of all motion, %g s",
                             from, to, end);
        return depict_propose(out, reasons, scene, &when, from, to, warnings, error);
    }
    status = expressions_read(out, d->expressions, scene, &when, error);
    if (status == LMN_OK && out->count == 0)
        warnings_add(warnings, WARNING_UNTOLD, "there are no expressions: nothing is told");
    *reasons = json_array();
    return status;
}

/* {"expressions", "reasons", "warnings"} as text; NULL when memory is gone. */
static char *told_json(const expression_list *list, json_t *reasons, const warnings *said, const lmn_scene *scene)
{
    json_t *texts = json_array();
    for (size_t i = 0; i < said->count; i++)
        json_array_append_new(texts, json_string(said->items[i].text));
    return value_text_exact(json_pack("{s:o,s:O,s:o}", "expressions", expressions_json(list, scene), "reasons", reasons,
                                      "warnings", texts));
}

lmn_status lmn_depict(lmn_scene *scene, const lmn_draw_desc *draw, const lmn_depict_desc *desc, char **json,
                      lmn_error *error)
{
    lmn_depict_desc full = LMN_DEPICT_DESC_INIT;
    lmn_draw_desc   wanted;
    expression_list list = {0};
    json_t         *reasons = NULL;
    warnings        said = {0};
    if (json)
        *json = NULL;
    if (!scene)
        return error_set(error, LMN_USAGE, "lmn_depict: `scene` is NULL");
    lmn_status status = check_draw_desc(&wanted, draw, error);
    if (status == LMN_OK)
        status = complete(&full, desc, error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, wanted.progress, wanted.progress_user);
    status = depict_clear(scene, error);
    if (status == LMN_OK)
        status = find_expressions(&list, &reasons, scene, &full, &wanted, &said, error);
    if (status == LMN_OK)
        status = depict(scene, &list, &wanted, &said, error);
    if (status == LMN_OK && json) {
        *json = told_json(&list, reasons, &said, scene);
        status = *json ? LMN_OK : error_memory(error);
    }
    status = work_end(&w, status, error);
    json_decref(reasons);
    warnings_release(&said);
    expression_list_release(&list);
    return status;
}
