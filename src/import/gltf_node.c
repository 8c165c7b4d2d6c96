/* The node tree, with instancing, cameras, lights, skins and extras. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "import/build.h"
#include "import/gltf.h"

/* --- what nodes carry ----------------------------------------------------------------------------------- */

static bool read_transform(json_t *object, node *n)
{
    mat4        matrix;
    node_place *own = node_own_place(n);
    if (!own)
        return false;
    if (gltf_numbers(object, "matrix", matrix.m, 16))
        return node_set_matrix(n, &matrix);
    gltf_numbers(object, "translation", own->translation, 3);
    gltf_numbers(object, "rotation", own->rotation, 4);
    gltf_numbers(object, "scale", own->scale, 3);
    return true;
}

/* Scalars as text; lists and objects as compact JSON. */
static void read_extras(gltf_reader *r, json_t *object, node *n)
{
    const char *key;
    json_t     *value;
    json_t     *extras = json_object_get(object, "extras");
    if (!json_is_object(extras))
        return;
    json_object_foreach(extras, key, value)
    {
        char *dumped =
            json_is_string(value) ? NULL : json_dumps(value, JSON_COMPACT | JSON_ENCODE_ANY | JSON_REAL_PRECISION(9));
        const char *text = json_is_string(value) ? json_string_value(value) : dumped;
        bool        good = !text || build_attribute(n, key, text);
        free(dumped);
        if (!good) {
            gltf_out_of_memory(r);
            return;
        }
    }
}

static float *read_instance_values(gltf_reader *r, json_t *attributes, const char *name, int components, size_t *count)
{
    size_t        index;
    gltf_accessor a;
    if (!gltf_index(r, attributes, name, gltf_count(r, "accessors"), "accessors", "EXT_mesh_gpu_instancing", &index) ||
        !gltf_open_accessor(r, index, name, &a))
        return NULL;
    if (*count != SIZE_MAX && a.count != *count) {
        gltf_fail(r, LMN_FORMAT, "EXT_mesh_gpu_instancing.%s: %zu values where others have %zu", name, a.count, *count);
        return NULL;
    }
    *count = a.count;
    if (a.count > LIMIT_INSTANCES) {
        gltf_fail(r, LMN_LIMIT, "EXT_mesh_gpu_instancing: %zu instances, allowed are %zu", a.count, LIMIT_INSTANCES);
        return NULL;
    }
    return gltf_read_floats(r, &a, components, name);
}

static void read_instances(gltf_reader *r, json_t *object, node *n)
{
    json_t *attributes = json_object_get(gltf_extension(object, "EXT_mesh_gpu_instancing"), "attributes");
    size_t  count = SIZE_MAX;
    if (!attributes)
        return;
    float *t = read_instance_values(r, attributes, "TRANSLATION", 3, &count);
    float *q = read_instance_values(r, attributes, "ROTATION", 4, &count);
    float *s = read_instance_values(r, attributes, "SCALE", 3, &count);
    if (t || q || s)
        r->instances += count;
    if (r->instances > LIMIT_INSTANCES)
        gltf_fail(r, LMN_LIMIT, "EXT_mesh_gpu_instancing: more than %zu instances in all", LIMIT_INSTANCES);
    if (r->status == LMN_OK && (t || q || s) && count > 0)
        n->instances = gltf_alloc(r, count, sizeof *n->instances);
    for (size_t i = 0; n->instances && i < count; i++) {
        double translation[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
        for (int k = 0; k < 4; k++) {
            if (k < 3 && t)
                translation[k] = t[3 * i + (size_t)k];
            if (k < 3 && s)
                scale[k] = s[3 * i + (size_t)k];
            if (q)
                rotation[k] = q[4 * i + (size_t)k];
        }
        n->instances[i] = mat4_from_trs(translation, rotation, scale);
    }
    n->instance_count = n->instances ? (uint32_t)count : 0;
    mem_free(t);
    mem_free(q);
    mem_free(s);
}

static void read_weights(gltf_reader *r, json_t *object, node *n)
{
    json_t *weights = json_object_get(object, "weights");
    size_t  count = json_array_size(weights);
    if (count == 0)
        return;
    n->morph_weights = gltf_alloc(r, count, sizeof *n->morph_weights);
    for (size_t i = 0; n->morph_weights && i < count; i++)
        n->morph_weights[i] = (float)json_number_value(json_array_get(weights, i));
    n->morph_weight_count = n->morph_weights ? (uint32_t)count : 0;
}

/* Everything of node `index` but its position in the tree. `drawn`: it belongs to the scene and is not hidden. */
static void fill_node(gltf_reader *r, json_t *object, size_t index, int32_t at, bool drawn)
{
    char    where[GLTF_WHERE];
    size_t  value;
    int32_t mesh_index = NONE;
    snprintf(where, sizeof where, "nodes[%zu]", index);
    node *n = &r->scene->nodes[at];
    n->name = gltf_name(r, object);
    if (!read_transform(object, n))
        gltf_out_of_memory(r);
    read_extras(r, object, n);
    read_weights(r, object, n);
    if (!drawn)
        return;
    if (gltf_index(r, object, "camera", gltf_count(r, "cameras"), "cameras", where, &value))
        n->camera = (int32_t)value;
    json_t *lights = json_object_get(gltf_extension(r->root, "KHR_lights_punctual"), "lights");
    if (gltf_index(r, gltf_extension(object, "KHR_lights_punctual"), "light", json_array_size(lights), "lights", where,
                   &value))
        n->light = (int32_t)value;
    if (gltf_index(r, object, "mesh", r->mesh_count, "meshes", where, &value))
        mesh_index = gltf_get_mesh(r, value);
    if (mesh_index == NONE)
        return;
    n->mesh = mesh_index;
    if (gltf_index(r, object, "skin", gltf_count(r, "skins"), "skins", where, &value))
        n->skin = (int32_t)value;
    read_instances(r, object, n);
}

/* --- the tree ------------------------------------------------------------------------------------------- */

/* A node to visit, and below which one of the scene's it goes. */
typedef struct visit {
    size_t  index;
    int32_t parent;
    int     depth;
    bool    drawn;
} visit;

typedef struct visits {
    visit *items;
    size_t count, capacity;
} visits;

static void push(gltf_reader *r, visits *stack, visit v)
{
    if (!mem_grow((void **)&stack->items, &stack->capacity, stack->count + 1, sizeof v))
        gltf_out_of_memory(r);
    else
        stack->items[stack->count++] = v;
}

/* In reverse, so that the first child is taken from the stack first. */
static void push_children(gltf_reader *r, visits *stack, json_t *object, const visit *v, int32_t parent, bool drawn)
{
    char where[GLTF_WHERE];
    snprintf(where, sizeof where, "nodes[%zu]", v->index);
    json_t *children = gltf_member(r, object, "children", JSON_ARRAY, where);
    for (size_t i = json_array_size(children); i-- > 0 && r->status == LMN_OK;) {
        json_t *child = json_array_get(children, i);
        double  number = json_is_number(child) ? json_number_value(child) : -1;
        if (!(number >= 0 && number < (double)r->node_count)) {
            gltf_fail(r, LMN_FORMAT, "%s.children[%zu]: there is no such node, the file has %zu", where, i,
                      r->node_count);
            return;
        }
        push(r, stack, (visit){(size_t)number, parent, v->depth + 1, drawn});
    }
}

static void visit_node(gltf_reader *r, visits *stack, visit v)
{
    json_t *object = gltf_item(r, "nodes", v.index);
    if (!object)
        return;
    if (v.depth > LIMIT_NODE_DEPTH) {
        gltf_fail(r, LMN_LIMIT, "nodes[%zu]: the tree is deeper than %d", v.index, LIMIT_NODE_DEPTH);
        return;
    }
    if (r->node_map[v.index] != NONE) {
        gltf_fail(r, LMN_FORMAT, "nodes[%zu] is its own ancestor or is used twice in the tree", v.index);
        return;
    }
    if (!scene_append_node(r->scene)) {
        gltf_out_of_memory(r);
        return;
    }
    int32_t at = (int32_t)r->scene->node_count - 1;
    r->node_map[v.index] = at;
    scene_link_child(r->scene, v.parent, at);
    json_t *visible = json_object_get(gltf_extension(object, "KHR_node_visibility"), "visible");
    bool    drawn = v.drawn && !json_is_false(visible);
    fill_node(r, object, v.index, at, drawn);
    push_children(r, stack, object, &v, at, drawn);
}

static void visit_tree(gltf_reader *r, size_t root, bool drawn)
{
    visits stack = {0};
    push(r, &stack, (visit){root, NONE, 1, drawn});
    while (stack.count > 0 && r->status == LMN_OK)
        visit_node(r, &stack, stack.items[--stack.count]);
    mem_free(stack.items);
}

/* Marks every node that some node lists as its child. */
static bool *find_children(gltf_reader *r)
{
    bool *is_child = gltf_alloc(r, r->node_count, sizeof *is_child);
    for (size_t i = 0; is_child && i < r->node_count; i++) {
        json_t *children = json_object_get(json_array_get(json_object_get(r->root, "nodes"), i), "children");
        for (size_t k = 0; k < json_array_size(children); k++) {
            double number = json_number_value(json_array_get(children, k));
            if (number >= 0 && number < (double)r->node_count)
                is_child[(size_t)number] = true;
        }
    }
    return is_child;
}

/* Visits the trees that were not reached yet. */
static void visit_rest(gltf_reader *r, bool drawn)
{
    bool *is_child = find_children(r);
    for (size_t i = 0; is_child && i < r->node_count && r->status == LMN_OK; i++)
        if (!is_child[i] && r->node_map[i] == NONE)
            visit_tree(r, i, drawn);
    for (size_t i = 0; drawn && r->status == LMN_OK && i < r->node_count; i++)
        if (r->node_map[i] == NONE)
            gltf_fail(r, LMN_FORMAT, "nodes[%zu] is its own ancestor", i);
    mem_free(is_child);
}

static bool skins_are_complete(gltf_reader *r)
{
    json_t *item, *joint;
    size_t  i, k;
    json_array_foreach(json_object_get(r->root, "skins"), i, item)
    {
        json_array_foreach(json_object_get(item, "joints"), k, joint)
        {
            double number = json_number_value(joint);
            if (number >= 0 && number < (double)r->node_count && r->node_map[(size_t)number] == NONE)
                return false;
        }
    }
    return true;
}

static void visit_scene(gltf_reader *r, size_t index)
{
    char    where[GLTF_WHERE];
    json_t *object = gltf_item(r, "scenes", index);
    snprintf(where, sizeof where, "scenes[%zu]", index);
    json_t *roots = object ? gltf_member(r, object, "nodes", JSON_ARRAY, where) : NULL;
    for (size_t i = 0; i < json_array_size(roots) && r->status == LMN_OK; i++) {
        json_t *root = json_array_get(roots, i);
        double  number = json_is_number(root) ? json_number_value(root) : -1;
        if (!(number >= 0 && number < (double)r->node_count))
            gltf_fail(r, LMN_FORMAT, "%s.nodes[%zu]: there is no such node, the file has %zu", where, i, r->node_count);
        else
            visit_tree(r, (size_t)number, true);
    }
}

void gltf_read_nodes(gltf_reader *r)
{
    size_t scenes = gltf_count(r, "scenes"), index = 0;
    gltf_index(r, r->root, "scene", scenes, "scenes", "glTF", &index);
    if (r->status != LMN_OK)
        return;
    if (scenes == 0) {
        visit_rest(r, true);
        return;
    }
    visit_scene(r, index);
    if (scenes > 1)
        gltf_warn(r, WARNING_IGNORED, "%zu further scenes of the file", scenes - 1);
    /* Joints may hang outside the scene that is drawn. */
    if (r->status == LMN_OK && !skins_are_complete(r))
        visit_rest(r, false);
}

/* --- cameras, lights, skins ----------------------------------------------------------------------------- */

static void read_camera(gltf_reader *r, size_t index)
{
    json_t *object = gltf_item(r, "cameras", index);
    if (!object)
        return;
    camera *c = scene_append_camera(r->scene);
    if (!c) {
        gltf_out_of_memory(r);
        return;
    }
    c->name = gltf_name(r, object);
    const char *type = json_string_value(json_object_get(object, "type"));
    c->orthographic = type && strcmp(type, "orthographic") == 0;
    json_t *values = json_object_get(object, c->orthographic ? "orthographic" : "perspective");
    c->fov_y = gltf_number(values, "yfov", 0.5);
    c->half_height = gltf_number(values, "ymag", 1);
    c->near = gltf_number(values, "znear", 0.01);
    c->far = gltf_number(values, "zfar", 0);
}

void gltf_read_cameras(gltf_reader *r)
{
    size_t count = gltf_count(r, "cameras");
    for (size_t i = 0; i < count && r->status == LMN_OK; i++)
        read_camera(r, i);
}

void gltf_read_lights(gltf_reader *r)
{
    json_t *object;
    size_t  i;
    json_array_foreach(json_object_get(gltf_extension(r->root, "KHR_lights_punctual"), "lights"), i, object)
    {
        light *l = scene_append_light(r->scene);
        double colour[3];
        if (!l) {
            gltf_out_of_memory(r);
            return;
        }
        l->name = gltf_name(r, object);
        const char *type = json_string_value(json_object_get(object, "type"));
        l->type = type && strcmp(type, "point") == 0  ? LIGHT_POINT
                  : type && strcmp(type, "spot") == 0 ? LIGHT_SPOT
                                                      : LIGHT_DIRECTIONAL;
        if (gltf_numbers(object, "color", colour, 3))
            for (int k = 0; k < 3; k++)
                l->colour[k] = (float)colour[k];
        l->intensity = (float)gltf_number(object, "intensity", 1);
        l->range = (float)gltf_number(object, "range", 0);
        json_t *spot = json_object_get(object, "spot");
        l->inner_cone = (float)gltf_number(spot, "innerConeAngle", 0);
        l->outer_cone = (float)gltf_number(spot, "outerConeAngle", 0.78539816339744831);
    }
}

static bool is_all_zeros(const mat4 *m)
{
    bool zeros = true;
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            zeros = zeros && m->m[4 * column + row] == 0;
    return zeros;
}

/* What follows a joint with such a matrix is drawn flat, as the file says it; of zeros nothing would be left, so that
 * vertices stay where the mesh has them when nothing has moved. */
static void mend_flat_binds(gltf_reader *r, const char *where, skin *s)
{
    size_t flat = 0, zeros = 0, first = 0;
    for (size_t i = 0; i < s->joint_count; i++) {
        if (!mat4_is_flat(&s->inverse_binds[i]))
            continue;
        mat4 world = scene_world_matrix(r->scene, s->joints[i]);
        first = flat == 0 ? i : first;
        flat++;
        if (!is_all_zeros(&s->inverse_binds[i]) || mat4_is_flat(&world))
            continue;
        s->inverse_binds[i] = mat4_inverse(&world);
        zeros++;
    }
    if (!flat)
        return;
    const char *joint = r->scene->nodes[s->joints[first]].name;
    char        replaced[96] = "";
    if (zeros)
        snprintf(replaced, sizeof replaced, "; %zu of them are all zeros and were made anew from the joints at rest",
                 zeros);
    gltf_warn(r, WARNING_BAD_VALUE,
              "%s.inverseBindMatrices: %zu of %zu matrices are flat, the first one that of joint '%.100s'%s", where,
              flat, s->joint_count, joint ? joint : "", replaced);
}

static void read_bind_matrices(gltf_reader *r, json_t *object, const char *where, skin *s)
{
    size_t        index;
    gltf_accessor a;
    for (size_t i = 0; i < s->joint_count; i++)
        s->inverse_binds[i] = mat4_identity();
    if (!gltf_index(r, object, "inverseBindMatrices", gltf_count(r, "accessors"), "accessors", where, &index) ||
        !gltf_open_accessor(r, index, where, &a))
        return;
    if (a.count < s->joint_count || a.components != 16) {
        gltf_fail(r, LMN_FORMAT, "%s.inverseBindMatrices: %zu matrices for %zu joints", where, a.count, s->joint_count);
        return;
    }
    float *values = gltf_read_floats(r, &a, 16, where);
    size_t lost = 0;
    for (size_t i = 0; values && i < s->joint_count * 16; i++) {
        bool good = isfinite(values[i]);
        lost += !good;
        s->inverse_binds[i / 16].m[i % 16] = good ? values[i] : 0;
    }
    if (lost)
        gltf_warn(r, WARNING_BAD_VALUE, "%s.inverseBindMatrices: %zu values that are not finite became 0", where, lost);
    if (values)
        mend_flat_binds(r, where, s);
    mem_free(values);
}

static void read_skin(gltf_reader *r, size_t index)
{
    char    where[GLTF_WHERE];
    json_t *object = gltf_item(r, "skins", index);
    snprintf(where, sizeof where, "skins[%zu]", index);
    json_t *joints = object ? gltf_member(r, object, "joints", JSON_ARRAY, where) : NULL;
    size_t  count = json_array_size(joints);
    if (count == 0)
        gltf_fail(r, LMN_FORMAT, "%s: no joints", where);
    skin *s = r->status == LMN_OK ? scene_append_skin(r->scene) : NULL;
    if (!s) {
        gltf_out_of_memory(r);
        return;
    }
    s->name = gltf_name(r, object);
    s->joints = gltf_alloc(r, count, sizeof *s->joints);
    s->inverse_binds = gltf_alloc(r, count, sizeof *s->inverse_binds);
    if (!s->joints || !s->inverse_binds)
        return;
    s->joint_count = count;
    for (size_t i = 0; i < count; i++) {
        double number = json_is_number(json_array_get(joints, i)) ? json_number_value(json_array_get(joints, i)) : -1;
        bool   good = number >= 0 && number < (double)r->node_count;
        s->joints[i] = good ? r->node_map[(size_t)number] : NONE;
        if (s->joints[i] == NONE) {
            gltf_fail(r, LMN_FORMAT, "%s.joints[%zu]: there is no such node, the file has %zu", where, i,
                      r->node_count);
            return;
        }
    }
    read_bind_matrices(r, object, where, s);
}

void gltf_read_skins(gltf_reader *r)
{
    size_t count = gltf_count(r, "skins");
    for (size_t i = 0; i < count && r->status == LMN_OK; i++)
        read_skin(r, i);
}
