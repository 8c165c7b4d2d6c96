#include "part_look.h"

#include <stdio.h>
#include <string.h>

/* As many techniques of the kind as the other has, and the same. */
static lmn_status take_techniques(lmn_look *look, size_t rule, const char *kind, const lmn_look *from, lmn_error *error)
{
    size_t     wanted = lmn_look_technique_count(from, 0, kind);
    lmn_status status = LMN_OK;
    while (status == LMN_OK && lmn_look_technique_count(look, rule, kind) > wanted)
        status = lmn_look_remove_technique(look, rule, kind, lmn_look_technique_count(look, rule, kind) - 1, error);
    for (size_t i = 0; i < wanted && status == LMN_OK; i++) {
        const char *technique = lmn_look_technique(from, 0, kind, i);
        status = i < lmn_look_technique_count(look, rule, kind)
                     ? lmn_look_set_technique(look, rule, kind, i, technique, error)
                     : lmn_look_add_technique(look, rule, kind, technique, LMN_AT_END, error);
    }
    return status;
}

static lmn_status take_values(lmn_look *look, size_t rule, const char *kind, const lmn_look *from, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < lmn_look_technique_count(from, 0, kind); i++) {
        lmn_param_info param;
        const char    *technique = lmn_look_technique(from, 0, kind, i);
        for (size_t p = 0; status == LMN_OK && lmn_param_at(kind, technique, p, &param); p++) {
            char text[LMN_VALUE_TEXT_MAX];
            status = lmn_look_get_text(from, 0, kind, i, param.key, text, sizeof text, error);
            if (status == LMN_OK)
                status = lmn_look_set_text(look, rule, kind, i, param.key, text, error);
        }
    }
    return status;
}

lmn_status part_look_put(lmn_look *look, uint32_t part, const lmn_look *from, lmn_error *error)
{
    char          selector[32];
    size_t        rule = 0;
    lmn_kind_info kind;
    lmn_status    status = LMN_OK;
    snprintf(selector, sizeof selector, "[id=%u]", part);
    for (size_t i = lmn_look_rule_count(look); i-- > 1 && status == LMN_OK;)
        if (strcmp(lmn_look_rule_selector(look, i), selector) == 0)
            status = lmn_look_remove_rule(look, i, error);
    if (status == LMN_OK)
        status = lmn_look_add_rule(look, selector, LMN_AT_END, &rule, error);
    for (size_t k = 0; status == LMN_OK && lmn_kind_at(k, &kind); k++) {
        if (kind.whole_look)
            continue;
        status = take_techniques(look, rule, kind.name, from, error);
        if (status == LMN_OK)
            status = take_values(look, rule, kind.name, from, error);
    }
    return status;
}
