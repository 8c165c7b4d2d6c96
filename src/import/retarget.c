#include "import/retarget.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "scene/decompose.h"

/* A joint of the model and the one of the motion that it follows. */
typedef struct pair {
    int32_t model, motion; /* nodes */
    int32_t above;         /* the pair of the nearest joint above it in the model, NONE of an uppermost one */
    double  rest[4];       /* rotation in the world at rest */
    double  parent_rest[4];
    mat4    parent_world; /* of an uppermost one */
    double  place[3];     /* where that is at rest */
} pair;

typedef struct retargeter {
    lmn_scene       *scene;
    const lmn_scene *motion;
    const animation *clip;
    pair            *pairs;
    size_t           count, uppermost;
    /* Of each node of the motion: what moves it, or NULL, and where it is in one frame. */
    const animation_channel **turning, **moving;
    double (*turns)[4], (*places)[3], (*deltas)[4]; /* deltas: rotations of pairs since rest, in the model's axes */
    double    from_motion[4];                       /* takes the motion's axes to the scene's */
    double    legs;                                 /* how much longer the model's are */
    animation made;
} retargeter;

/* --- quaternions ---------------------------------------------------------------------------------------- */

static void multiply(const double a[4], const double b[4], double out[4])
{
    const double q[4] = {
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
    memcpy(out, q, sizeof q);
}

static void invert(const double q[4], double out[4])
{
    for (int i = 0; i < 3; i++)
        out[i] = -q[i];
    out[3] = q[3];
}

/* a · b · a⁻¹ */
static void conjugate(const double a[4], const double b[4], double out[4])
{
    double back[4];
    invert(a, back);
    multiply(a, b, out);
    multiply(out, back, out);
}

static void turn_vector(const double q[4], const double v[3], double out[3])
{
    const double as_quaternion[4] = {v[0], v[1], v[2], 0};
    double       turned[4];
    conjugate(q, as_quaternion, turned);
    memcpy(out, turned, 3 * sizeof *out);
}

static void rotation_of(const mat4 *m, double out[4])
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
static agreement pair_joints(retargeter *r, const named_joint *joints, size_t count, int32_t *pair_of, bool *followed)
{
    const lmn_scene *s = r->scene;
    agreement        found = {0};
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
            pair_of[n] = (int32_t)r->count;
            r->pairs[r->count++] = (pair){.model = n, .motion = other, .above = NONE};
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

/* Fills the pairs; *enough says whether the two are the same kind of figure. False when memory is gone. */
static bool find_pairs(retargeter *r, int32_t *pair_of, bool *enough)
{
    named_joint *joints = mem_alloc(r->motion->node_count * sizeof *joints);
    bool        *followed = mem_calloc(r->motion->node_count, sizeof *followed);
    r->pairs = mem_calloc(count_skin_joints(r->scene), sizeof *r->pairs);
    bool good = joints && followed && r->pairs;
    if (good) {
        size_t    count = list_joints(r->motion, joints);
        agreement found = pair_joints(r, joints, count, pair_of, followed);
        size_t    least = count < found.joints ? count : found.joints;
        *enough = found.followed > 0 && 2 * found.followed >= least;
    }
    mem_free(joints);
    mem_free(followed);
    return good;
}

/* --- at rest -------------------------------------------------------------------------------------------- */

static bool set_rest(retargeter *r, const int32_t *pair_of)
{
    const node *nodes = r->scene->nodes;
    for (size_t i = 0; i < r->count && !work_stopped(); i++) {
        pair      *p = &r->pairs[i];
        int32_t    parent = nodes[p->model].parent;
        const mat4 world = scene_world_matrix(r->scene, p->model);
        for (int32_t n = parent; n != NONE && p->above == NONE; n = nodes[n].parent)
            p->above = pair_of[n];
        p->parent_world = parent == NONE ? mat4_identity() : scene_world_matrix(r->scene, parent);
        rotation_of(&world, p->rest);
        rotation_of(&p->parent_world, p->parent_rest);
        for (int k = 0; k < 3; k++)
            p->place[k] = world.m[12 + k];
        r->uppermost += p->above == NONE;
    }
    return !work_stopped();
}

/* --- in motion ------------------------------------------------------------------------------------------ */

static bool find_channels(retargeter *r)
{
    size_t nodes = r->motion->node_count;
    r->turning = mem_calloc(nodes, sizeof *r->turning);
    r->moving = mem_calloc(nodes, sizeof *r->moving);
    r->turns = mem_calloc(nodes, sizeof *r->turns);
    r->places = mem_calloc(nodes, sizeof *r->places);
    r->deltas = mem_calloc(r->count, sizeof *r->deltas);
    if (!r->turning || !r->moving || !r->turns || !r->places || !r->deltas)
        return false;
    for (size_t i = 0; i < r->clip->channel_count; i++) {
        const animation_channel *c = &r->clip->channels[i];
        (c->path == PATH_ROTATION ? r->turning : r->moving)[c->target] = c;
    }
    return true;
}

enum { AT_REST = -1 };

/* Where the motion's joints are in a frame, in its own axes. Parents stand before their children. */
static void pose_motion(retargeter *r, long frame)
{
    for (size_t i = 0; i < r->motion->node_count; i++) {
        const node              *n = &r->motion->nodes[i];
        const animation_channel *turning = frame == AT_REST ? NULL : r->turning[i];
        const animation_channel *moving = frame == AT_REST ? NULL : r->moving[i];
        double                   turn[4], place[3];
        for (int k = 0; k < 4; k++)
            turn[k] = turning ? (double)turning->values[4 * frame + k] : n->rotation[k];
        for (int k = 0; k < 3; k++)
            place[k] = moving ? (double)moving->values[3 * frame + k] : n->translation[k];
        if (n->parent == NONE) {
            memcpy(r->turns[i], turn, sizeof turn);
            memcpy(r->places[i], place, sizeof place);
            continue;
        }
        multiply(r->turns[n->parent], turn, r->turns[i]);
        turn_vector(r->turns[n->parent], place, r->places[i]);
        for (int k = 0; k < 3; k++)
            r->places[i][k] += r->places[n->parent][k];
    }
}

/* At rest, legs are as long as the highest uppermost joint is above the lowest joint. Only joints that are paired are
 * measured, since one of the two may have toes. 1 when there is nothing to compare. */
static double compare_legs(const retargeter *r)
{
    double reach[2] = {0, 0};
    int    up[2] = {r->scene->up == 'z' ? 2 : 1, r->motion->up == 'z' ? 2 : 1};
    double top[2] = {-INFINITY, -INFINITY}, low[2] = {INFINITY, INFINITY};
    for (size_t i = 0; i < r->count; i++) {
        const pair  *p = &r->pairs[i];
        const double at[2] = {p->place[up[0]], r->places[p->motion][up[1]]};
        for (int k = 0; k < 2; k++) {
            if (p->above == NONE)
                top[k] = fmax(top[k], at[k]);
            low[k] = fmin(low[k], at[k]);
        }
    }
    for (int k = 0; k < 2; k++)
        reach[k] = top[k] - low[k];
    return reach[0] > 0 && reach[1] > 1e-9 * reach[0] ? reach[0] / reach[1] : 1;
}

/* The lowest point of the motion's skeleton where it is now, tips of bones counted. */
static double lowest_point(const retargeter *r)
{
    int    up = r->motion->up == 'z' ? 2 : 1;
    double low = INFINITY;
    for (size_t i = 0; i < r->motion->node_count; i++) {
        double tip[3] = {0, r->motion->nodes[i].mesh == NONE ? 0 : r->motion->nodes[i].scale[1], 0}; /* of a bone */
        turn_vector(r->turns[i], tip, tip);
        low = fmin(low, fmin(r->places[i][up], r->places[i][up] + tip[up]));
    }
    return low;
}

static void put_rotation(animation_channel *c, size_t frame, const double q[4])
{
    float *to = c->values + 4 * frame;
    double along = 0, length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4 && frame > 0; i++)
        along += q[i] * (double)to[i - 4];
    for (int i = 0; i < 4; i++)
        to[i] = (float)((along < 0 ? -q[i] : q[i]) / length);
}

/* A joint is turned in the world as its counterpart is since rest: D · rest. What is above it has turned by the delta
 * of the pair above. */
static void put_rotations(retargeter *r, size_t frame)
{
    for (size_t i = 0; i < r->count; i++)
        conjugate(r->from_motion, r->turns[r->pairs[i].motion], r->deltas[i]);
    for (size_t i = 0; i < r->count; i++) {
        const pair *p = &r->pairs[i];
        double      world[4], above[4], local[4];
        multiply(r->deltas[i], p->rest, world);
        if (p->above == NONE)
            memcpy(above, p->parent_rest, sizeof above);
        else
            multiply(r->deltas[p->above], p->parent_rest, above);
        invert(above, above);
        multiply(above, world, local);
        put_rotation(&r->made.channels[i], frame, local);
    }
}

/* The inverse of an affine matrix applied to a point; false when it is flat. */
static bool take_back(const mat4 *m, const double p[3], double out[3])
{
    double c[9], determinant = mat4_cofactors(m, c), from[3];
    for (int k = 0; k < 3; k++)
        from[k] = p[k] - m->m[12 + k];
    for (int k = 0; k < 3; k++)
        out[k] = (c[3 * k] * from[0] + c[3 * k + 1] * from[1] + c[3 * k + 2] * from[2]) / determinant;
    return isfinite(out[0]) && isfinite(out[1]) && isfinite(out[2]);
}

/* Positions of the uppermost joints' counterparts go into their channels as they are; place_uppermost makes of them
 * what the model needs. */
static void put_places(retargeter *r, size_t frame)
{
    animation_channel *c = &r->made.channels[r->count];
    for (size_t i = 0; i < r->count; i++)
        if (r->pairs[i].above == NONE) {
            for (size_t k = 0; k < 3; k++)
                c->values[3 * frame + k] = (float)r->places[r->pairs[i].motion][k];
            c++;
        }
}

/* From the motion's places to the model's. Along the ground the model starts where it stands. Heights are those above
 * the motion's ground, 0, on which its skeleton stands at rest; when the joint is never a tenth of that above it, the
 * file counts heights from elsewhere, and they are taken from the first frame on. */
static void place_uppermost(retargeter *r, const pair *p, animation_channel *c, double standing)
{
    int    up = r->motion->up == 'z' ? 2 : 1;
    double from[3], highest = -INFINITY;
    for (size_t f = 0; f < c->key_count; f++)
        highest = fmax(highest, (double)c->values[3 * f + (size_t)up]);
    for (int k = 0; k < 3; k++)
        from[k] = (double)c->values[k];
    if (highest > standing / 10)
        from[up] = standing;
    for (size_t f = 0; f < c->key_count; f++) {
        float *value = &c->values[3 * f];
        double way[3], at[3], local[3];
        for (int k = 0; k < 3; k++)
            way[k] = r->legs * ((double)value[k] - from[k]);
        turn_vector(r->from_motion, way, at);
        for (int k = 0; k < 3; k++)
            at[k] += p->place[k];
        bool good = take_back(&p->parent_world, at, local);
        for (int k = 0; k < 3; k++)
            value[k] = (float)(good ? local[k] : 0);
    }
}

static bool add_channel(retargeter *r, int32_t target, animation_path path, const animation_channel *like)
{
    animation_channel *c = &r->made.channels[r->made.channel_count++];
    *c = (animation_channel){.target = target,
                             .path = path,
                             .interpolation = INTERPOLATION_LINEAR,
                             .key_count = like->key_count,
                             .components = path == PATH_ROTATION ? 4 : 3};
    c->times = mem_copy(like->times, like->key_count * sizeof *like->times);
    c->values = mem_calloc(like->key_count, c->components * sizeof *c->values);
    return c->times && c->values;
}

/* Rotations of all pairs, then places of the uppermost ones. */
static bool add_channels(retargeter *r)
{
    r->made.channels = mem_calloc(r->count + r->uppermost, sizeof *r->made.channels);
    bool good = r->made.channels != NULL;
    for (size_t i = 0; i < r->count && good; i++)
        good = add_channel(r, r->pairs[i].model, PATH_ROTATION, &r->clip->channels[0]);
    for (size_t i = 0; i < r->count && good; i++)
        if (r->pairs[i].above == NONE)
            good = add_channel(r, r->pairs[i].model, PATH_TRANSLATION, &r->clip->channels[0]);
    return good;
}

/* How high each uppermost joint's counterpart stands, the skeleton standing on the ground; in the order of the pairs.
 */
static void measure_rest(retargeter *r, double *standing)
{
    int up = r->motion->up == 'z' ? 2 : 1;
    pose_motion(r, AT_REST);
    r->legs = compare_legs(r);
    double ground = lowest_point(r);
    for (size_t i = 0; i < r->count; i++)
        if (r->pairs[i].above == NONE)
            *standing++ = r->places[r->pairs[i].motion][up] - ground;
}

static bool make_animation(retargeter *r)
{
    double *standing = mem_alloc(r->uppermost * sizeof *standing);
    bool    good = standing && find_channels(r) && add_channels(r);
    if (good)
        measure_rest(r, standing);
    for (size_t f = 0; good && f < r->clip->channels[0].key_count; f++) {
        pose_motion(r, (long)f);
        put_rotations(r, f);
        put_places(r, f);
        good = !work_stopped();
    }
    for (size_t i = 0, at = 0; good && i < r->count; i++)
        if (r->pairs[i].above == NONE) {
            place_uppermost(r, &r->pairs[i], &r->made.channels[r->count + at], standing[at]);
            at++;
        }
    r->made.duration = r->clip->duration;
    mem_free(standing);
    return good;
}

/* --- the whole ------------------------------------------------------------------------------------------ */

/* Behind the allocations nothing can fail. */
static bool commit(retargeter *r, lmn_scene *motion, const char *file)
{
    lmn_scene *s = r->scene;
    char      *path = scene_clean_name(file, strlen(file));
    r->made.name = mem_copy_text(r->clip->name);
    if (!path || (r->clip->name && !r->made.name) ||
        !mem_grow((void **)&s->animations, &s->animation_capacity, s->animation_count + 1, sizeof *s->animations) ||
        !mem_grow((void **)&s->files, &s->file_capacity, s->file_count + 1, sizeof *s->files)) {
        mem_free(path);
        return false;
    }
    for (size_t i = 0; i < r->count; i++)
        node_split_matrix(s, r->pairs[i].model);
    s->animations[s->animation_count++] = r->made;
    r->made = (animation){0};
    s->files[s->file_count++] = path;
    warnings_append(&s->warnings, &motion->warnings);
    s->load_ms += motion->load_ms;
    s->revision = scene_next_revision();
    return true;
}

static void release(retargeter *r)
{
    for (size_t i = 0; i < r->made.channel_count; i++) {
        mem_free(r->made.channels[i].times);
        mem_free(r->made.channels[i].values);
    }
    mem_free(r->made.channels);
    mem_free(r->made.name);
    mem_free(r->pairs);
    mem_free(r->turning);
    mem_free(r->moving);
    mem_free(r->turns);
    mem_free(r->places);
    mem_free(r->deltas);
}

static bool pair_and_make(retargeter *r, lmn_scene *motion, const char *file, bool *done)
{
    bool     enough = false;
    int32_t *pair_of = mem_alloc(r->scene->node_count * sizeof *pair_of);
    bool     good = pair_of != NULL;
    if (good) {
        memset(pair_of, 0xFF, r->scene->node_count * sizeof *pair_of); /* all NONE */
        good = find_pairs(r, pair_of, &enough);
    }
    if (good && !enough)
        warnings_add(&motion->warnings, WARNING_NO_MATCH,
                     "the motion moves its own skeleton: %zu of its joints are called like one of the model's",
                     r->count);
    if (good && enough) {
        const mat4 axes = scene_up_rotation(motion->up, r->scene->up);
        rotation_of(&axes, r->from_motion);
        good = set_rest(r, pair_of) && make_animation(r) && commit(r, motion, file);
        *done = good;
    }
    mem_free(pair_of);
    return good;
}

lmn_status retarget_motion(lmn_scene *scene, lmn_scene *motion, const char *file, bool *done, lmn_error *error)
{
    *done = false;
    if (!motion->is_motion || scene->skin_count == 0 || motion->animation_count == 0 ||
        motion->animations[0].channel_count == 0)
        return LMN_OK;
    retargeter r = {.scene = scene, .motion = motion, .clip = &motion->animations[0]};
    bool       good = pair_and_make(&r, motion, file, done);
    release(&r);
    return good ? LMN_OK : error_memory(error);
}
