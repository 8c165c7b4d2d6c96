/* A scene's memory: making, appending, freeing. */
#include "scene/scene.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "scene/behaviour.h"
#include "scene/parts.h"
#include "scene/solid.h"

/* One counter for the process: a renderer keeps GPU copies of the scene it drew last and knows it by address and
 * revision, and a new scene may lie where an old one was. */
static atomic_uint_fast64_t revisions;

animated_thing animation_thing_of(animation_path path)
{
    if (path >= PATH_LIGHT_COLOUR)
        return ANIMATED_LIGHT;
    return path >= PATH_CAMERA_FOV ? ANIMATED_CAMERA : ANIMATED_NODE;
}

uint64_t scene_next_revision(void)
{
    return atomic_fetch_add_explicit(&revisions, 1, memory_order_relaxed) + 1;
}

void parts_release(part *parts, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        mem_free(parts[i].name);
        mem_free(parts[i].path);
    }
    mem_free(parts);
}

lmn_scene *scene_new(void)
{
    lmn_scene *scene = mem_calloc(1, sizeof *scene);
    if (scene)
        scene->identity = scene_next_revision();
    return scene;
}

/* Makes room for one more zeroed element and counts it. */
static void *append(void **array, size_t *capacity, size_t *count, size_t element_size)
{
    if (*count >= INT32_MAX - 1 || !mem_grow(array, capacity, *count + 1, element_size))
        return NULL;
    void *element = (char *)*array + *count * element_size;
    memset(element, 0, element_size);
    ++*count;
    return element;
}

node *scene_append_node(lmn_scene *s)
{
    node *n = append((void **)&s->nodes, &s->node_capacity, &s->node_count, sizeof *n);
    if (!n)
        return NULL;
    n->parent = n->first_child = n->last_child = n->next_sibling = NONE;
    n->mesh = n->skin = n->camera = n->light = n->solid = NONE;
    return n;
}

mesh *scene_append_mesh(lmn_scene *s)
{
    return append((void **)&s->meshes, &s->mesh_capacity, &s->mesh_count, sizeof *s->meshes);
}

material *scene_append_material(lmn_scene *s)
{
    material *m = append((void **)&s->materials, &s->material_capacity, &s->material_count, sizeof *m);
    if (!m)
        return NULL;
    m->base_colour = (vec4){1, 1, 1, 1};
    m->base_texture = m->normal_texture = (texture_use)TEXTURE_USE_NONE;
    m->normal_scale = 1;
    m->alpha_cutoff = 0.5f;
    return m;
}

image *scene_append_image(lmn_scene *s)
{
    return append((void **)&s->images, &s->image_capacity, &s->image_count, sizeof *s->images);
}

camera *scene_append_camera(lmn_scene *s)
{
    return append((void **)&s->cameras, &s->camera_capacity, &s->camera_count, sizeof *s->cameras);
}

light *scene_append_light(lmn_scene *s)
{
    light *l = append((void **)&s->lights, &s->light_capacity, &s->light_count, sizeof *l);
    if (!l)
        return NULL;
    l->colour[0] = l->colour[1] = l->colour[2] = l->intensity = 1;
    l->outer_cone = 0.78539816f;
    return l;
}

skin *scene_append_skin(lmn_scene *s)
{
    return append((void **)&s->skins, &s->skin_capacity, &s->skin_count, sizeof *s->skins);
}

solid *scene_append_ghost(lmn_scene *s)
{
    solid *made = append((void **)&s->solids, &s->solid_capacity, &s->solid_count, sizeof *made);
    if (!made)
        return NULL;
    made->ghost = true;
    if (solid_append(made, NONE, SOLID_UNION) == 0)
        return made;
    solid_release(made);
    s->solid_count--;
    return NULL;
}

solid *scene_append_solid(lmn_scene *s, solid_kind root)
{
    /* With room for a companion of each, so that no edit moves solids. */
    if (!mem_grow((void **)&s->solids, &s->solid_capacity, 2 * (s->solid_count + 1), sizeof *s->solids))
        return NULL;
    solid *made = scene_append_ghost(s);
    if (made) {
        made->ghost = false;
        made->nodes[0].kind = root;
    }
    return made;
}

animation *scene_append_animation(lmn_scene *s)
{
    return append((void **)&s->animations, &s->animation_capacity, &s->animation_count, sizeof *s->animations);
}

void scene_link_child(lmn_scene *s, int32_t parent, int32_t child)
{
    s->nodes[child].parent = parent;
    if (parent == NONE)
        return;
    node *p = &s->nodes[parent];
    if (p->last_child == NONE)
        p->first_child = child;
    else
        s->nodes[p->last_child].next_sibling = child;
    p->last_child = child;
}

void primitive_release(primitive *p)
{
    mem_free(p->positions);
    mem_free(p->normals);
    mem_free(p->straight);
    for (int i = 0; i < UV_SETS; i++)
        mem_free(p->uvs[i]);
    mem_free(p->colours);
    mem_free(p->joints);
    mem_free(p->weights);
    mem_free(p->indices);
    mem_free(p->lines);
    for (size_t i = 0; i < p->morph_count; i++) {
        mem_free(p->morphs[i].positions);
        mem_free(p->morphs[i].normals);
    }
    mem_free(p->morphs);
    mem_free(p->edges.values);
    memset(p, 0, sizeof *p);
}

void mesh_release(mesh *m)
{
    mem_free(m->name);
    for (size_t i = 0; i < m->primitive_count; i++)
        primitive_release(&m->primitives[i]);
    mem_free(m->primitives);
    mem_free(m->morph_weights);
    memset(m, 0, sizeof *m);
}

bool mesh_set_primitives(mesh *m, const primitive *primitives, size_t count)
{
    m->primitives = mem_copy(primitives, count * sizeof *primitives);
    if (!m->primitives)
        return false;
    m->primitive_count = count;
    return true;
}

bool attribute_make_sized(attribute *out, const char *key, size_t key_size, const char *value, size_t value_size)
{
    out->key = mem_alloc(key_size + value_size + 2);
    out->value = out->key ? out->key + key_size + 1 : NULL;
    if (!out->key)
        return false;
    memcpy(out->key, key, key_size);
    memcpy(out->value, value, value_size);
    out->key[key_size] = out->value[value_size] = '\0';
    return true;
}

bool attribute_make(attribute *out, const char *key, const char *value)
{
    return attribute_make_sized(out, key, strlen(key), value, strlen(value));
}

void attribute_release(attribute *a)
{
    mem_free(a->key);
}

bool node_own_facts(node *n)
{
    if (!n->lent)
        return true;
    char      *name = mem_copy_text(n->name);
    attribute *own = mem_calloc(n->attribute_count, sizeof *own);
    bool       good = own && (name || !n->name);
    for (size_t i = 0; i < n->attribute_count && good; i++)
        good = attribute_make(&own[i], n->attributes[i].key, n->attributes[i].value);
    if (good) {
        n->name = name;
        n->attributes = own;
        n->lent = false;
        return true;
    }
    for (size_t i = 0; own && i < n->attribute_count; i++)
        attribute_release(&own[i]);
    mem_free(own);
    mem_free(name);
    return false;
}

static void node_release(node *n)
{
    mem_free(n->place);
    mem_free(n->instances);
    mem_free(n->morph_weights);
    if (n->lent)
        return;
    mem_free(n->name);
    for (size_t i = 0; i < n->attribute_count; i++)
        attribute_release(&n->attributes[i]);
    mem_free(n->attributes);
}

static void animation_release(animation *a)
{
    mem_free(a->name);
    for (size_t i = 0; i < a->channel_count; i++) {
        mem_free(a->channels[i].times);
        mem_free(a->channels[i].values);
    }
    mem_free(a->channels);
}

static void release_drawables(lmn_scene *s)
{
    for (size_t i = 0; i < s->node_count; i++)
        node_release(&s->nodes[i]);
    for (size_t i = 0; i < s->mesh_count; i++)
        mesh_release(&s->meshes[i]);
    for (size_t i = 0; i < s->solid_count; i++)
        solid_release(&s->solids[i]);
    parts_release(s->parts, s->part_count + s->ghost_count);
    mem_free(s->nodes);
    mem_free(s->meshes);
    mem_free(s->solids);
}

static void release_appearance(lmn_scene *s)
{
    for (size_t i = 0; i < s->material_count; i++)
        mem_free(s->materials[i].name);
    for (size_t i = 0; i < s->image_count; i++) {
        mem_free(s->images[i].name);
        mem_free(s->images[i].pixels);
        mem_free(s->images[i].strokes);
    }
    for (size_t i = 0; i < s->camera_count; i++)
        mem_free(s->cameras[i].name);
    for (size_t i = 0; i < s->light_count; i++)
        mem_free(s->lights[i].name);
    mem_free(s->materials);
    mem_free(s->images);
    mem_free(s->cameras);
    mem_free(s->lights);
}

void scene_remove_animation(lmn_scene *s, size_t index)
{
    animation_release(&s->animations[index]);
    memmove(&s->animations[index], &s->animations[index + 1], (s->animation_count - index - 1) * sizeof *s->animations);
    s->animation_count--;
}

void scene_free(lmn_scene *s)
{
    if (!s)
        return;
    release_drawables(s);
    release_appearance(s);
    for (size_t i = 0; i < s->skin_count; i++) {
        mem_free(s->skins[i].name);
        mem_free(s->skins[i].joints);
        mem_free(s->skins[i].inverse_binds);
    }
    mem_free(s->skins);
    for (size_t i = 0; i < s->animation_count; i++)
        animation_release(&s->animations[i]);
    mem_free(s->animations);
    behaviour_free(s->behaviour);
    letterings_release(&s->letterings);
    city_release(&s->city);
    for (size_t i = 0; i < s->file_count; i++)
        mem_free(s->files[i]);
    mem_free(s->files);
    warnings_release(&s->warnings);
    mem_free(s);
}

/* The length of the valid UTF-8 character at `p`, 0 when there is none. */
static size_t character_length(const char *p, size_t left)
{
    for (size_t length = 1; length <= 4 && length <= left; length++)
        if (text_is_utf8(p, length))
            return length;
    return 0;
}

/* As most names are: nothing in them has to be looked at twice. */
static bool is_plain(const char *bytes, size_t size)
{
    bool plain = true;
    for (size_t i = 0; i < size; i++)
        plain &= (unsigned char)bytes[i] - 0x20u < 0x5Fu;
    return plain;
}

char *scene_clean_name(const char *bytes, size_t size)
{
    text  t = {0};
    char *copy = NULL;
    if (is_plain(bytes, size)) {
        copy = mem_alloc(size + 1);
        if (copy && size)
            memcpy(copy, bytes, size);
        if (copy)
            copy[size] = '\0';
        return copy;
    }
    for (size_t i = 0; i < size;) {
        size_t length = character_length(bytes + i, size - i);
        bool   control = length == 1 && ((unsigned char)bytes[i] < 0x20 || bytes[i] == 0x7F);
        if (length == 0 || control)
            text_append_bytes(&t, "\xEF\xBF\xBD", 3);
        else
            text_append_bytes(&t, bytes + i, length);
        i += length ? length : 1;
    }
    return text_take(&t);
}

char *scene_name_of_file(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    size_t      length = dot && dot != name ? (size_t)(dot - name) : strlen(name);
    return length ? scene_clean_name(name, length) : mem_copy_text("model");
}

static const char *find_attribute(const node *n, const char *key)
{
    for (size_t i = 0; i < n->attribute_count; i++)
        if (strcmp(n->attributes[i].key, key) == 0)
            return n->attributes[i].value;
    return NULL;
}

static bool has_attribute(const node *n, const char *key)
{
    return find_attribute(n, key) != NULL;
}

bool node_tint(const node *n, colour *out)
{
    const char *value = find_attribute(n, NODE_TINT);
    return value && colour_parse(value, out);
}

int node_paleness(const node *n)
{
    const char *value = find_attribute(n, NODE_PALE);
    return value && value[0] >= '1' && value[0] <= '0' + PALE_MOST && !value[1] ? value[0] - '0' : 0;
}

bool node_is_overlay(const node *n)
{
    return has_attribute(n, NODE_OVERLAY);
}

box3 scene_fitted_box(const lmn_scene *scene, size_t part_index, box3 box)
{
    const double small = 0.5;
    if (!scene->staged || has_attribute(&scene->nodes[scene->parts[part_index].node], NODE_GLYPH))
        return box;
    const box3 within = box3_intersection(box, scene->stage);
    if (!box3_is_empty(within) && box3_diagonal(box) <= small * box3_diagonal(scene->stage))
        return box;
    return within;
}

bool node_throws_shadow(const node *n)
{
    return !has_attribute(n, NODE_SHADOWLESS);
}

uint32_t node_image(const node *n)
{
    const char *value = find_attribute(n, NODE_SHADOWLESS);
    return value ? (uint32_t)strtoul(value, NULL, 10) : 0;
}

size_t node_draw_count(const node *n)
{
    return n->instance_count ? n->instance_count : 1;
}

const char *scene_camera_name(const lmn_scene *scene, size_t index, const char *node_name,
                              char numbered[CAMERA_NAME_CAPACITY])
{
    if (scene->cameras[index].name)
        return scene->cameras[index].name;
    if (node_name)
        return node_name;
    snprintf(numbered, CAMERA_NAME_CAPACITY, "camera-%zu", index + 1);
    return numbered;
}
