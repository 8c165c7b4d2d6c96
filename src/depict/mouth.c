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

/* A name of an eye, not of what is around it. */
static bool is_eye(const char *name)
{
    static const char *const others[] = {"brow", "lid", "lash", "glass"};
    for (size_t i = 0; i < 4; i++)
        if (has_word(name, others[i]))
            return false;
    return has_word(name, "eye");
}

/* Where a node's surface has its middle, or the node itself is. */
static lmn_status middle_of(double out[3], const depict_job *j, int32_t node, double seconds, lmn_error *error)
{
    double     low[3], high[3], front[3];
    bool       any = false;
    lmn_status status = box_of(low, high, &any, j, node, seconds, error);
    if (status == LMN_OK)
        status = node_place(out, front, j, node, seconds, error);
    if (any)
        vector3_mix(out, low, high, 0.5);
    return status;
}

/* The two that lie farthest apart; false: there are none. */
static lmn_status find_named_eyes(mouth *out, const depict_job *j, const depict_target *t, double seconds,
                                  lmn_error *error)
{
    enum { EYES_MOST = 8 };
    const lmn_scene *s = j->scene;
    double           at[EYES_MOST][3], widest = 0;
    size_t           count = 0;
    lmn_status       status = LMN_OK;
    for (int32_t n = t->node; n != NONE && count < EYES_MOST && status == LMN_OK; n = scene_next_node(s, t->node, n))
        if (is_eye(s->nodes[n].name))
            status = middle_of(at[count++], j, n, seconds, error);
    for (size_t i = 0; i < count && status == LMN_OK; i++)
        for (size_t k = 0; k < i; k++)
            if (vector3_distance(at[i], at[k]) > widest) {
                widest = vector3_distance(at[i], at[k]);
                vector3_copy(out->eyes[0], at[i]);
                vector3_copy(out->eyes[1], at[k]);
                out->named_eyes = true;
            }
    return status;
}

/* The left one first: at the side of +x of what looks along `gaze`. */
static lmn_status find_eyes(mouth *out, const depict_job *j, const depict_target *t, double seconds,
                            const double low[3], const double high[3], lmn_error *error)
{
    double     left[3], apart[3], up[3] = {0, 1, 0};
    const bool upright = j->scene->up != 'z';
    vector3_set(up, 0, upright ? 1 : 0, upright ? 0 : 1);
    vector3_cross(left, up, out->gaze);
    if (!vector3_normalise(left))
        vector3_set(left, 1, 0, 0);
    lmn_status status = find_named_eyes(out, j, t, seconds, error);
    vector3_add(apart, out->eyes[0], -1, out->eyes[1]);
    if (out->named_eyes && vector3_dot(apart, left) < 0) {
        double kept[3];
        vector3_copy(kept, out->eyes[0]);
        vector3_copy(out->eyes[0], out->eyes[1]);
        vector3_copy(out->eyes[1], kept);
    }
    for (int i = 0; i < 2 && !out->named_eyes; i++) {
        double reach = out->radius, breadth = 2 * out->radius;
        if (high[0] >= low[0]) {
            reach = fabs(out->gaze[0]) * (high[0] - low[0]) / 2 + fabs(out->gaze[1]) * (high[1] - low[1]) / 2 +
                    fabs(out->gaze[2]) * (high[2] - low[2]) / 2;
            breadth = fabs(left[0]) * (high[0] - low[0]) + fabs(left[1]) * (high[1] - low[1]) +
                      fabs(left[2]) * (high[2] - low[2]);
        }
        vector3_add(out->eyes[i], out->head, reach, out->gaze);
        vector3_add(out->eyes[i], out->eyes[i], (i ? -0.2 : 0.2) * breadth, left);
    }
    return status;
}

lmn_status mouth_find(mouth *out, const depict_job *j, const depict_target *t, double seconds, lmn_error *error)
{
    const lmn_scene *s = j->scene;
    int32_t          own = find_named(s, t->node, "mouth"), head = find_named(s, t->node, "head");
    double           low[3], high[3], front[3] = {0, 0, 1}, place[3];
    bool             any = false;
    memset(out, 0, sizeof *out);
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
    vector3_copy(out->gaze, front);
    if (status == LMN_OK)
        status = find_eyes(out, j, t, seconds, low, high, error);
    if (status == LMN_OK && own != NONE) {
        status = box_of(low, high, &any, j, own, seconds, error);
        if (status == LMN_OK)
            status = node_place(out->at, front, j, own, seconds, error);
        if (any)
            vector3_mix(out->at, low, high, 0.5);
    }
    return status;
}
