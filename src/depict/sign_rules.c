/* Rules for signs, for looks that know of none: what is hatched or has no colour would drown letters. */
#include <string.h>

#include "base/error.h"
#include "depict/depict.h"
#include "limner/rules.h"
#include "look/look_edit.h"
#include "look/value.h"

static const char letters[] = "[glyph=words], [glyph=noise]",
                  papers[] = "[glyph=balloon], [glyph=star], [glyph=cloud], [glyph=inset-paper], "
                             "[glyph=arrow], [glyph=bent-arrow], [glyph=cause-arrow], [glyph=flow-arrow], "
                             "[glyph=burst-arrows]";

static bool selects_signs(const lmn_look *look)
{
    for (size_t i = 0; i < look->rule_count; i++)
        if (look->rules[i].select && strstr(look->rules[i].select, "[glyph"))
            return true;
    return false;
}

static const param *param_of(const technique_use *use, const char *key)
{
    for (size_t i = 0; use && i < use->technique->param_count; i++)
        if (strcmp(use->technique->params[i].key, key) == 0)
            return &use->technique->params[i];
    return NULL;
}

static const technique_use *first_use(const rule *r, kind_id kind)
{
    return r->use_counts[kind] ? &r->uses[kind][0] : NULL;
}

/* Does the rule draw in ink, whatever colour the model has? */
static bool is_ink(const rule *r)
{
    const technique_use *use = first_use(r, KIND_SURFACE);
    const param         *model = param_of(use, "model_colour"), *ink = param_of(use, "ink");
    const bool           inks =
        ink && params_condition(ink->only_if, use->technique->params, use->technique->param_count, use->values);
    return inks || (model && *(const float *)((const char *)use->values + model->offset) <= 0);
}

static lmn_status set(lmn_look *look, size_t rule, const char *kind, const char *key, const char *value,
                      lmn_error *error)
{
    param_place place;
    lmn_status  status = look_find_param(&place, look, rule, kind, 0, key, error);
    return status == LMN_OK ? look_change_param(look, &place, value, error) : status;
}

/* A rule that has one colour, or the model's own (NULL), and no lines. */
static lmn_status add_flat(lmn_look *look, const char *select, const char *fill, size_t *index, lmn_error *error)
{
    use_list   surface, lines;
    lmn_status status = look_add_rule(look, select, LMN_AT_END, index, error);
    if (status == LMN_OK)
        status = look_find_uses(&surface, look, *index, "surface", error);
    if (status == LMN_OK)
        status = look_set_technique(look, &surface, 0, "flat", error);
    if (status == LMN_OK)
        status = set(look, *index, "surface", fill ? "colour" : "model_colour", fill ? fill : "1", error);
    if (status == LMN_OK)
        status = look_find_uses(&lines, look, *index, "lines", error);
    while (status == LMN_OK && lines.count > 0) {
        status = look_remove_technique(look, &lines, 0, error);
        if (status == LMN_OK)
            status = look_find_uses(&lines, look, *index, "lines", error);
    }
    return status;
}

/* What the first rule's lines have, as text; the buffer stays as it is where it has none. */
static void lines_value(const lmn_look *look, const char *key, char out[PARAM_TEXT_MAX])
{
    param_place place;
    lmn_error   none;
    if (first_use(&look->rules[0], KIND_LINES) && look_find_param(&place, look, 0, "lines", 0, key, &none) == LMN_OK)
        param_print(place.param, place.use->values, out, PARAM_TEXT_MAX);
}

/* The outline that the look has. */
static lmn_status add_lines(lmn_look *look, size_t index, const char *ink, lmn_error *error)
{
    const technique_use *use = first_use(&look->rules[0], KIND_LINES);
    char                 width[PARAM_TEXT_MAX] = "";
    use_list             lines;
    if (!use)
        return LMN_OK;
    const char *name = use->technique->name;
    lines_value(look, "width", width);
    lmn_status status = look_find_uses(&lines, look, index, "lines", error);
    if (status == LMN_OK)
        status = look_add_technique(look, &lines, name, LMN_AT_END, error);
    if (status == LMN_OK)
        status = set(look, index, "lines", "colour", ink, error);
    return status == LMN_OK && *width ? set(look, index, "lines", "width", width, error) : status;
}

lmn_status look_add_sign_rules(lmn_look *look, lmn_error *error)
{
    if (look->rule_count == 0 || selects_signs(look))
        return LMN_OK;
    const technique_use *sheet = &look->wide[KIND_FINISH];
    const param         *ground = param_of(sheet, "ground");
    const colour        *ground_colour = ground ? (const colour *)((const char *)sheet->values + ground->offset) : NULL;
    char                 ink[PARAM_TEXT_MAX] = "#1b1d24", paper[PARAM_TEXT_MAX] = "#ffffff";
    size_t               index;
    bool                 ink_only = is_ink(&look->rules[0]);
    lines_value(look, "colour", ink);
    if (ground_colour && ground_colour->a > 0) {
        param_print(ground, sheet->values, paper, sizeof paper);
        /* The letters' own colours are those of ink on light paper. */
        ink_only = ink_only || ground_colour->r + ground_colour->g + ground_colour->b < 1.2f;
    }
    lmn_status status = add_flat(look, letters, ink_only ? ink : NULL, &index, error);
    if (status == LMN_OK && ink_only)
        status = add_flat(look, papers, paper, &index, error);
    return status == LMN_OK && ink_only ? add_lines(look, index, ink, error) : status;
}
