#include "look/look_version.h"

#include "base/paper.h"
#include "look/look.h"

/* --- version 1: lengths are pixels, of 1/96 inch -------------------------------------------------------- */

static const technique *named_technique(const kind *k, const json_t *use)
{
    const json_t *name = json_is_string(use) ? use : json_object_get(use, k->selector_key);
    if (!name)
        name = json_object_get(use, "technique");
    return name ? kind_find_technique(k, json_string_value(name) ? json_string_value(name) : "") : k->standard;
}

static bool use_in_points(const kind *k, json_t *use)
{
    const technique *t = named_technique(k, use);
    const char      *key;
    json_t          *value;
    json_object_foreach(use, key, value)
    {
        const param *p = t && json_is_number(value) ? kind_find_param(k, t, key) : NULL;
        if (p && p->unit == UNIT_PT &&
            json_object_set_new(use, key, json_real(json_number_value(value) * (POINTS_PER_INCH / PX_PER_INCH))) != 0)
            return false;
    }
    return true;
}

/* Of a rule or of the whole look. */
static bool kinds_in_points(json_t *object)
{
    const char *key;
    json_t     *value;
    json_object_foreach(object, key, value)
    {
        const kind *k = kind_find(key);
        if (!k)
            continue;
        if (!json_is_array(value) && !use_in_points(k, value))
            return false;
        for (size_t i = 0; i < json_array_size(value); i++)
            if (!use_in_points(k, json_array_get(value, i)))
                return false;
    }
    return true;
}

static bool lengths_in_points(json_t *root)
{
    json_t *rules = json_object_get(root, "rules");
    for (size_t i = 0; i < json_array_size(rules); i++)
        if (!kinds_in_points(json_array_get(rules, i)))
            return false;
    return kinds_in_points(root);
}

/* --- all ------------------------------------------------------------------------------------------------ */

/* Step i turns version i + 1 into i + 2 and returns false when memory is gone. */
typedef bool (*migration)(json_t *root);
static const migration migrations[LOOK_VERSION - 1] = {lengths_in_points};

lmn_status look_bring_forward(json_t *root, json_int_t from, lmn_error *error)
{
    for (json_int_t step = from; step < LOOK_VERSION; step++)
        if (!migrations[step - 1](root))
            return error_memory(error);
    return LMN_OK;
}
