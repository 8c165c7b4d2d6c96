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

static interpolation interpolation_of(gltf_reader *r, json_t *sampler, const char *where)
{
    const char *name = json_string_value(json_object_get(sampler, "interpolation"));
    if (name && strcmp(name, "STEP") == 0)
        return INTERPOLATION_STEP;
    if (name && strcmp(name, "CUBICSPLINE") == 0)
        return INTERPOLATION_CUBIC;
    if (name && strcmp(name, "LINEAR") != 0)
        gltf_warn(r, WARNING_BAD_VALUE, "%s: the interpolation %.40s is none of glTF's; taken as LINEAR", where, name);
    return INTERPOLATION_LINEAR;
}

static bool bad_channel(gltf_reader *r, const char *where, const char *why)
{
    if (r->status == LMN_OK)
        gltf_warn(r, WARNING_BAD_VALUE, "%s: %s; the channel was left out", where, why);
    return false;
}

/* --- keys ----------------------------------------------------------------------------------------------- */

static float *read_sampler(gltf_reader *r, json_t *sampler, const char *key, int components, const char *where,
                           size_t *count)
{
    size_t        index;
    gltf_accessor a;
    if (!gltf_index(r, sampler, key, gltf_count(r, "accessors"), "accessors", where, &index) ||
        !gltf_open_accessor(r, index, where, &a))
        return NULL;
    *count = a.count;
    return a.components == components ? gltf_read_floats(r, &a, components, where) : NULL;
}

static const char *fault_of_times(const float *times, size_t count)
{
    if (!times)
        return "no usable times";
    if (count == 0)
        return "it has no keys";
    for (size_t i = 0; i < count; i++)
        if (!isfinite(times[i]))
            return "its times are not finite";
    for (size_t i = 1; i < count; i++)
        if (times[i] < times[i - 1])
            return "its times are not in order";
    return NULL;
}

/* What a camera or light cannot be set to. Only the values at keys are asked, not the tangents of cubic ones. */
static bool is_in_range(const animation_channel *c)
{
    static const double pi = 3.14159265358979323846;
    bool                cubic = c->interpolation == INTERPOLATION_CUBIC;
    size_t              stride = c->components * (cubic ? 3 : 1), middle = cubic ? c->components : 0;
    bool                good = true;
    for (size_t i = 0; i < c->key_count; i++)
        for (size_t k = 0; k < c->components; k++) {
            double value = (double)c->values[i * stride + middle + k];
            switch (c->path) {
            case PATH_CAMERA_FOV: good = good && value > 0 && value < pi; break;
            case PATH_CAMERA_HALF_HEIGHT: good = good && value > 0; break;
            case PATH_LIGHT_COLOUR:
            case PATH_LIGHT_INTENSITY: good = good && value >= 0; break;
            default: break;
            }
        }
    return good;
}

/* As many weights as the node's mesh has morph targets; a node that is not drawn has none to move. */
static const char *fault_of_weights(const gltf_reader *r, const animation_channel *c)
{
    const node *n = &r->scene->nodes[c->target];
    if (n->mesh == NONE)
        return "its node has no mesh that is drawn";
    return r->scene->meshes[n->mesh].morph_weight_count == c->components
               ? NULL
               : "the numbers of weights and morph targets do not fit";
}

static const char *fault_of_values(const gltf_reader *r, const animation_channel *c, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(c->values[i]))
            return "values are not finite";
    if (c->path == PATH_WEIGHTS)
        return fault_of_weights(r, c);
    return is_in_range(c) ? NULL : "values are out of range";
}

/* Weights come as one number each, as many a key as the mesh has morphs. */
static bool read_values(gltf_reader *r, json_t *sampler, const char *where, animation_channel *c)
{
    static const int path_components[] = {
        [PATH_TRANSLATION] = 3, [PATH_ROTATION] = 4,           [PATH_SCALE] = 3,        [PATH_WEIGHTS] = 1,
        [PATH_CAMERA_FOV] = 1,  [PATH_CAMERA_HALF_HEIGHT] = 1, [PATH_LIGHT_COLOUR] = 3, [PATH_LIGHT_INTENSITY] = 1};
    size_t count = 0, per_key = c->interpolation == INTERPOLATION_CUBIC ? 3 : 1;
    int    components = path_components[c->path];
    c->values = read_sampler(r, sampler, "output", components, where, &count);
    if (!c->values)
        return bad_channel(r, where, "no usable output values");
    size_t keys = c->key_count * per_key;
    if (c->path == PATH_WEIGHTS ? count == 0 || count % keys != 0 : count != keys)
        return bad_channel(r, where, "the numbers of times and values do not fit");
    c->components = c->path == PATH_WEIGHTS ? count / keys : (size_t)components;
    const char *fault = fault_of_values(r, c, count * (size_t)components);
    return !fault || bad_channel(r, where, fault);
}

/* --- targets -------------------------------------------------------------------------------------------- */

static bool read_pointer(gltf_reader *r, json_t *target, const char *where, animation_channel *c)
{
    const char *pointer =
        json_string_value(json_object_get(gltf_extension(target, "KHR_animation_pointer"), "pointer"));
    if (!pointer)
        return bad_channel(r, where, "no pointer");
    gltf_pointer found = gltf_find_pointer(r, pointer, &c->path, &c->target);
    if (found != GLTF_POINTER_UNKNOWN)
        return found == GLTF_POINTER_FOUND;
    char *clean = scene_clean_name(pointer, strlen(pointer));
    if (!clean)
        return gltf_out_of_memory(r);
    gltf_warn(r, WARNING_IGNORED, "animation of %.200s", clean);
    mem_free(clean);
    return false;
}

/* False without a warning for nodes that are not in the drawn scene, and for targets of unknown extensions. */
static bool read_target(gltf_reader *r, json_t *object, const char *where, animation_channel *c)
{
    size_t      node_index;
    json_t     *target = gltf_member(r, object, "target", JSON_OBJECT, where);
    const char *name = json_string_value(json_object_get(target, "path"));
    if (name && strcmp(name, "pointer") == 0)
        return read_pointer(r, target, where, c);
    if (!gltf_index(r, target, "node", r->node_count, "nodes", where, &node_index))
        return false;
    if (!path_of(name, &c->path))
        return bad_channel(r, where, "unknown path");
    c->target = r->node_map[node_index];
    return c->target != NONE;
}

static bool read_channel(gltf_reader *r, json_t *animation_object, json_t *object, const char *where,
                         animation_channel *c)
{
    size_t  sampler_index;
    json_t *samplers = json_object_get(animation_object, "samplers");
    if (!read_target(r, object, where, c))
        return false;
    if (!gltf_index(r, object, "sampler", json_array_size(samplers), "samplers", where, &sampler_index))
        return bad_channel(r, where, "no sampler");
    json_t *sampler = json_array_get(samplers, sampler_index);
    c->interpolation = interpolation_of(r, sampler, where);
    c->times = read_sampler(r, sampler, "input", 1, where, &c->key_count);
    const char *fault = fault_of_times(c->times, c->key_count);
    return fault ? bad_channel(r, where, fault) : read_values(r, sampler, where, c);
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
        a->channels[a->channel_count++] = c;
    }
}

void gltf_read_animations(gltf_reader *r)
{
    size_t count = gltf_count(r, "animations");
    for (size_t i = 0; i < count && r->status == LMN_OK; i++)
        read_animation(r, i);
}
