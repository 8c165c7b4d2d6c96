/* Animations: all paths and interpolations. A channel that is not right is left out with a warning. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "import/gltf.h"

static bool path_of(const char *name, animation_path *out)
{
    static const char *const names[] = {"translation", "rotation", "scale", "weights"};
    for (int i = 0; name && i < 4; i++)
        if (strcmp(name, names[i]) == 0) {
            *out = (animation_path)i;
            return true;
        }
    return false;
}

static interpolation interpolation_of(json_t *sampler)
{
    const char *name = json_string_value(json_object_get(sampler, "interpolation"));
    if (name && strcmp(name, "STEP") == 0)
        return INTERPOLATION_STEP;
    return name && strcmp(name, "CUBICSPLINE") == 0 ? INTERPOLATION_CUBIC : INTERPOLATION_LINEAR;
}

static bool bad_channel(gltf_reader *r, const char *where, const char *why)
{
    if (r->status == LMN_OK)
        gltf_warn(r, WARNING_BAD_VALUE, "%s: %s; the channel was left out", where, why);
    return false;
}

static float *read_sampler(gltf_reader *r, json_t *sampler, const char *key, int components, const char *where,
                           size_t *count, int *own_components)
{
    size_t        index;
    gltf_accessor a;
    if (!gltf_index(r, sampler, key, gltf_count(r, "accessors"), "accessors", where, &index) ||
        !gltf_open_accessor(r, index, where, &a))
        return NULL;
    *count = a.count;
    *own_components = a.components;
    return a.components == components ? gltf_read_floats(r, &a, components, where) : NULL;
}

static bool times_are_good(const float *times, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(times[i]) || (i > 0 && times[i] < times[i - 1]))
            return false;
    return count > 0;
}

static bool values_are_finite(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return false;
    return true;
}

/* Weights come as one number each, as many a key as the mesh has morphs. */
static bool read_values(gltf_reader *r, json_t *sampler, const char *where, animation_channel *c)
{
    static const int path_components[] = {3, 4, 3, 1};
    size_t           count = 0, per_key = c->interpolation == INTERPOLATION_CUBIC ? 3 : 1;
    int              components = path_components[c->path], own = 0;
    c->values = read_sampler(r, sampler, "output", components, where, &count, &own);
    if (!c->values)
        return bad_channel(r, where, "no usable output values");
    size_t keys = c->key_count * per_key;
    if (c->path == PATH_WEIGHTS ? count == 0 || count % keys != 0 : count != keys)
        return bad_channel(r, where, "the numbers of times and values do not fit");
    c->components = c->path == PATH_WEIGHTS ? count / keys : (size_t)components;
    return values_are_finite(c->values, count * (size_t)components) || bad_channel(r, where, "values are not finite");
}

static bool read_channel(gltf_reader *r, json_t *animation_object, json_t *object, const char *where,
                         animation_channel *c)
{
    size_t  node_index, sampler_index;
    int     own;
    json_t *target = gltf_member(r, object, "target", JSON_OBJECT, where);
    json_t *samplers = json_object_get(animation_object, "samplers");
    /* A target without a node is for extensions. */
    if (!gltf_index(r, target, "node", r->node_count, "nodes", where, &node_index))
        return false;
    if (!path_of(json_string_value(json_object_get(target, "path")), &c->path))
        return bad_channel(r, where, "unknown path");
    c->target = r->node_map[node_index];
    if (c->target == NONE)
        return false;
    if (!gltf_index(r, object, "sampler", json_array_size(samplers), "samplers", where, &sampler_index))
        return bad_channel(r, where, "no sampler");
    json_t *sampler = json_array_get(samplers, sampler_index);
    c->interpolation = interpolation_of(sampler);
    c->times = read_sampler(r, sampler, "input", 1, where, &c->key_count, &own);
    if (!c->times || !times_are_good(c->times, c->key_count))
        return bad_channel(r, where, "its times are missing, not finite or not in order");
    return read_values(r, sampler, where, c);
}

static void read_animation(gltf_reader *r, size_t index)
{
    char    where[GLTF_WHERE];
    json_t *object = gltf_item(r, "animations", index);
    snprintf(where, sizeof where, "animations[%zu]", index);
    json_t    *channels = object ? gltf_member(r, object, "channels", JSON_ARRAY, where) : NULL;
    animation *a = r->status == LMN_OK ? scene_append_animation(r->scene) : NULL;
    if (!a) {
        gltf_out_of_memory(r);
        return;
    }
    a->name = gltf_name(r, object);
    size_t count = json_array_size(channels);
    a->channels = gltf_alloc(r, count, sizeof *a->channels);
    for (size_t i = 0; i < count && r->status == LMN_OK; i++) {
        animation_channel c = {.target = NONE};
        snprintf(where, sizeof where, "animations[%zu].channels[%zu]", index, i);
        if (!read_channel(r, object, json_array_get(channels, i), where, &c)) {
            mem_free(c.times);
            mem_free(c.values);
            continue;
        }
        if (c.times[c.key_count - 1] > a->duration)
            a->duration = c.times[c.key_count - 1];
        a->channels[a->channel_count++] = c;
    }
}

void gltf_read_animations(gltf_reader *r)
{
    size_t count = gltf_count(r, "animations");
    for (size_t i = 0; i < count && r->status == LMN_OK; i++)
        read_animation(r, i);
}
