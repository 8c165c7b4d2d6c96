#include "pose/face.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/vector3.h"

/* --- names -------------------------------------------------------------------------------------------------------- */

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

static bool is_below(const lmn_scene *s, int32_t node_index, int32_t above)
{
    while (node_index != NONE && node_index != above)
        node_index = s->nodes[node_index].parent;
    return node_index != NONE;
}

/* The joints of a figure may lie beside what they carry. */
static bool is_of_figure(const lmn_scene *s, int32_t node_index, int32_t figure)
{
    if (is_below(s, node_index, figure))
        return true;
    for (size_t i = 0; i < s->part_count; i++) {
        const node *n = &s->nodes[s->parts[i].node];
        const skin *k = n->skin == NONE || !is_below(s, s->parts[i].node, figure) ? NULL : &s->skins[n->skin];
        for (size_t j = 0; k && j < k->joint_count; j++)
            if (is_below(s, node_index, k->joints[j]))
                return true;
    }
    return false;
}

static int32_t find_named(const lmn_scene *s, int32_t figure, const char *word)
{
    for (int32_t n = 0; (size_t)n < s->node_count; n++)
        if (has_word(s->nodes[n].name, word) && is_of_figure(s, n, figure))
            return n;
    return NONE;
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

/* --- places ------------------------------------------------------------------------------------------------------- */

typedef struct extent {
    double low[3], high[3];
    bool   any;
} extent;

static void extent_take(extent *e, const vec3 *at)
{
    const double p[3] = {(double)at->x, (double)at->y, (double)at->z};
    for (int k = 0; k < 3; k++) {
        e->low[k] = fmin(e->low[k], p[k]);
        e->high[k] = fmax(e->high[k], p[k]);
    }
    e->any = true;
}

/* Does a vertex follow the node, or joints below it, more than all others? */
static bool follows(const lmn_scene *s, const skin *k, const primitive *p, uint32_t vertex, int32_t node_index)
{
    float sum = 0;
    for (uint32_t i = 0; i < p->influences; i++) {
        const uint16_t joint = p->joints[vertex * (size_t)p->influences + i];
        if (joint < k->joint_count && is_below(s, k->joints[joint], node_index))
            sum += p->weights[vertex * (size_t)p->influences + i];
    }
    return sum > 0.5f;
}

static lmn_status take_primitive(extent *e, const pose *p, size_t part, const primitive *from, int32_t node_index,
                                 const skin *only, lmn_error *error)
{
    const node *n = &p->scene->nodes[p->scene->parts[part].node];
    vec3       *at = mem_alloc((from->vertex_count + 1) * sizeof *at);
    if (!at)
        return error_memory(error);
    pose_vertices(&p->parts[part], from, NULL, NULL, from->vertex_count, at, NULL);
    for (size_t i = 0; i < node_draw_count(n); i++) {
        const mat4 world = pose_instance(p, part, i);
        for (uint32_t v = 0; v < from->vertex_count; v++)
            if (!only || follows(p->scene, only, from, v, node_index)) {
                const vec3 moved = mat4_transform_point(&world, at[v]);
                extent_take(e, &moved);
            }
    }
    mem_free(at);
    return LMN_OK;
}

/* All that is seen of a node: parts at it and below it, and what of skins hangs on it. */
static lmn_status extent_of(extent *out, const pose *p, int32_t node_index, lmn_error *error)
{
    const lmn_scene *s = p->scene;
    lmn_status       status = LMN_OK;
    *out = (extent){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, false};
    for (size_t i = 0; i < s->part_count && status == LMN_OK; i++) {
        const node *n = &s->nodes[s->parts[i].node];
        const bool  whole = is_below(s, s->parts[i].node, node_index);
        const mesh *m = n->mesh == NONE ? NULL : &s->meshes[n->mesh];
        for (size_t k = 0; m && k < m->primitive_count && status == LMN_OK; k++)
            if (whole || (n->skin != NONE && m->primitives[k].joints && m->primitives[k].weights))
                status =
                    take_primitive(out, p, i, &m->primitives[k], node_index, whole ? NULL : &s->skins[n->skin], error);
    }
    return status;
}

static void axis_of(const mat4 *m, int column, double out[3])
{
    vector3_copy(out, &m->m[4 * column]);
    if (!vector3_normalise(out))
        vector3_set(out, 0, 0, 1);
}

/* Models look along +z, and along −y where z is up. */
static void look_of(const lmn_scene *s, const mat4 *m, double out[3])
{
    axis_of(m, s->up == 'z' ? 1 : 2, out);
    for (int k = 0; k < 3 && s->up == 'z'; k++)
        out[k] = -out[k];
}

/* How a joint stands where its skin was made: models are made looking ahead, however they rest in a scene. */
static bool bound_as(mat4 *out, const lmn_scene *s, int32_t joint)
{
    for (size_t i = 0; i < s->skin_count; i++)
        for (size_t k = 0; k < s->skins[i].joint_count; k++)
            if (s->skins[i].joints[k] == joint) {
                *out = mat4_inverse(&s->skins[i].inverse_binds[k]);
                return true;
            }
    return false;
}

/* Where a node faces. What has parts has axes that mean something; joints have them along their bones, and face where
 * the figure does, turned as they have turned since they were bound to a skin, or at rest. */
static void front_of(double out[3], const pose *p, int32_t node_index, int32_t figure)
{
    for (size_t i = 0; i < p->scene->part_count; i++)
        if (is_below(p->scene, p->scene->parts[i].node, node_index)) {
            look_of(p->scene, &p->worlds[node_index], out);
            return;
        }
    const pose *rest = p->at_rest ? p->at_rest : p;
    double      front[3], turned[3] = {0, 0, 0};
    mat4        begin = rest->worlds[node_index], upright = mat4_identity();
    look_of(p->scene, bound_as(&begin, p->scene, node_index) ? &upright : &rest->worlds[figure], front);
    for (int c = 0; c < 3; c++) {
        double before[3], now[3];
        axis_of(&begin, c, before);
        axis_of(&p->worlds[node_index], c, now);
        vector3_add(turned, turned, vector3_dot(front, before), now);
    }
    vector3_copy(out, turned);
    if (!vector3_normalise(out))
        vector3_copy(out, front);
}

/* Where a node's surface has its middle, or the node itself is. */
static lmn_status middle_of(double out[3], const pose *p, int32_t node_index, lmn_error *error)
{
    extent     e;
    lmn_status status = extent_of(&e, p, node_index, error);
    if (e.any)
        vector3_mix(out, e.low, e.high, 0.5);
    else
        vector3_copy(out, &p->worlds[node_index].m[12]);
    return status;
}

/* --- parts of faces ----------------------------------------------------------------------------------------------- */

/* From a head's middle forward to its surface, and somewhat down: two thirds of the way from the crown to the chin. */
static void mouth_of_head(face *out, const extent *e, int up)
{
    double reach = INFINITY;
    for (int k = 0; k < 3; k++)
        if (fabs(out->gaze[k]) > 1e-9)
            reach = fmin(reach, (e->high[k] - e->low[k]) / 2 / fabs(out->gaze[k]));
    vector3_add(out->mouth, out->head, reach, out->gaze);
    out->mouth[up] -= (e->high[up] - e->low[up]) * 0.17;
}

/* The two that lie farthest apart. */
static lmn_status find_named_eyes(face *out, const pose *p, int32_t figure, lmn_error *error)
{
    enum { EYES_MOST = 8 };
    const lmn_scene *s = p->scene;
    double           at[EYES_MOST][3], widest = 0;
    size_t           count = 0;
    lmn_status       status = LMN_OK;
    for (int32_t n = 0; (size_t)n < s->node_count && count < EYES_MOST && status == LMN_OK; n++)
        if (is_eye(s->nodes[n].name) && is_of_figure(s, n, figure))
            status = middle_of(at[count++], p, n, error);
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
static lmn_status find_eyes(face *out, const pose *p, int32_t figure, const extent *e, lmn_error *error)
{
    double     left[3], apart[3];
    const bool upright = p->scene->up != 'z';
    vector3_cross(left, (const double[3]){0, upright ? 1 : 0, upright ? 0 : 1}, out->gaze);
    if (!vector3_normalise(left))
        vector3_set(left, 1, 0, 0);
    lmn_status status = find_named_eyes(out, p, figure, error);
    vector3_add(apart, out->eyes[0], -1, out->eyes[1]);
    if (out->named_eyes && vector3_dot(apart, left) < 0) {
        double kept[3];
        vector3_copy(kept, out->eyes[0]);
        vector3_copy(out->eyes[0], out->eyes[1]);
        vector3_copy(out->eyes[1], kept);
    }
    for (int i = 0; i < 2 && !out->named_eyes; i++) {
        double reach = e->any ? 0 : out->radius, breadth = e->any ? 0 : 2 * out->radius;
        for (int k = 0; k < 3 && e->any; k++) {
            reach += fabs(out->gaze[k]) * (e->high[k] - e->low[k]) / 2;
            breadth += fabs(left[k]) * (e->high[k] - e->low[k]);
        }
        vector3_add(out->eyes[i], out->head, reach, out->gaze);
        vector3_add(out->eyes[i], out->eyes[i], (i ? -0.2 : 0.2) * breadth, left);
    }
    return status;
}

lmn_status face_find(face *out, const pose *p, int32_t node_index, const double middle[3], double radius,
                     lmn_error *error)
{
    const lmn_scene *s = p->scene;
    const int        up = s->up == 'z' ? 2 : 1;
    int32_t          own = find_named(s, node_index, "mouth"), head = find_named(s, node_index, "head");
    extent           e;
    memset(out, 0, sizeof *out);
    own = own == NONE ? find_named(s, node_index, "jaw") : own;
    head = head == NONE ? find_named(s, node_index, "skull") : head;
    out->named_mouth = own != NONE;
    out->named_head = head != NONE;
    lmn_status status = extent_of(&e, p, head == NONE ? node_index : head, error);
    if (e.any)
        vector3_mix(out->head, e.low, e.high, 0.5);
    else
        vector3_copy(out->head, head == NONE ? middle : &p->worlds[head].m[12]);
    out->radius = e.any ? vector3_distance(e.low, e.high) / 3.46 : 0.15 * radius;
    const mat4 upright = mat4_identity();
    look_of(s, &upright, out->gaze);
    if (head != NONE)
        front_of(out->gaze, p, head, node_index);
    if (head != NONE && e.any)
        mouth_of_head(out, &e, up);
    else if (head != NONE)
        vector3_add(out->mouth, out->head, out->radius, out->gaze);
    else {
        vector3_copy(out->mouth, out->head);
        out->mouth[up] = e.any ? e.high[up] : out->mouth[up];
    }
    if (status == LMN_OK)
        status = find_eyes(out, p, node_index, &e, error);
    if (status == LMN_OK && own != NONE)
        status = middle_of(out->mouth, p, own, error);
    return status;
}
