/* Looks: checks arguments and forwards. */
#include "limner/look.h"

#include <string.h>

#include "base/embedded.h"
#include "base/error.h"
#include "look/look.h"

static lmn_status missing(const char *what, lmn_error *error)
{
    return error_set(error, LMN_USAGE, "%s is NULL", what);
}

lmn_status lmn_look_load(lmn_look **out, const char *name_or_path, lmn_error *error)
{
    if (!out || !name_or_path)
        return missing(out ? "name_or_path" : "out", error);
    return look_load(out, name_or_path, NULL, error);
}

lmn_status lmn_look_parse(lmn_look **out, const char *json, const char *name, lmn_error *error)
{
    if (!out || !json)
        return missing(out ? "json" : "out", error);
    return look_parse(out, json, strlen(json), name ? name : "look", NULL, error);
}

void lmn_look_destroy(lmn_look **look)
{
    look_destroy(look);
}

lmn_status lmn_look_set(lmn_look *look, const char *key, const char *value, lmn_error *error)
{
    if (!look || !key || !value)
        return missing(!look ? "look" : !key ? "key" : "value", error);
    return look_set(look, key, value, error);
}

char *lmn_look_json(const lmn_look *look)
{
    return look ? look_json(look) : NULL;
}

const char *lmn_look_name(const lmn_look *look)
{
    return look ? look->name : NULL;
}

size_t lmn_look_count(void)
{
    return embedded_looks_count;
}

const char *lmn_look_name_at(size_t index)
{
    return look_name_at(index);
}

lmn_status lmn_look_reference_json(char **out, const char *name_or_path, lmn_error *error)
{
    if (!out)
        return missing("out", error);
    return look_reference_json(out, name_or_path, error);
}
