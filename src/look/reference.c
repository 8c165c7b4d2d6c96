/* The reference: what the tables of the kinds hold, as JSON. `limner looks`, the documentation and user interfaces are
 * made from it. */
#include "look/look.h"

#include <jansson.h>
#include <stdio.h>

#include "base/embedded.h"
#include "look/value.h"

static bool put(json_t *object, const char *key, json_t *value)
{
    return value && json_object_set_new(object, key, value) == 0;
}

static bool append(json_t *array, json_t *value)
{
    return value && json_array_append_new(array, value) == 0;
}

static bool put_range(json_t *object, const param *p)
{
    bool soft = p->soft_min != 0 || p->soft_max != 0;
    bool done = put(object, "min", value_number(p->min)) && put(object, "max", value_number(p->max));
    if (done && soft)
        done = put(object, "soft_min", value_number(p->soft_min)) && put(object, "soft_max", value_number(p->soft_max));
    if (done && p->logarithmic)
        done = put(object, "logarithmic", json_true());
    return done;
}

static bool put_names(json_t *object, const param *p)
{
    json_t *names = json_array();
    if (!put(object, "values", names))
        return false;
    for (size_t i = 0; p->names[i]; i++)
        if (!append(names, json_string(p->names[i])))
            return false;
    return true;
}

static bool put_default(json_t *object, const kind *k, const technique *t, const param *p)
{
    technique_use standard;
    if (!use_create(&standard, k, t))
        return false;
    bool done = put(object, "default", value_json(p, standard.values));
    use_release(&standard);
    return done;
}

/* One parameter. `key` may say more than the row does ("lines.width"). `use` (may be NULL) adds its value. */
static json_t *param_json(const kind *k, const technique *t, const param *p, const char *key, const technique_use *use)
{
    json_t *object = json_object();
    bool    done =
        object && put(object, "name", json_string(key)) && put(object, "type", json_string(param_type_text(p->type)));
    if (done && (p->type == PARAM_INT || p->type == PARAM_FLOAT))
        done = put_range(object, p);
    if (done && p->type == PARAM_ENUM)
        done = put_names(object, p);
    if (done && p->unit != UNIT_NONE)
        done = put(object, "unit", json_string(param_unit_text(p->unit)));
    if (done && p->can_auto)
        done =
            put(object, "auto", json_true()) && (!p->auto_from || put(object, "auto_from", json_string(p->auto_from)));
    if (done && use)
        done = put(object, "value", value_json(p, use->values));
    done = done && put_default(object, k, t, p);
    if (done && p->only_if)
        done = put(object, "only_if", json_string(p->only_if));
    if (done && p->since)
        done = put(object, "since", json_string(p->since));
    if (done && put(object, "doc", json_string(p->doc ? p->doc : "")))
        return object;
    json_decref(object);
    return NULL;
}

static json_t *params_json(const kind *k, const technique *t, const param *params, size_t count)
{
    json_t *array = json_array();
    for (size_t i = 0; array && i < count; i++)
        if (!append(array, param_json(k, t, &params[i], params[i].key, NULL))) {
            json_decref(array);
            return NULL;
        }
    return array;
}

static json_t *technique_json(const kind *k, const technique *t)
{
    json_t *object = json_object();
    if (object && put(object, "name", json_string(t->name)) && put(object, "doc", json_string(t->doc ? t->doc : "")) &&
        (!t->example || put(object, "example", json_string(t->example))) &&
        put(object, "parameters", params_json(k, t, t->params, t->param_count)))
        return object;
    json_decref(object);
    return NULL;
}

static bool put_techniques(json_t *object, const kind *k)
{
    json_t *array = json_array();
    if (!put(object, "techniques", array))
        return false;
    for (size_t i = 0; i < k->technique_count; i++)
        if (!append(array, technique_json(k, k->techniques[i])))
            return false;
    return true;
}

static json_t *kind_json(const kind *k)
{
    json_t *object = json_object();
    if (object && put(object, "name", json_string(k->name)) && put(object, "doc", json_string(k->doc)) &&
        put(object, "key", json_string(k->selector_key)) && put(object, "look_wide", json_boolean(k->look_wide)) &&
        put(object, "array", json_boolean(k->array)) &&
        put(object, "standard", k->standard ? json_string(k->standard->name) : json_null()) &&
        put(object, "common", params_json(k, k->techniques[0], k->common, k->common_count)) &&
        put_techniques(object, k))
        return object;
    json_decref(object);
    return NULL;
}

/* Name and doc of each look that ships. */
static lmn_status put_looks(json_t *root, lmn_error *error)
{
    json_t *array = json_array();
    if (!put(root, "looks", array))
        return error_memory(error);
    for (size_t i = 0; i < embedded_looks_count; i++) {
        lmn_look  *look = NULL;
        lmn_status status = look_load(&look, look_name_at(i), NULL, error);
        if (status != LMN_OK)
            return status;
        json_t *object = json_object();
        bool    done = object && put(object, "name", json_string(look->name)) &&
                    put(object, "doc", json_string(look->doc ? look->doc : ""));
        look_destroy(&look);
        if (!done)
            json_decref(object);
        if (!done || !append(array, object))
            return error_memory(error);
    }
    return LMN_OK;
}

static bool put_control_rows(json_t *root)
{
    json_t *array = json_array();
    if (!put(root, "controls", array))
        return false;
    for (size_t i = 0; i < CONTROL_COUNT; i++)
        if (!append(array, json_pack("{s:s,s:s}", "name", control_rows[i].name, "doc", control_rows[i].doc)))
            return false;
    return true;
}

static lmn_status reference_of_all(json_t *root, lmn_error *error)
{
    lmn_status status = put_looks(root, error);
    json_t    *array = json_array();
    if (!put(root, "kinds", array) || !put_control_rows(root))
        return status != LMN_OK ? status : error_memory(error);
    for (size_t i = 0; i < KIND_COUNT && status == LMN_OK; i++)
        if (!append(array, kind_json(kinds[i])))
            status = error_memory(error);
    return status;
}

/* "lines.width", with an index where there are several. */
static bool append_use(json_t *array, const kind *k, const technique_use *use, size_t index, size_t count)
{
    char    key[128];
    json_t *object = json_object(), *parameters = json_array();
    if (!put(object, "parameters", parameters)) {
        json_decref(object);
        return false;
    }
    if (!append(array, object))
        return false;
    if (!put(object, "kind", json_string(k->name)) || !put(object, "technique", json_string(use->technique->name)) ||
        !put(object, "doc", json_string(use->technique->doc)))
        return false;
    for (size_t i = 0; i < kind_param_count(k, use->technique); i++) {
        const param *p = kind_param_at(k, use->technique, i);
        if (count > 1)
            snprintf(key, sizeof key, "%s[%zu].%s", k->name, index, p->key);
        else
            snprintf(key, sizeof key, "%s.%s", k->name, p->key);
        if (!append(parameters, param_json(k, use->technique, p, key, use)))
            return false;
    }
    return true;
}

static json_t *rule_json(const rule *r)
{
    json_t *object = json_object(), *uses = json_array();
    if (!put(object, "uses", uses)) {
        json_decref(object);
        return NULL;
    }
    bool done =
        (!r->name || put(object, "name", json_string(r->name))) && put(object, "select", json_string(r->select));
    for (size_t k = 0; k < KIND_COUNT; k++)
        for (size_t i = 0; i < r->use_counts[k] && done; i++)
            done = append_use(uses, kinds[k], &r->uses[k][i], i, r->use_counts[k]);
    if (done)
        return object;
    json_decref(object);
    return NULL;
}

/* "x0.5 to x2", "-0.2 to +0.2". */
static json_t *map_json(const control_map *map)
{
    char ends[96];
    snprintf(ends, sizeof ends, map->times ? "x%g to x%g" : "%+g to %+g", map->low, map->high);
    json_t *object = json_object();
    if (put(object, "param", json_string(map->key)) && put(object, "change", json_string(ends)))
        return object;
    json_decref(object);
    return NULL;
}

static json_t *control_json(const control *c, const control_row *row)
{
    json_t *object = json_object(), *maps = json_array();
    bool    done = put(object, "maps", maps) && put(object, "name", json_string(row->name)) &&
                put(object, "doc", json_string(row->doc)) && put(object, "value", value_number(c->value));
    for (size_t m = 0; m < c->map_count && done; m++)
        done = append(maps, map_json(&c->maps[m]));
    if (done)
        return object;
    json_decref(object);
    return NULL;
}

static bool put_controls(json_t *root, const lmn_look *look)
{
    json_t *array = json_array();
    if (!put(root, "controls", array))
        return false;
    for (size_t i = 0; i < CONTROL_COUNT; i++)
        if (look->controls[i].map_count && !append(array, control_json(&look->controls[i], &control_rows[i])))
            return false;
    return true;
}

static bool put_look(json_t *root, const lmn_look *look)
{
    json_t *wide = json_array(), *rules = json_array();
    bool    has_wide = put(root, "uses", wide), has_rules = put(root, "rules", rules);
    if (!has_wide || !has_rules || !put(root, "name", json_string(look->name)) ||
        !put(root, "doc", json_string(look->doc ? look->doc : "")) || !put_controls(root, look))
        return false;
    for (size_t k = 0; k < KIND_COUNT; k++)
        if (look->wide[k].technique && !append_use(wide, kinds[k], &look->wide[k], 0, 1))
            return false;
    for (size_t i = 0; i < look->rule_count; i++)
        if (!append(rules, rule_json(&look->rules[i])))
            return false;
    return true;
}

static lmn_status reference_of_look(json_t *root, const char *name_or_path, lmn_error *error)
{
    lmn_look  *look = NULL;
    lmn_status status = look_load(&look, name_or_path, NULL, error);
    if (status == LMN_OK && !put_look(root, look))
        status = error_memory(error);
    look_destroy(&look);
    return status;
}

lmn_status look_reference_json(char **out, const char *name_or_path, lmn_error *error)
{
    *out = NULL;
    json_t *root = json_object();
    if (!root)
        return error_memory(error);
    lmn_status status = name_or_path ? reference_of_look(root, name_or_path, error) : reference_of_all(root, error);
    if (status != LMN_OK) {
        json_decref(root);
        return status;
    }
    *out = value_text(root);
    return *out ? LMN_OK : error_memory(error);
}
