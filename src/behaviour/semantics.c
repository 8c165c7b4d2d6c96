/* What a thing is: told, or guessed from what it is called and what it has. Shapes are guessed by their shape alone. */
#include <math.h>
#include <string.h>

#include "base/vector3.h"
#include "behaviour/carry.h"
#include "behaviour/inspect.h"

static const char *attribute_of(const node *n, const char *key)
{
    for (size_t i = 0; i < n->attribute_count; i++)
        if (strcmp(n->attributes[i].key, key) == 0)
            return n->attributes[i].value;
    return NULL;
}

/* Where the word ends in the name, as a word of its own ("door_left", "Left Door 2", "carDoor"); 0: it is not there. */
static size_t end_of_word(const char *name, const char *word)
{
    size_t length = strlen(word), end = 0;
    for (size_t i = 0; name[i]; i++) {
        size_t k = 0;
        while (k < length && (name[i + k] | 0x20) == word[k])
            k++;
        char before = i ? name[i - 1] : ' ', behind = k == length ? name[i + k] : 'x';
        bool begins = !((before | 0x20) >= 'a' && (before | 0x20) <= 'z') || (name[i] < 'a' && before >= 'a');
        bool ends = !(behind >= 'a' && behind <= 'z');
        if (k == length && begins && ends)
            end = i + k;
    }
    return end;
}

static bool has_word(const char *name, const char *word)
{
    return end_of_word(name, word) > 0;
}

static bool is_skinned_model(const lmn_scene *scene, int32_t index)
{
    for (int32_t at = index; at != NONE; at = scene_next_node(scene, index, at))
        if (scene->nodes[at].skin != NONE)
            return true;
    return false;
}

/* As large in all directions: its vertices and the middles of its triangles are equally far from its middle. */
static bool is_ball(const lmn_scene *scene, const node *n)
{
    if (n->mesh == NONE || scene->meshes[n->mesh].primitive_count != 1)
        return false;
    const primitive *p = &scene->meshes[n->mesh].primitives[0];
    double           middle[3], least = INFINITY, most = 0;
    if (p->vertex_count < 20 || p->index_count < 60)
        return false;
    box3_middle(p->bounds, middle);
    for (uint32_t i = 0; i < p->index_count; i++) {
        double from[3], of_triangle[3] = {0, 0, 0};
        for (uint32_t k = 0; k < 3; k++) {
            const vec3 *v = &p->positions[p->indices[i - i % 3 + k]];
            vector3_set(from, (double)v->x, (double)v->y, (double)v->z);
            vector3_add(of_triangle, of_triangle, 1.0 / 3, from);
            if (k == i % 3) {
                least = fmin(least, vector3_distance(from, middle));
                most = fmax(most, vector3_distance(from, middle));
            }
        }
        if (vector3_distance(of_triangle, middle) < 0.85 * most)
            return false;
    }
    return most > 0 && least > 0.95 * most;
}

/* Without any height: a sheet. */
static bool is_flat(const lmn_scene *scene, const node *n)
{
    box3 box = box3_empty();
    for (size_t i = 0; n->mesh != NONE && i < scene->meshes[n->mesh].primitive_count; i++)
        box = box3_union(box, scene->meshes[n->mesh].primitives[i].bounds);
    if (box3_is_empty(box))
        return false;
    const float thin = 1e-4f * (float)box3_diagonal(box);
    return box.max.x - box.min.x <= thin || box.max.y - box.min.y <= thin || box.max.z - box.min.z <= thin;
}

/* Rigs have nodes by which others are moved, and which nobody sees. */
static bool is_helper(const lmn_scene *scene, int32_t node_index)
{
    static const char *const words[] = {"ctrl",   "control", "controller", "ctl", "ik",       "fk",     "pole",
                                        "target", "helper",  "goal",       "nub", "effector", "driver", "aim"};
    const char              *name = scene->nodes[node_index].name;
    for (size_t i = 0; name && i < sizeof words / sizeof *words; i++)
        if (has_word(name, words[i]))
            return !node_carries(scene, node_index);
    return false;
}

/* A word of a name, and what is called so; balls are round, and what flies is no sheet. */
typedef struct meaning {
    const char *word, *semantics;
} meaning;

static const meaning meanings[] = {{"ball", "ball"},     {"sphere", "ball"},     {"car", "vehicle"},
                                   {"truck", "vehicle"}, {"bus", "vehicle"},     {"wheel", "wheel"},
                                   {"plane", "plane"},   {"aeroplane", "plane"}, {"glider", "plane"},
                                   {"door", "door"},     {"ground", "ground"},   {"floor", "ground"},
                                   {"head", "head"},     {"arm", "arm"},         {"hand", "hand"},
                                   {"leg", "leg"},       {"foot", "foot"},       {"hips", "hip"},
                                   {"hip", "hip"},       {"pelvis", "hip"},      {"jaw", "mouth"},
                                   {"mouth", "mouth"},   {"eye", "eye"},         {"person", "character"},
                                   {"man", "character"}, {"woman", "character"}, {"character", "character"}};

static bool has_its_shape(const lmn_scene *scene, const node *n, const char *semantics)
{
    if (strcmp(semantics, "ball") == 0)
        return is_ball(scene, n);
    return strcmp(semantics, "plane") != 0 || !is_flat(scene, n);
}

/* Of two nouns the last one says what a thing is: a head lamp is a lamp, an arm rest is a rest. */
static bool is_of_another(const char *name)
{
    static const char *const things[] = {"lamp",  "lamps",  "light", "lights", "rest",  "rests",
                                         "rail",  "handle", "bolt",  "arch",   "phone", "phones",
                                         "board", "band",   "brake", "cover",  "frame", "mark"};
    for (size_t i = 0; i < sizeof things / sizeof *things; i++)
        if (has_word(name, things[i]))
            return true;
    return false;
}

/* What its name says, where its shape does not deny it, by the last word that says something; NULL: nothing. */
static const char *meaning_of_name(const lmn_scene *scene, const node *n)
{
    const char *last = NULL;
    size_t      behind = 0;
    for (size_t i = 0; n->name && i < sizeof meanings / sizeof *meanings && !is_of_another(n->name); i++) {
        const size_t end = end_of_word(n->name, meanings[i].word);
        if (end > behind && has_its_shape(scene, n, meanings[i].semantics)) {
            last = meanings[i].semantics;
            behind = end;
        }
    }
    return last;
}

/* Does it belong to something that is known? What is round of a figure or a car is no ball. */
static bool is_part_of_known(const lmn_scene *scene, const node *n)
{
    for (int32_t above = n->parent; above != NONE; above = scene->nodes[above].parent) {
        const node *of = &scene->nodes[above];
        const char *told = attribute_of(of, "semantics"), *meaning = told ? told : meaning_of_name(scene, of);
        if (of->skin != NONE || (meaning && strcmp(meaning, "ground") != 0))
            return true;
    }
    return false;
}

/* Nothing but its shape says that it is a ball: it has to be as round where it is as it was made. */
static bool is_ball_by_itself(const lmn_scene *scene, const node *n)
{
    const double *size = node_place_of(n)->scale;
    const double  even = 0.05 * fabs(size[0]);
    return fabs(fabs(size[1]) - fabs(size[0])) <= even && fabs(fabs(size[2]) - fabs(size[0])) <= even &&
           is_ball(scene, n) && !is_part_of_known(scene, n);
}

const char *semantics_of(const lmn_scene *scene, int32_t node_index)
{
    const node *n = &scene->nodes[node_index];
    const char *told = attribute_of(n, "semantics");
    if (told)
        return told;
    if (n->camera != NONE)
        return "camera";
    if (n->light != NONE)
        return "light";
    if (is_helper(scene, node_index))
        return NULL;
    const char *named = meaning_of_name(scene, n);
    if (named)
        return named;
    if (n->skin != NONE || (n->parent == NONE && is_skinned_model(scene, node_index)))
        return "character";
    return is_ball_by_itself(scene, n) ? "ball" : NULL;
}
