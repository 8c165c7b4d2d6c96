/* Looks by calls: checks arguments and forwards. */
#include "limner/rules.h"

#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "look/look_change.h"
#include "look/look_edit.h"
#include "look/motion_way.h"
#include "look/typed.h"

/* The first of these that is NULL. */
#define CHECK(ARGUMENT)                                                                                                \
    if (!(ARGUMENT))                                                                                                   \
    return error_set(error, LMN_USAGE, "%s is NULL", #ARGUMENT)

/* --- what there is -------------------------------------------------------------------------------------- */

size_t lmn_kind_count(void)
{
    return KIND_COUNT;
}

bool lmn_kind_at(size_t index, lmn_kind_info *out)
{
    if (index >= KIND_COUNT || !out)
        return false;
    const kind *k = kinds[index];
    *out = (lmn_kind_info){.name = k->name,
                           .doc = k->doc,
                           .technique_count = k->technique_count,
                           .standard = k->standard ? k->standard->name : NULL,
                           .whole_look = k->look_wide,
                           .several = k->array,
                           .optional = kind_may_be_none(k)};
    return true;
}

bool lmn_technique_at(const char *kind_name, size_t index, lmn_technique_info *out)
{
    const kind *k = kind_name ? kind_find(kind_name) : NULL;
    if (!k || index >= k->technique_count || !out)
        return false;
    const technique *t = k->techniques[index];
    *out = (lmn_technique_info){t->name, t->doc ? t->doc : "", kind_param_count(k, t), k->common_count};
    return true;
}

bool lmn_param_at(const char *kind_name, const char *technique_name, size_t index, lmn_param_info *out)
{
    const kind      *k = kind_name ? kind_find(kind_name) : NULL;
    const technique *t = k && technique_name ? kind_find_technique(k, technique_name) : NULL;
    if (!t || index >= kind_param_count(k, t) || !out)
        return false;
    typed_info(out, k, t, kind_param_at(k, t, index));
    return true;
}

lmn_status lmn_param_find(const char *kind_name, const char *technique_name, const char *key, lmn_param_info *out,
                          lmn_error *error)
{
    CHECK(kind_name);
    CHECK(technique_name);
    CHECK(key);
    CHECK(out);
    const kind *k = kind_find(kind_name);
    if (!k)
        return kind_unknown(kind_name, NULL, error);
    const technique *t = kind_find_technique(k, technique_name);
    if (!t)
        return kind_unknown_technique(k, NULL, technique_name, error);
    const param *p = kind_find_param(k, t, key);
    if (!p)
        return kind_missing_param(k, t, key, error);
    typed_info(out, k, t, p);
    return LMN_OK;
}

bool lmn_motion_way_at(size_t index, lmn_motion_way_info *out)
{
    return motion_way_at(index, out);
}

lmn_status lmn_look_set_motion_way(lmn_look *look, const char *name, lmn_error *error)
{
    CHECK(look);
    CHECK(name);
    return look_set_motion_way(look, name, error);
}

const char *lmn_look_motion_way(const lmn_look *look)
{
    return look ? look_motion_way(look) : NULL;
}

/* --- looks ---------------------------------------------------------------------------------------------- */

lmn_status lmn_look_create(lmn_look **out, lmn_error *error)
{
    CHECK(out);
    return look_create(out, NULL, error);
}

lmn_status lmn_look_copy(lmn_look **out, const lmn_look *look, lmn_error *error)
{
    CHECK(out);
    CHECK(look);
    return look_copy(out, look, error);
}

lmn_status lmn_look_set_name(lmn_look *look, const char *name, lmn_error *error)
{
    CHECK(look);
    CHECK(name);
    return look_set_words(look, &look->name, name, error);
}

const char *lmn_look_doc(const lmn_look *look)
{
    return look ? look->doc : NULL;
}

lmn_status lmn_look_set_doc(lmn_look *look, const char *doc, lmn_error *error)
{
    CHECK(look);
    return look_set_words(look, &look->doc, doc, error);
}

uint64_t lmn_look_revision(const lmn_look *look)
{
    return look ? look->revision : 0;
}

unsigned lmn_look_changes(const lmn_look *look, uint64_t since)
{
    return look ? look_changes(look, since) : 0;
}

/* --- rules ---------------------------------------------------------------------------------------------- */

size_t lmn_look_rule_count(const lmn_look *look)
{
    return look ? look->rule_count : 0;
}

lmn_status lmn_look_add_rule(lmn_look *look, const char *selector, size_t before, size_t *rule, lmn_error *error)
{
    CHECK(look);
    CHECK(selector);
    return look_add_rule(look, selector, before, rule, error);
}

lmn_status lmn_look_remove_rule(lmn_look *look, size_t rule, lmn_error *error)
{
    CHECK(look);
    return look_remove_rule(look, rule, error);
}

lmn_status lmn_look_move_rule(lmn_look *look, size_t rule, size_t to, lmn_error *error)
{
    CHECK(look);
    return look_move_rule(look, rule, to, error);
}

const char *lmn_look_rule_selector(const lmn_look *look, size_t rule)
{
    return look && rule < look->rule_count ? look->rules[rule].select : NULL;
}

lmn_status lmn_look_set_rule_selector(lmn_look *look, size_t rule, const char *selector, lmn_error *error)
{
    CHECK(look);
    CHECK(selector);
    return look_select(look, rule, selector, error);
}

const char *lmn_look_rule_name(const lmn_look *look, size_t rule)
{
    return look && rule < look->rule_count ? look->rules[rule].name : NULL;
}

lmn_status lmn_look_set_rule_name(lmn_look *look, size_t rule, const char *name, lmn_error *error)
{
    CHECK(look);
    lmn_status status = look_check_rule(look, rule, error);
    return status == LMN_OK ? look_set_words(look, &look->rules[rule].name, name, error) : status;
}

/* --- techniques ----------------------------------------------------------------------------------------- */

static lmn_status find_uses(use_list *out, const lmn_look *look, size_t rule, const char *kind, lmn_error *error)
{
    CHECK(look);
    CHECK(kind);
    return look_find_uses(out, look, rule, kind, error);
}

size_t lmn_look_technique_count(const lmn_look *look, size_t rule, const char *kind)
{
    use_list uses;
    return find_uses(&uses, look, rule, kind, NULL) == LMN_OK ? uses.count : 0;
}

const char *lmn_look_technique(const lmn_look *look, size_t rule, const char *kind, size_t index)
{
    use_list uses;
    if (find_uses(&uses, look, rule, kind, NULL) != LMN_OK || index >= uses.count)
        return NULL;
    return uses.uses[index].technique->name;
}

lmn_status lmn_look_set_technique(lmn_look *look, size_t rule, const char *kind, size_t index, const char *technique,
                                  lmn_error *error)
{
    use_list uses;
    CHECK(technique);
    lmn_status status = find_uses(&uses, look, rule, kind, error);
    return status == LMN_OK ? look_set_technique(look, &uses, index, technique, error) : status;
}

lmn_status lmn_look_add_technique(lmn_look *look, size_t rule, const char *kind, const char *technique, size_t before,
                                  lmn_error *error)
{
    use_list uses;
    CHECK(technique);
    lmn_status status = find_uses(&uses, look, rule, kind, error);
    return status == LMN_OK ? look_add_technique(look, &uses, technique, before, error) : status;
}

lmn_status lmn_look_remove_technique(lmn_look *look, size_t rule, const char *kind, size_t index, lmn_error *error)
{
    use_list   uses;
    lmn_status status = find_uses(&uses, look, rule, kind, error);
    return status == LMN_OK ? look_remove_technique(look, &uses, index, error) : status;
}

lmn_status lmn_look_move_technique(lmn_look *look, size_t rule, const char *kind, size_t index, size_t to,
                                   lmn_error *error)
{
    use_list   uses;
    lmn_status status = find_uses(&uses, look, rule, kind, error);
    return status == LMN_OK ? look_move_technique(look, &uses, index, to, error) : status;
}

/* --- parameters ----------------------------------------------------------------------------------------- */

static lmn_status find_param(param_place *out, const lmn_look *look, size_t rule, const char *kind, size_t index,
                             const char *key, lmn_error *error)
{
    CHECK(look);
    CHECK(kind);
    CHECK(key);
    return look_find_param(out, look, rule, kind, index, key, error);
}

lmn_status lmn_look_param_state(const lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                                lmn_param_state *out, lmn_error *error)
{
    param_place place;
    CHECK(out);
    lmn_status status = find_param(&place, look, rule, kind, index, key, error);
    if (status == LMN_OK)
        *out = (lmn_param_state){param_is_default(place.param, place.use->values),
                                 param_is_auto(place.param, place.use->values),
                                 typed_applies(place.kind, place.use, place.param)};
    return status;
}

lmn_status lmn_look_get_text(const lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                             char *out, size_t size, lmn_error *error)
{
    param_place place;
    char        printed[LMN_VALUE_TEXT_MAX];
    CHECK(out);
    lmn_status status = find_param(&place, look, rule, kind, index, key, error);
    if (status != LMN_OK)
        return status;
    param_print(place.param, place.use->values, printed, sizeof printed);
    size_t needed = strlen(printed) + 1;
    if (needed > size) {
        status = error_set(error, LMN_USAGE, "%s.%s needs %zu bytes; there are %zu", kind, key, needed, size);
        error_hint(error, "LMN_VALUE_TEXT_MAX suffice");
        return status;
    }
    memcpy(out, printed, needed);
    return LMN_OK;
}

lmn_status lmn_look_set_text(lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                             const char *value, lmn_error *error)
{
    param_place place;
    CHECK(value);
    lmn_status status = find_param(&place, look, rule, kind, index, key, error);
    return status == LMN_OK ? look_change_param(look, &place, value, error) : status;
}

lmn_status lmn_look_get_number(const lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                               double *out, lmn_error *error)
{
    param_place place;
    CHECK(out);
    lmn_status status = find_param(&place, look, rule, kind, index, key, error);
    if (status != LMN_OK)
        return status;
    return error_name_kind(place.kind, typed_number(place.param, place.use->values, out, error), error);
}

/* What was printed, if it was. */
static lmn_status change(lmn_look *look, const param_place *place, lmn_status printed, const char *value,
                         lmn_error *error)
{
    if (printed != LMN_OK)
        return error_name_kind(place->kind, printed, error);
    return look_change_param(look, place, value, error);
}

lmn_status lmn_look_set_number(lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                               double value, lmn_error *error)
{
    param_place place;
    char        text[LMN_VALUE_TEXT_MAX];
    lmn_status  status = find_param(&place, look, rule, kind, index, key, error);
    if (status != LMN_OK)
        return status;
    return change(look, &place, typed_print_number(place.param, value, text, error), text, error);
}

lmn_status lmn_look_get_colours(const lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                                float *rgba, size_t *count, lmn_error *error)
{
    param_place place;
    CHECK(rgba);
    CHECK(count);
    lmn_status status = find_param(&place, look, rule, kind, index, key, error);
    if (status != LMN_OK)
        return status;
    return error_name_kind(place.kind, typed_colours(place.param, place.use->values, rgba, count, error), error);
}

lmn_status lmn_look_set_colours(lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                                const float *rgba, size_t count, lmn_error *error)
{
    param_place place;
    char        text[LMN_VALUE_TEXT_MAX];
    CHECK(rgba);
    lmn_status status = find_param(&place, look, rule, kind, index, key, error);
    if (status != LMN_OK)
        return status;
    return change(look, &place, typed_print_colours(place.param, rgba, count, text, error), text, error);
}

lmn_status lmn_look_get_direction(const lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                                  double out[3], lmn_error *error)
{
    param_place place;
    CHECK(out);
    lmn_status status = find_param(&place, look, rule, kind, index, key, error);
    if (status != LMN_OK)
        return status;
    return error_name_kind(place.kind, typed_direction(place.param, place.use->values, out, error), error);
}

lmn_status lmn_look_set_direction(lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                                  const double value[3], lmn_error *error)
{
    param_place place;
    char        text[LMN_VALUE_TEXT_MAX];
    CHECK(value);
    lmn_status status = find_param(&place, look, rule, kind, index, key, error);
    if (status != LMN_OK)
        return status;
    return change(look, &place, typed_print_direction(place.param, value, text, error), text, error);
}

lmn_status lmn_look_set_auto(lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                             lmn_error *error)
{
    param_place place;
    char        text[LMN_VALUE_TEXT_MAX];
    lmn_status  status = find_param(&place, look, rule, kind, index, key, error);
    if (status != LMN_OK)
        return status;
    return change(look, &place, typed_print_auto(place.param, text, error), text, error);
}

lmn_status lmn_look_reset(lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                          lmn_error *error)
{
    param_place place;
    CHECK(look);
    CHECK(kind);
    lmn_status status = look_find_param(&place, look, rule, kind, index, key, error);
    return status == LMN_OK ? look_change_param(look, &place, NULL, error) : status;
}

/* --- controls ------------------------------------------------------------------------------------------- */

size_t lmn_control_count(void)
{
    return CONTROL_COUNT;
}

bool lmn_control_at(size_t index, lmn_control_info *out)
{
    if (index >= CONTROL_COUNT || !out)
        return false;
    *out = (lmn_control_info){control_rows[index].name, control_rows[index].doc};
    return true;
}

bool lmn_look_has_control(const lmn_look *look, const char *name)
{
    size_t index;
    return look && name && control_find(&index, name, NULL) == LMN_OK && look->controls[index].map_count;
}

lmn_status lmn_look_get_control(const lmn_look *look, const char *name, double *out, lmn_error *error)
{
    CHECK(look);
    CHECK(name);
    CHECK(out);
    size_t     index;
    lmn_status status = control_find(&index, name, error);
    if (status == LMN_OK)
        *out = look->controls[index].value;
    return status;
}

/* Finds a control and opens the look for a change of it. */
static lmn_status begin_control(lmn_look **before, size_t *index, const lmn_look *look, const char *name,
                                lmn_error *error)
{
    lmn_status status = control_find(index, name, error);
    return status == LMN_OK ? look_edit_begin(before, look, error) : status;
}

lmn_status lmn_look_set_control(lmn_look *look, const char *name, double value, lmn_error *error)
{
    CHECK(look);
    CHECK(name);
    size_t     index;
    lmn_look  *before;
    lmn_status status = begin_control(&before, &index, look, name, error);
    return status == LMN_OK ? look_edit_end(look, &before, look_set_control(look, index, value, error)) : status;
}

bool lmn_look_control_map(const lmn_look *look, const char *name, size_t index, lmn_control_map *out)
{
    size_t at;
    if (!out || !lmn_look_has_control(look, name) || control_find(&at, name, NULL) != LMN_OK ||
        index >= look->controls[at].map_count)
        return false;
    const control_map *map = &look->controls[at].maps[index];
    *out = (lmn_control_map){map->key, map->times, map->low, map->high};
    return true;
}

lmn_status lmn_look_set_control_maps(lmn_look *look, const char *name, const lmn_control_map *maps, size_t count,
                                     lmn_error *error)
{
    CHECK(look);
    CHECK(name);
    if (count)
        CHECK(maps);
    size_t     index;
    lmn_look  *before;
    lmn_status status = begin_control(&before, &index, look, name, error);
    return status == LMN_OK ? look_edit_end(look, &before, look_set_control_maps(look, index, maps, count, error))
                            : status;
}
