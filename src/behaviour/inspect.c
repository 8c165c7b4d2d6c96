#include "behaviour/inspect.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

bool span_meets(const behaviour_span *s, double from, double to)
{
    bool begins = s->open_from ? to > s->from : to >= s->from, ends = s->open_to ? from < s->to : from <= s->to;
    return begins && ends;
}

/* Does the property belong to a node, or to the camera or light that it has? */
static bool belongs(const lmn_scene *scene, const behaviour_property *p, int32_t index)
{
    const node *n = &scene->nodes[index];
    switch (animation_thing_of(p->path)) {
    case ANIMATED_CAMERA: return n->camera == p->target;
    case ANIMATED_LIGHT: return n->light == p->target;
    default: return p->target == index;
    }
}

static bool concerns(const schedule *s, const behaviour_span *span, const dynamics *d)
{
    for (size_t i = 0; i < d->path_count; i++)
        if (span->property == NONE ? s->nodes[span->node].target == d->path[i]
                                   : belongs(s->scene, &s->properties[span->property], d->path[i]))
            return true;
    return false;
}

lmn_status dynamics_create(dynamics *out, const schedule *s, int32_t node_index, double from, double to,
                           lmn_error *error)
{
    size_t depth = 0, capacity = 0;
    *out = (dynamics){.path = NULL};
    for (int32_t at = node_index; at != NONE; at = s->scene->nodes[at].parent)
        depth++;
    out->path = mem_calloc(depth, sizeof *out->path);
    if (!out->path)
        return error_memory(error);
    out->path_count = depth;
    for (int32_t at = node_index; at != NONE; at = s->scene->nodes[at].parent)
        out->path[--depth] = at;
    for (size_t i = 0; i < s->span_count; i++) {
        if (!span_meets(&s->spans[i], from, to) || !concerns(s, &s->spans[i], out))
            continue;
        if (!mem_grow((void **)&out->spans, &capacity, out->span_count + 1, sizeof *out->spans))
            return error_memory(error);
        out->spans[out->span_count++] = i;
    }
    return LMN_OK;
}

void dynamics_release(dynamics *d)
{
    mem_free(d->path);
    mem_free(d->spans);
    memset(d, 0, sizeof *d);
}

/* --- semantics ------------------------------------------------------------------------------------------- */

static const char *attribute_of(const node *n, const char *key)
{
    for (size_t i = 0; i < n->attribute_count; i++)
        if (strcmp(n->attributes[i].key, key) == 0)
            return n->attributes[i].value;
    return NULL;
}

/* Is the word in the name, as a word of its own ("door_left", "Left Door 2", "carDoor")? */
static bool has_word(const char *name, const char *word)
{
    size_t length = strlen(word);
    for (size_t i = 0; name[i]; i++) {
        size_t k = 0;
        while (k < length && (name[i + k] | 0x20) == word[k])
            k++;
        char before = i ? name[i - 1] : ' ', behind = k == length ? name[i + k] : 'x';
        bool begins = !((before | 0x20) >= 'a' && (before | 0x20) <= 'z') || (name[i] < 'a' && before >= 'a');
        bool ends = !(behind >= 'a' && behind <= 'z');
        if (k == length && begins && ends)
            return true;
    }
    return false;
}

static bool is_skinned_model(const lmn_scene *scene, int32_t index)
{
    for (int32_t at = index; at != NONE; at = scene_next_node(scene, index, at))
        if (scene->nodes[at].skin != NONE)
            return true;
    return false;
}

/* As large in all directions, and its vertices equally far from its middle. */
static bool is_ball(const lmn_scene *scene, const node *n)
{
    if (n->mesh == NONE || scene->meshes[n->mesh].primitive_count != 1)
        return false;
    const primitive *p = &scene->meshes[n->mesh].primitives[0];
    double           middle[3], least = INFINITY, most = 0;
    if (p->vertex_count < 20 || p->index_count < 60)
        return false;
    box3_middle(p->bounds, middle);
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        double x = (double)p->positions[i].x - middle[0], y = (double)p->positions[i].y - middle[1],
               z = (double)p->positions[i].z - middle[2], far = sqrt(x * x + y * y + z * z);
        least = fmin(least, far);
        most = fmax(most, far);
    }
    return most > 0 && least > 0.95 * most;
}

const char *semantics_of(const lmn_scene *scene, int32_t node_index)
{
    static const char *const words[][2] = {{"ball", "ball"},     {"sphere", "ball"},     {"car", "vehicle"},
                                           {"truck", "vehicle"}, {"bus", "vehicle"},     {"wheel", "wheel"},
                                           {"plane", "plane"},   {"aeroplane", "plane"}, {"glider", "plane"},
                                           {"door", "door"},     {"ground", "ground"},   {"floor", "ground"},
                                           {"head", "head"},     {"arm", "arm"},         {"hand", "hand"},
                                           {"leg", "leg"},       {"foot", "foot"},       {"hips", "hip"},
                                           {"hip", "hip"},       {"pelvis", "hip"},      {"jaw", "mouth"},
                                           {"mouth", "mouth"},   {"eye", "eye"},         {"person", "character"},
                                           {"man", "character"}, {"woman", "character"}, {"character", "character"}};
    const node              *n = &scene->nodes[node_index];
    const char              *told = attribute_of(n, "semantics");
    if (told)
        return told;
    if (n->camera != NONE)
        return "camera";
    if (n->light != NONE)
        return "light";
    for (size_t i = 0; n->name && i < sizeof words / sizeof *words; i++)
        if (has_word(n->name, words[i][0]))
            return words[i][1];
    if (n->skin != NONE || (n->parent == NONE && is_skinned_model(scene, node_index)))
        return "character";
    return is_ball(scene, n) ? "ball" : NULL;
}
