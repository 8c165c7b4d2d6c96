#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "import/gltf.h"

lmn_status gltf_fail(gltf_reader *r, lmn_status status, const char *format, ...)
{
    if (r->status != LMN_OK)
        return r->status;
    char    message[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    r->status = error_in_file(r->error, status, r->job->path, 0, "%s", message);
    return r->status;
}

bool gltf_out_of_memory(gltf_reader *r)
{
    if (r->status == LMN_OK)
        r->status = error_memory(r->error);
    return false;
}

void gltf_warn(gltf_reader *r, warning_code code, const char *format, ...)
{
    char    message[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    warnings_add(&r->scene->warnings, code, "%s", message);
}

void *gltf_alloc(gltf_reader *r, size_t count, size_t size)
{
    void *block = r->status == LMN_OK ? mem_calloc(count, size) : NULL;
    if (!block)
        gltf_out_of_memory(r);
    return block;
}

size_t gltf_count(gltf_reader *r, const char *list)
{
    json_t *array = json_object_get(r->root, list);
    if (!array)
        return 0;
    if (!json_is_array(array)) {
        gltf_fail(r, LMN_FORMAT, "%s: expected an array", list);
        return 0;
    }
    return json_array_size(array);
}

json_t *gltf_item(gltf_reader *r, const char *list, size_t index)
{
    json_t *item = json_array_get(json_object_get(r->root, list), index);
    if (!json_is_object(item)) {
        gltf_fail(r, LMN_FORMAT, "%s[%zu]: expected an object", list, index);
        return NULL;
    }
    return item;
}

json_t *gltf_member(gltf_reader *r, json_t *object, const char *key, json_type type, const char *where)
{
    json_t *member = json_object_get(object, key);
    if (member && json_typeof(member) != type) {
        const char *wanted = type == JSON_ARRAY ? "an array" : type == JSON_OBJECT ? "an object" : "a string";
        gltf_fail(r, LMN_FORMAT, "%s.%s: expected %s", where, key, wanted);
        return NULL;
    }
    return member;
}

json_t *gltf_extension(json_t *object, const char *name)
{
    json_t *extension = json_object_get(json_object_get(object, "extensions"), name);
    return json_is_object(extension) ? extension : NULL;
}

/* Numbers such as 3.0 are whole numbers too. */
static bool as_size(json_t *value, size_t *out)
{
    if (json_is_integer(value) && json_integer_value(value) >= 0) {
        *out = (size_t)json_integer_value(value);
        return true;
    }
    double number = json_is_real(value) ? json_real_value(value) : -1;
    if (number >= 0 && number < 9e15 && floor(number) == number) {
        *out = (size_t)number;
        return true;
    }
    return false;
}

bool gltf_index(gltf_reader *r, json_t *object, const char *key, size_t count, const char *what, const char *where,
                size_t *out)
{
    json_t *value = json_object_get(object, key);
    if (!value || r->status != LMN_OK)
        return false;
    if (!as_size(value, out))
        gltf_fail(r, LMN_FORMAT, "%s.%s: expected an index", where, key);
    else if (*out >= count)
        gltf_fail(r, LMN_FORMAT, "%s.%s: %s[%zu] does not exist, the file has %zu", where, key, what, *out, count);
    return r->status == LMN_OK;
}

bool gltf_size(gltf_reader *r, json_t *object, const char *key, size_t otherwise, const char *where, size_t *out)
{
    json_t *value = json_object_get(object, key);
    *out = otherwise;
    if (value && !as_size(value, out))
        gltf_fail(r, LMN_FORMAT, "%s.%s: expected a whole number from 0", where, key);
    return r->status == LMN_OK;
}

double gltf_number(json_t *object, const char *key, double otherwise)
{
    json_t *value = json_object_get(object, key);
    return json_is_number(value) ? json_number_value(value) : otherwise;
}

bool gltf_true(json_t *object, const char *key)
{
    return json_is_true(json_object_get(object, key));
}

bool gltf_numbers(json_t *object, const char *key, double *out, size_t count)
{
    json_t *array = json_object_get(object, key);
    if (json_array_size(array) != count)
        return false;
    for (size_t i = 0; i < count; i++)
        if (!json_is_number(json_array_get(array, i)))
            return false;
    for (size_t i = 0; i < count; i++)
        out[i] = json_number_value(json_array_get(array, i));
    return true;
}

char *gltf_name(gltf_reader *r, json_t *object)
{
    const char *name = json_string_value(json_object_get(object, "name"));
    if (!name || !name[0])
        return NULL;
    char *copy = scene_clean_name(name, strlen(name));
    if (!copy)
        gltf_out_of_memory(r);
    return copy;
}
