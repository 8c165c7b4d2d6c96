#include "import/retarget.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "import/retarget_pairs.h"
#include "scene/decompose.h"

typedef struct retargeter {
    lmn_scene       *scene;
    const lmn_scene *motion;
    const animation *clip;
    pair_list        pairs;
    /* Of each node of the motion: what moves it, or NULL, and where it is in one frame. */
    const animation_channel **turning, **moving;
    double (*turns)[4], (*places)[3], (*deltas)[4]; /* deltas: rotations of pairs since rest, in the model's axes */
    double    from_motion[4];                       /* takes the motion's axes to the scene's */
    double    legs;                                 /* how much longer the model's are */
    animation made;
} retargeter;

/* --- in motion ------------------------------------------------------------------------------------------ */

static bool find_channels(retargeter *r)
{
    size_t nodes = r->motion->node_count;
    r->turning = mem_calloc(nodes, sizeof *r->turning);
    r->moving = mem_calloc(nodes, sizeof *r->moving);
    r->turns = mem_calloc(nodes, sizeof *r->turns);
    r->places = mem_calloc(nodes, sizeof *r->places);
    r->deltas = mem_calloc(r->pairs.count, sizeof *r->deltas);
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
            turn[k] = turning ? (double)turning->values[4 * frame + k] : node_place_of(n)->rotation[k];
        for (int k = 0; k < 3; k++)
            place[k] = moving ? (double)moving->values[3 * frame + k] : node_place_of(n)->translation[k];
        if (n->parent == NONE) {
            memcpy(r->turns[i], turn, sizeof turn);
            memcpy(r->places[i], place, sizeof place);
            continue;
        }
        quaternion_multiply(r->turns[n->parent], turn, r->turns[i]);
        quaternion_turn(r->turns[n->parent], place, r->places[i]);
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
    for (size_t i = 0; i < r->pairs.count; i++) {
        const pair  *p = &r->pairs.items[i];
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
        const node *n = &r->motion->nodes[i];
        double      tip[3] = {0, n->mesh == NONE ? 0 : node_place_of(n)->scale[1], 0}; /* of a bone */
        quaternion_turn(r->turns[i], tip, tip);
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
    for (size_t i = 0; i < r->pairs.count; i++)
        quaternion_conjugate(r->from_motion, r->turns[r->pairs.items[i].motion], r->deltas[i]);
    for (size_t i = 0; i < r->pairs.count; i++) {
        const pair *p = &r->pairs.items[i];
        double      world[4], above[4], local[4];
        quaternion_multiply(r->deltas[i], p->rest, world);
        if (p->above == NONE)
            memcpy(above, p->parent_rest, sizeof above);
        else
            quaternion_multiply(r->deltas[p->above], p->parent_rest, above);
        quaternion_invert(above, above);
        quaternion_multiply(above, world, local);
        put_rotation(&r->made.channels[i], frame, local);
    }
}

/* Positions of the uppermost joints' counterparts go into their channels as they are; place_uppermost makes of them
 * what the model needs. */
static void put_places(retargeter *r, size_t frame)
{
    animation_channel *c = &r->made.channels[r->pairs.count];
    for (size_t i = 0; i < r->pairs.count; i++)
        if (r->pairs.items[i].above == NONE) {
            for (size_t k = 0; k < 3; k++)
                c->values[3 * frame + k] = (float)r->places[r->pairs.items[i].motion][k];
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
        double way[3], at[3];
        for (int k = 0; k < 3; k++)
            way[k] = r->legs * ((double)value[k] - from[k]);
        quaternion_turn(r->from_motion, way, at);
        for (int k = 0; k < 3; k++)
            at[k] += p->place[k];
        for (int k = 0; k < 3; k++)
            value[k] = (float)(p->from_world.m[k] * at[0] + p->from_world.m[4 + k] * at[1] +
                               p->from_world.m[8 + k] * at[2] + p->from_world.m[12 + k]);
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
    r->made.channels = mem_calloc(r->pairs.count + r->pairs.uppermost, sizeof *r->made.channels);
    bool good = r->made.channels != NULL;
    for (size_t i = 0; i < r->pairs.count && good; i++)
        good = add_channel(r, r->pairs.items[i].model, PATH_ROTATION, &r->clip->channels[0]);
    for (size_t i = 0; i < r->pairs.count && good; i++)
        if (r->pairs.items[i].above == NONE)
            good = add_channel(r, r->pairs.items[i].model, PATH_TRANSLATION, &r->clip->channels[0]);
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
    for (size_t i = 0; i < r->pairs.count; i++)
        if (r->pairs.items[i].above == NONE)
            *standing++ = r->places[r->pairs.items[i].motion][up] - ground;
}

static bool make_animation(retargeter *r)
{
    double *standing = mem_alloc(r->pairs.uppermost * sizeof *standing);
    bool    good = standing && find_channels(r) && add_channels(r);
    if (good)
        measure_rest(r, standing);
    for (size_t f = 0; good && f < r->clip->channels[0].key_count; f++) {
        pose_motion(r, (long)f);
        put_rotations(r, f);
        put_places(r, f);
        good = !work_stopped();
    }
    for (size_t i = 0, at = 0; good && i < r->pairs.count; i++)
        if (r->pairs.items[i].above == NONE) {
            place_uppermost(r, &r->pairs.items[i], &r->made.channels[r->pairs.count + at], standing[at]);
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
    for (size_t i = 0; i < r->pairs.count; i++)
        node_split_matrix(s, r->pairs.items[i].model);
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
    mem_free(r->pairs.items);
    mem_free(r->turning);
    mem_free(r->moving);
    mem_free(r->turns);
    mem_free(r->places);
    mem_free(r->deltas);
}

static bool pair_and_make(retargeter *r, lmn_scene *motion, const char *file, bool *done)
{
    size_t alike;
    if (!pairs_find(&r->pairs, r->scene, motion, &alike))
        return false;
    if (r->pairs.count == 0) {
        warnings_add(&motion->warnings, WARNING_NO_MATCH,
                     "the motion moves its own skeleton: %zu joints of the model are called like one of its", alike);
        return true;
    }
    const mat4 axes = scene_up_rotation(motion->up, r->scene->up);
    quaternion_of(&axes, r->from_motion);
    *done = make_animation(r) && commit(r, motion, file);
    return *done;
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
