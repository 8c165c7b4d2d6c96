#include "import/retarget_pairs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/work.h"
#include "scene/decompose.h"

/* --- quaternions ---------------------------------------------------------------------------------------- */

void quaternion_multiply(const double a[4], const double b[4], double out[4])
{
    const double q[4] = {
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
    memcpy(out, q, sizeof q);
}

void quaternion_invert(const double q[4], double out[4])
{
    for (int i = 0; i < 3; i++)
        out[i] = -q[i];
    out[3] = q[3];
}

void quaternion_conjugate(const double a[4], const double b[4], double out[4])
{
    double back[4];
    quaternion_invert(a, back);
    quaternion_multiply(a, b, out);
    quaternion_multiply(out, back, out);
}

void quaternion_turn(const double q[4], const double v[3], double out[3])
{
    const double as_quaternion[4] = {v[0], v[1], v[2], 0};
    double       turned[4];
    quaternion_conjugate(q, as_quaternion, turned);
    memcpy(out, turned, 3 * sizeof *out);
}

void quaternion_of(const mat4 *m, double out[4])
{
    double t[3], s[3];
    mat4_decompose(m, t, out, s);
}

/* --- which joint follows which -------------------------------------------------------------------------- */

/* The name without what programs put in front of it, as in "mixamorig:Hips". */
static const char *plain_name(const char *name)
{
    const char *colon = strrchr(name, ':');
    return colon && colon[1] ? colon + 1 : name;
}

typedef struct named_joint {
    const char *name;
    int32_t     node;
} named_joint;

static int compare_names(const void *a, const void *b)
{
    const named_joint *p = a, *q = b;
    int                order = strcasecmp(p->name, q->name);
    return order ? order : (p->node > q->node) - (p->node < q->node);
}

/* The joints of the motion that have a name, in its order; of equal ones the first in the file counts. Bones are parts
 * and no joints. */
static size_t list_joints(const lmn_scene *motion, named_joint *out)
{
    size_t count = 0, kept = 0;
    for (size_t i = 0; i < motion->node_count; i++)
        if (motion->nodes[i].mesh == NONE && motion->nodes[i].name)
            out[count++] = (named_joint){plain_name(motion->nodes[i].name), (int32_t)i};
    qsort(out, count, sizeof *out, compare_names);
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || strcasecmp(out[kept - 1].name, out[i].name) != 0)
            out[kept++] = out[i];
    return kept;
}

static int32_t find_joint(const named_joint *joints, size_t count, const char *name)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (strcasecmp(joints[middle].name, name) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && strcasecmp(joints[low].name, name) == 0 ? joints[low].node : NONE;
}

/* What was found when names were compared: joints of the skins, and joints of the motion that one follows. */
typedef struct agreement {
    size_t joints, followed;
} agreement;

/* `pair_of` is NONE for each node of the scene, `followed` false for each of the motion. */
static agreement pair_joints(pair_list *out, const lmn_scene *s, const named_joint *joints, size_t count,
                             int32_t *pair_of, bool *followed)
{
    agreement found = {0};
    for (size_t i = 0; i < s->skin_count; i++)
        for (size_t k = 0; k < s->skins[i].joint_count; k++) {
            int32_t n = s->skins[i].joints[k];
            if (pair_of[n] != NONE || !s->nodes[n].name)
                continue;
            int32_t other = find_joint(joints, count, plain_name(s->nodes[n].name));
            found.joints++;
            if (other == NONE)
                continue;
            found.followed += !followed[other];
            followed[other] = true;
            pair_of[n] = (int32_t)out->count;
            out->items[out->count++] =
                (pair){.model = n, .motion = other, .above = NONE, .skin = (int32_t)i, .joint = k};
        }
    return found;
}

static size_t count_skin_joints(const lmn_scene *s)
{
    size_t count = 0;
    for (size_t i = 0; i < s->skin_count; i++)
        count += s->skins[i].joint_count;
    return count < s->node_count ? count : s->node_count;
}

/* Names alone; *enough says whether the two are the same kind of figure. False when memory is gone. */
static bool compare_all(pair_list *out, const lmn_scene *s, const lmn_scene *motion, int32_t *pair_of, bool *enough)
{
    named_joint *joints = mem_alloc(motion->node_count * sizeof *joints);
    bool        *followed = mem_calloc(motion->node_count, sizeof *followed);
    out->items = mem_calloc(count_skin_joints(s), sizeof *out->items);
    bool good = joints && followed && out->items;
    if (good) {
        size_t    count = list_joints(motion, joints);
        agreement found = pair_joints(out, s, joints, count, pair_of, followed);
        size_t    least = count < found.joints ? count : found.joints;
        *enough = found.followed > 0 && 2 * found.followed >= least;
    }
    mem_free(joints);
    mem_free(followed);
    return good;
}

/* --- at rest -------------------------------------------------------------------------------------------- */

/* How a skin was bound. */
typedef struct bind_pose {
    bool asked, known;
    mat4 mesh; /* takes its mesh to the world there */
} bind_pose;

static bool is_identity(const mat4 *m)
{
    const mat4 identity = mat4_identity();
    return memcmp(m, &identity, sizeof identity) == 0;
}

static bool is_near(const mat4 *a, const mat4 *b)
{
    double most = 0, apart = 0;
    for (int i = 0; i < 16; i++) {
        most = fmax(most, fabs(a->m[i]));
        apart = fmax(apart, fabs(a->m[i] - b->m[i]));
    }
    return apart <= 1e-3 * most;
}

/* Do the joints of the skin stand as they did when it was bound? Then the file's nodes say all; so they do when its
 * matrices are all the identity, which stands for none. */
static bool rests_as_bound(const lmn_scene *s, const skin *k)
{
    mat4 first = mat4_identity();
    bool plain = true, same = true;
    for (size_t i = 0; i < k->joint_count && (plain || same) && !work_stopped(); i++) {
        mat4 world = scene_world_matrix(s, k->joints[i]), at = mat4_multiply(&world, &k->inverse_binds[i]);
        plain = plain && is_identity(&k->inverse_binds[i]);
        if (i == 0)
            first = at;
        same = same && is_near(&first, &at);
    }
    return plain || same;
}

/* The poses of all skins. Programs leave the node of a skinned mesh where it was when the skin was bound, though
 * drawing does not ask for it. NULL when memory is gone. */
static bind_pose *find_binds(const lmn_scene *s)
{
    bind_pose *binds = mem_calloc(s->skin_count, sizeof *binds);
    for (size_t i = 0; binds && i < s->node_count; i++) {
        const node *n = &s->nodes[i];
        bind_pose  *b = n->mesh == NONE || n->skin == NONE ? NULL : &binds[n->skin];
        if (!b || b->asked)
            continue;
        b->asked = true;
        b->known = !rests_as_bound(s, &s->skins[n->skin]);
        b->mesh = scene_world_matrix(s, (int32_t)i);
    }
    return binds;
}

/* False when the matrix is flat; then *out is all zeros. */
static bool invert_affine(const mat4 *m, mat4 *out)
{
    double c[9], determinant = mat4_cofactors(m, c);
    bool   good = true;
    *out = (mat4){{0}};
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            out->m[4 * column + row] = c[3 * row + column] / determinant;
    for (int row = 0; row < 3; row++)
        out->m[12 + row] = -(out->m[row] * m->m[12] + out->m[4 + row] * m->m[13] + out->m[8 + row] * m->m[14]);
    out->m[15] = 1;
    for (int i = 0; i < 16; i++)
        good = good && isfinite(out->m[i]);
    if (!good)
        *out = (mat4){{0}};
    return good;
}

/* The joint's matrix in the world at rest. */
static mat4 rest_matrix(const lmn_scene *s, const pair *p, const bind_pose *binds)
{
    const bind_pose *b = &binds[p->skin];
    mat4             bound;
    if (b->known && invert_affine(&s->skins[p->skin].inverse_binds[p->joint], &bound))
        return mat4_multiply(&b->mesh, &bound);
    return scene_world_matrix(s, p->model);
}

/* How the joint's parent is turned in the world when the pair above is at rest. What lies between the two joints has no
 * counterpart and stays as the file's nodes have it. */
static void set_parent_rest(const pair_list *list, const lmn_scene *s, pair *p, const mat4 *parent_world)
{
    quaternion_of(parent_world, p->parent_rest);
    if (p->above == NONE)
        return;
    const pair *above = &list->items[p->above];
    const mat4  world = scene_world_matrix(s, above->model);
    double      as_file[4];
    quaternion_of(&world, as_file);
    quaternion_invert(as_file, as_file);
    quaternion_multiply(as_file, p->parent_rest, p->parent_rest);
    quaternion_multiply(above->rest, p->parent_rest, p->parent_rest);
}

static bool set_rest(pair_list *list, const lmn_scene *s, const bind_pose *binds, const int32_t *pair_of)
{
    for (size_t i = 0; i < list->count && !work_stopped(); i++) {
        pair      *p = &list->items[i];
        const mat4 rest = rest_matrix(s, p, binds);
        quaternion_of(&rest, p->rest);
        for (int k = 0; k < 3; k++)
            p->place[k] = rest.m[12 + k];
        for (int32_t n = s->nodes[p->model].parent; n != NONE && p->above == NONE; n = s->nodes[n].parent)
            p->above = pair_of[n];
        list->uppermost += p->above == NONE;
    }
    for (size_t i = 0; i < list->count && !work_stopped(); i++) {
        pair      *p = &list->items[i];
        int32_t    parent = s->nodes[p->model].parent;
        const mat4 world = parent == NONE ? mat4_identity() : scene_world_matrix(s, parent);
        set_parent_rest(list, s, p, &world);
        invert_affine(&world, &p->from_world);
    }
    return !work_stopped();
}

bool pairs_find(pair_list *out, const lmn_scene *s, const lmn_scene *motion, size_t *alike)
{
    bool       enough = false;
    int32_t   *pair_of = mem_alloc(s->node_count * sizeof *pair_of);
    bind_pose *binds = find_binds(s);
    bool       good = pair_of && binds;
    if (good) {
        memset(pair_of, 0xFF, s->node_count * sizeof *pair_of); /* all NONE */
        good = compare_all(out, s, motion, pair_of, &enough);
    }
    *alike = out->count;
    if (good && enough)
        good = set_rest(out, s, binds, pair_of);
    else
        out->count = 0;
    mem_free(pair_of);
    mem_free(binds);
    return good;
}
