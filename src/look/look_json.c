/* A look as the JSON that makes it again: only what differs from the defaults. */
#include "look/look.h"

#include <jansson.h>
#include <string.h>

#include "look/value.h"

/* True when the reference was taken over. A NULL value means that memory is gone. */
static bool put(json_t *object, const char *key, json_t *value)
{
    return value && json_object_set_new(object, key, value) == 0;
}

static bool put_changed(json_t *object, const kind *k, const technique_use *use)
{
    for (size_t i = 0; i < kind_param_count(k, use->technique); i++) {
        const param *p = kind_param_at(k, use->technique, i);
        if (!param_is_default(p, use->values) && !put(object, p->key, value_json(p, use->values)))
            return false;
    }
    return true;
}

/* A technique's name alone when all its values are the defaults, else an object. */
static json_t *use_json(const kind *k, const technique_use *use)
{
    json_t *object = json_object();
    bool    done = object &&
                (use->technique == k->standard || put(object, k->selector_key, json_string(use->technique->name))) &&
                put_changed(object, k, use);
    if (!done) {
        json_decref(object);
        return NULL;
    }
    bool named = json_object_get(object, k->selector_key) != NULL;
    if (json_object_size(object) == (named ? 1u : 0u)) {
        json_decref(object);
        return json_string(use->technique->name);
    }
    return object;
}

static json_t *uses_json(const kind *k, const technique_use *uses, size_t count)
{
    if (count == 0)
        return json_null();
    if (count == 1)
        return use_json(k, uses);
    json_t *array = json_array();
    for (size_t i = 0; array && i < count; i++)
        if (json_array_append_new(array, use_json(k, &uses[i])) != 0) {
            json_decref(array);
            return NULL;
        }
    return array;
}

/* What a rule (or a look) has when it says nothing about the kind. */
static bool is_standard(const kind *k, const technique_use *uses, size_t count)
{
    if (!k->standard)
        return count == 0;
    if (count != 1 || uses->technique != k->standard)
        return false;
    for (size_t i = 0; i < kind_param_count(k, k->standard); i++)
        if (!param_is_default(kind_param_at(k, k->standard, i), uses->values))
            return false;
    return true;
}

static json_t *rule_json(const rule *r)
{
    json_t *object = json_object();
    bool    done = object && (!r->name || put(object, "name", json_string(r->name))) &&
                put(object, "select", json_string(r->select));
    for (size_t i = 0; i < KIND_COUNT && done; i++) {
        const kind *k = kinds[i];
        if (!k->look_wide && !is_standard(k, r->uses[i], r->use_counts[i]))
            done = put(object, k->name, uses_json(k, r->uses[i], r->use_counts[i]));
    }
    if (done)
        return object;
    json_decref(object);
    return NULL;
}

static json_t *map_json(const control_map *map)
{
    json_t *object = json_object(), *ends = json_array();
    if (put(object, map->times ? "times" : "plus", ends) && json_array_append_new(ends, value_number(map->low)) == 0 &&
        json_array_append_new(ends, value_number(map->high)) == 0 && put(object, "param", json_string(map->key)))
        return object;
    json_decref(object);
    return NULL;
}

static bool put_control(json_t *controls, const control *c, const char *name)
{
    json_t *object = json_object(), *maps = json_array();
    if (!put(controls, name, object)) {
        json_decref(maps);
        return false;
    }
    if (!put(object, "maps", maps) || (c->value != 0 && !put(object, "value", json_real(c->value))))
        return false;
    for (size_t m = 0; m < c->map_count; m++)
        if (json_array_append_new(maps, map_json(&c->maps[m])) != 0)
            return false;
    return true;
}

static bool put_controls(json_t *root, const lmn_look *look)
{
    json_t *controls = NULL;
    for (size_t i = 0; i < CONTROL_COUNT; i++) {
        if (!look->controls[i].map_count)
            continue;
        if (!controls && !put(root, "controls", controls = json_object()))
            return false;
        if (!put_control(controls, &look->controls[i], control_rows[i].name))
            return false;
    }
    return true;
}

static bool put_rules(json_t *root, const lmn_look *look)
{
    json_t *rules = json_array();
    if (!put(root, "rules", rules))
        return false;
    for (size_t i = 0; i < look->rule_count; i++)
        if (json_array_append_new(rules, rule_json(&look->rules[i])) != 0)
            return false;
    return true;
}

char *look_json(const lmn_look *look)
{
    json_t *root = json_object();
    bool    done = root && put(root, "version", json_integer(LOOK_VERSION)) &&
                put(root, "name", json_string(look->name)) && (!look->doc || put(root, "doc", json_string(look->doc)));
    for (size_t i = 0; i < KIND_COUNT && done; i++) {
        const kind *k = kinds[i];
        if (k->look_wide && look->wide[i].technique && !is_standard(k, &look->wide[i], 1))
            done = put(root, k->name, use_json(k, &look->wide[i]));
    }
    if (done && put_controls(root, look) && put_rules(root, look))
        return value_text(root);
    json_decref(root);
    return NULL;
}
