/* Faces, as far as names and proportions tell. Nienhaus 2005, section 7.9. */
#include "depict/mouth.h"

#include <ctype.h>
#include <string.h>

#include "base/memory.h"

/* Does a name have a word in it, whatever its capitals? */
static bool has_word(const char *name, const char *word)
{
    for (; name && *name; name++) {
        size_t i = 0;
        while (word[i] && tolower((unsigned char)name[i]) == word[i])
            i++;
        if (!word[i])
            return true;
    }
    return false;
}

static int32_t find_named(const lmn_scene *s, int32_t root, const char *word)
{
    for (int32_t n = root; n != NONE; n = scene_next_node(s, root, n))
        if (has_word(s->nodes[n].name, word))
            return n;
    return NONE;
}

/* The vertices of a node and what is below it, then. */
static lmn_status box_of(double low[3], double high[3], bool *any, const depict_job *j, int32_t node, double seconds,
                         lmn_error *error)
{
    depict_target t;
    vec3         *vertices = NULL;
    size_t        count = 0;
    lmn_status    status = target_open(&t, j, node, error);
    if (status == LMN_OK)
        status = target_vertices(&vertices, &count, j, &t, seconds, error);
    vector3_set(low, INFINITY, INFINITY, INFINITY);
    vector3_set(high, -INFINITY, -INFINITY, -INFINITY);
    for (size_t i = 0; i < count; i++) {
        const double p[3] = {(double)vertices[i].x, (double)vertices[i].y, (double)vertices[i].z};
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], p[k]);
            high[k] = fmax(high[k], p[k]);
        }
    }
    *any = count > 0;
    mem_free(vertices);
    target_release(&t);
    return status;
}

/* Where a node is, and the way that it faces: models look along +z. */
static lmn_status node_place(double at[3], double front[3], const depict_job *j, int32_t node, double seconds,
                             lmn_error *error)
{
    way        w;
    lmn_status status = way_open(&w, j->scene, node, &j->when, error);
    if (status == LMN_OK) {
        mat4 world = way_world(&w, seconds);
        vector3_copy(at, &world.m[12]);
        vector3_copy(front, &world.m[8]);
        if (!vector3_normalise(front))
            vector3_set(front, 0, 0, 1);
    }
    way_release(&w);
    return status;
}

/* From a head's middle forward to its surface, and somewhat down: two thirds of the way from the crown to the chin. */
static void mouth_of_head(mouth *out, const double low[3], const double high[3], const double front[3])
{
    double reach = INFINITY;
    for (int k = 0; k < 3; k++)
        if (fabs(front[k]) > 1e-9)
            reach = fmin(reach, (high[k] - low[k]) / 2 / fabs(front[k]));
    vector3_add(out->at, out->head, reach, front);
    out->at[1] -= (high[1] - low[1]) * 0.17;
}

lmn_status mouth_find(mouth *out, const depict_job *j, const depict_target *t, double seconds, lmn_error *error)
{
    const lmn_scene *s = j->scene;
    int32_t          own = find_named(s, t->node, "mouth"), head = find_named(s, t->node, "head");
    double           low[3], high[3], front[3] = {0, 0, 1}, place[3];
    bool             any = false;
    own = own == NONE ? find_named(s, t->node, "jaw") : own;
    lmn_status status = box_of(low, high, &any, j, head == NONE ? t->node : head, seconds, error);
    if (status == LMN_OK && head != NONE)
        status = node_place(place, front, j, head, seconds, error);
    if (any)
        vector3_mix(out->head, low, high, 0.5);
    else if (head != NONE)
        vector3_copy(out->head, place);
    else
        way_point(&t->way, t->centre, seconds, out->head);
    out->radius = any ? vector3_distance(low, high) / 3.46 : 0.15 * t->radius;
    if (head != NONE && any)
        mouth_of_head(out, low, high, front);
    else if (head != NONE)
        vector3_add(out->at, out->head, out->radius, front);
    else {
        vector3_copy(out->at, out->head);
        out->at[1] = any ? high[1] : out->at[1];
    }
    if (status == LMN_OK && own != NONE) {
        status = box_of(low, high, &any, j, own, seconds, error);
        if (status == LMN_OK)
            status = node_place(out->at, front, j, own, seconds, error);
        if (any)
            vector3_mix(out->at, low, high, 0.5);
    }
    return status;
}
