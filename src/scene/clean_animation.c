/* Repairing animations. What importers cannot read they leave out themselves, with the place in the file. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "scene/clean.h"
#include "scene/decompose.h"

/* What was found, summed over the scene's animations. */
typedef struct animation_counts {
    uint64_t equal_times, negative_times, rotations, lost_rotations, doubles;
} animation_counts;

static size_t values_per_key(const animation_channel *c)
{
    return c->components * (c->interpolation == INTERPOLATION_CUBIC ? 3 : 1);
}

/* Of keys at one time the last one counts: it is what a player ends on. */
static void drop_equal_times(animation_channel *c, animation_counts *counts)
{
    size_t kept = 0, stride = values_per_key(c);
    for (size_t i = 0; i < c->key_count; i++) {
        if (i + 1 < c->key_count && c->times[i + 1] <= c->times[i]) {
            counts->equal_times++;
            continue;
        }
        if (kept != i) {
            c->times[kept] = c->times[i];
            memcpy(c->values + kept * stride, c->values + i * stride, stride * sizeof *c->values);
        }
        kept++;
    }
    c->key_count = kept;
    counts->negative_times += kept > 0 && c->times[0] < 0;
}

/* Bytes hold the components of a unit quaternion to within this. */
static const double ROUNDING = 0.02;

/* Makes the rotation at each key unit; tangents are scaled with it, which leaves the curve's directions alone. */
static void normalise_rotations(animation_channel *c, animation_counts *counts)
{
    size_t stride = values_per_key(c), middle = c->interpolation == INTERPOLATION_CUBIC ? 4 : 0;
    for (size_t i = 0; i < c->key_count; i++) {
        float *key = c->values + i * stride, *q = key + middle;
        double length = sqrt((double)q[0] * q[0] + (double)q[1] * q[1] + (double)q[2] * q[2] + (double)q[3] * q[3]);
        if (!(length > 1e-12)) {
            memset(key, 0, stride * sizeof *key);
            q[3] = 1;
            counts->lost_rotations++;
            continue;
        }
        counts->rotations += fabs(length - 1) > ROUNDING;
        if (fabs(length - 1) > 1e-6)
            for (size_t k = 0; k < stride; k++)
                key[k] = (float)(key[k] / length);
    }
}

/* --- channels that move the same thing ------------------------------------------------------------------ */

enum { NODE_PATHS = PATH_WEIGHTS + 1 };

/* A number for each thing that a channel can move. */
static size_t slot_of(const lmn_scene *s, const animation_channel *c)
{
    size_t index = (size_t)c->target;
    switch (animation_thing_of(c->path)) {
    case ANIMATED_NODE: return index * NODE_PATHS + (size_t)c->path;
    case ANIMATED_CAMERA: return s->node_count * NODE_PATHS + 2 * index + (c->path == PATH_CAMERA_HALF_HEIGHT);
    default: return s->node_count * NODE_PATHS + 2 * s->camera_count + 2 * index + (c->path == PATH_LIGHT_INTENSITY);
    }
}

/* `seen` holds for each slot the animation that moved it last, counted from 1. */
static void drop_doubles(const lmn_scene *s, animation *a, uint32_t *seen, uint32_t number, animation_counts *counts)
{
    for (size_t i = a->channel_count; i-- > 0;) {
        animation_channel *c = &a->channels[i];
        size_t             slot = slot_of(s, c);
        if (seen[slot] != number) {
            seen[slot] = number;
            continue;
        }
        counts->doubles++;
        mem_free(c->times);
        mem_free(c->values);
        c->times = c->values = NULL;
        c->key_count = 0;
    }
    size_t kept = 0;
    for (size_t i = 0; i < a->channel_count; i++)
        if (a->channels[i].times)
            a->channels[kept++] = a->channels[i];
    a->channel_count = kept;
}

static bool drop_all_doubles(lmn_scene *s, animation_counts *counts)
{
    size_t    slots = s->node_count * NODE_PATHS + 2 * (s->camera_count + s->light_count);
    uint32_t *seen = mem_calloc(slots, sizeof *seen);
    for (size_t i = 0; seen && i < s->animation_count; i++)
        drop_doubles(s, &s->animations[i], seen, (uint32_t)i + 1, counts);
    mem_free(seen);
    return seen != NULL;
}

/* --- nodes ---------------------------------------------------------------------------------------------- */

void node_split_matrix(lmn_scene *s, int32_t node_index)
{
    node *n = &s->nodes[node_index];
    if (!n->has_matrix)
        return;
    bool exact = mat4_decompose(&n->place->matrix, n->place->translation, n->place->rotation, n->place->scale);
    n->has_matrix = false;
    n->place->matrix = mat4_identity();
    const char *name = n->name ? n->name : "(no name)";
    if (exact)
        warnings_add(&s->warnings, WARNING_BAD_VALUE,
                     "the animated node '%.100s' has a matrix, which was split into translation, rotation and scale",
                     name);
    else
        warnings_add(&s->warnings, WARNING_BAD_VALUE,
                     "the animated node '%.100s' has a matrix, which was split into translation, rotation and scale; "
                     "its shear is lost",
                     name);
}

static void tell(warnings *w, const animation_counts *n)
{
    if (n->equal_times)
        warnings_add(w, WARNING_BAD_VALUE, "%llu animation keys at the time of the next one were left out",
                     (unsigned long long)n->equal_times);
    if (n->negative_times)
        warnings_add(w, WARNING_BAD_VALUE, "%llu animation channels begin before 0 s, where no clip begins",
                     (unsigned long long)n->negative_times);
    if (n->rotations)
        warnings_add(w, WARNING_BAD_VALUE, "%llu animation keys with rotations that are not unit were made so",
                     (unsigned long long)n->rotations);
    if (n->lost_rotations)
        warnings_add(w, WARNING_BAD_VALUE, "%llu animation keys with rotations of length 0 became no rotation",
                     (unsigned long long)n->lost_rotations);
    if (n->doubles)
        warnings_add(w, WARNING_BAD_VALUE,
                     "%llu animation channels that move what a later one of the same animation moves were left out",
                     (unsigned long long)n->doubles);
}

static void clean_channels(lmn_scene *s, animation *a, animation_counts *counts)
{
    a->duration = 0;
    for (size_t i = 0; i < a->channel_count; i++) {
        animation_channel *c = &a->channels[i];
        drop_equal_times(c, counts);
        if (c->path == PATH_ROTATION)
            normalise_rotations(c, counts);
        if (c->path <= PATH_SCALE)
            node_split_matrix(s, c->target);
        if (c->key_count > 0)
            a->duration = fmax(a->duration, c->times[c->key_count - 1]);
    }
    if (a->channel_count == 0)
        warnings_add(&s->warnings, WARNING_IGNORED, "the animation '%.100s' moves nothing",
                     a->name ? a->name : "(no name)");
}

bool animations_clean(lmn_scene *s)
{
    animation_counts counts = {0};
    if (s->animation_count == 0)
        return true;
    if (!drop_all_doubles(s, &counts))
        return false;
    for (size_t i = 0; i < s->animation_count; i++)
        clean_channels(s, &s->animations[i], &counts);
    tell(&s->warnings, &counts);
    return true;
}
