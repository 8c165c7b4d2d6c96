#include "depict/way.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "scene/channel.h"

/* --- the path from the root ------------------------------------------------------------------------------------ */

static void step_take(way_step *step, const animation_channel *c)
{
    if (c->path == PATH_TRANSLATION)
        step->translation = c;
    else if (c->path == PATH_ROTATION)
        step->rotation = c;
    else if (c->path == PATH_SCALE)
        step->scale = c;
}

static int compare_steps(const void *a, const void *b)
{
    const way_step *x = *(const way_step *const *)a, *y = *(const way_step *const *)b;
    return (x->node > y->node) - (x->node < y->node);
}

/* Paths may be long, and channels many: steps are found by their nodes. */
static lmn_status take_channels(way *out, const moment *clips, lmn_error *error)
{
    way_step **sorted = mem_alloc((out->count + 1) * sizeof *sorted);
    if (!sorted)
        return error_memory(error);
    for (size_t i = 0; i < out->count; i++)
        sorted[i] = &out->steps[i];
    qsort(sorted, out->count, sizeof *sorted, compare_steps);
    for (size_t k = 0; k < clips->clip_count; k++) {
        const animation *a = &out->scene->animations[clips->clips[k]];
        for (size_t c = 0; c < a->channel_count; c++) {
            const way_step         wanted = {.node = a->channels[c].target}, *key = &wanted;
            way_step *const *const found =
                animation_thing_of(a->channels[c].path) == ANIMATED_NODE && a->channels[c].key_count > 0
                    ? bsearch(&key, sorted, out->count, sizeof *sorted, compare_steps)
                    : NULL;
            if (found)
                step_take(*found, &a->channels[c]);
        }
    }
    mem_free(sorted);
    return LMN_OK;
}

static const animation_channel *channel_of(const way_step *step, int which)
{
    return which == 0 ? step->translation : which == 1 ? step->rotation : step->scale;
}

lmn_status way_open(way *out, const lmn_scene *scene, int32_t node, const moment *clips, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->scene = scene;
    for (int32_t n = node; n != NONE; n = scene->nodes[n].parent)
        out->count++;
    out->steps = mem_calloc(out->count, sizeof *out->steps);
    if (!out->steps)
        return error_memory(error);
    size_t i = out->count;
    for (int32_t n = node; n != NONE; n = scene->nodes[n].parent)
        out->steps[--i].node = n;
    const lmn_status status = take_channels(out, clips, error);
    for (i = 0; i < out->count; i++)
        for (int k = 0; k < 3; k++) {
            const animation_channel *c = channel_of(&out->steps[i], k);
            if (c)
                out->end = fmax(out->end, (double)c->times[c->key_count - 1]);
        }
    return status;
}

void way_release(way *w)
{
    mem_free(w->steps);
    memset(w, 0, sizeof *w);
}

static mat4 local_at(const lmn_scene *scene, const way_step *step, double seconds)
{
    const node *n = &scene->nodes[step->node];
    if (!step->translation && !step->rotation && !step->scale)
        return node_local_matrix(n);
    double            t[3], r[4], s[3];
    const node_place *at = node_place_of(n);
    memcpy(t, at->translation, sizeof t);
    memcpy(r, at->rotation, sizeof r);
    memcpy(s, at->scale, sizeof s);
    if (step->translation)
        animation_channel_at(step->translation, seconds, t);
    if (step->rotation)
        animation_channel_at(step->rotation, seconds, r);
    if (step->scale)
        animation_channel_at(step->scale, seconds, s);
    return mat4_from_trs(t, r, s);
}

mat4 way_world(const way *w, double seconds)
{
    mat4 world = mat4_identity();
    for (size_t i = 0; i < w->count; i++) {
        mat4 local = local_at(w->scene, &w->steps[i], seconds);
        world = i == 0 ? local : mat4_multiply(&world, &local);
    }
    return world;
}

static void transform(const mat4 *m, const double p[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m->m[k] * p[0] + m->m[4 + k] * p[1] + m->m[8 + k] * p[2] + m->m[12 + k];
}

void way_point(const way *w, const double local[3], double seconds, double out[3])
{
    mat4 world = way_world(w, seconds);
    transform(&world, local, out);
}

void way_velocity(const way *w, const double local[3], double seconds, double span, double out[3])
{
    double from = fmax(seconds - span / 2, 0), to = fmin(seconds + span / 2, fmax(w->end, from)), a[3], b[3];
    vector3_set(out, 0, 0, 0);
    if (!(to > from))
        return;
    way_point(w, local, from, a);
    way_point(w, local, to, b);
    for (int k = 0; k < 3; k++)
        out[k] = (b[k] - a[k]) / (to - from);
}

/* --- trajectories ----------------------------------------------------------------------------------------------- */

enum { KEYS_FORCED = 4096 };

/* Both ends and all keys between them, in order, none twice. */
static double *forced_times(const way *w, double from, double to, size_t *count)
{
    size_t room = 2;
    for (size_t i = 0; i < w->count; i++)
        for (int k = 0; k < 3; k++)
            room += channel_of(&w->steps[i], k) ? channel_of(&w->steps[i], k)->key_count : 0;
    double *times = mem_alloc(room * sizeof *times);
    *count = 0;
    if (!times)
        return NULL;
    times[(*count)++] = from;
    for (size_t i = 0; i < w->count; i++)
        for (int k = 0; k < 3; k++) {
            const animation_channel *c = channel_of(&w->steps[i], k);
            size_t                   stride = c ? c->key_count / KEYS_FORCED + 1 : 1;
            for (size_t n = 0; c && n < c->key_count; n += stride)
                if (c->times[n] > from && c->times[n] < to)
                    times[(*count)++] = c->times[n];
        }
    times[(*count)++] = to;
    trajectory_sort_times(times, count);
    if (*count == 1)
        times[(*count)++] = to;
    return times;
}

typedef struct way_place {
    const way    *way;
    const double *local;
} way_place;

static void place(const void *of, double seconds, time_side side, double out[3])
{
    const way_place *p = of;
    (void)side; /* channels are joined where keys meet */
    way_point(p->way, p->local, seconds, out);
}

lmn_status way_trajectory(trajectory *out, const way *w, const double local[3], double from, double to,
                          double tolerance, lmn_error *error)
{
    const way_place of = {w, local};
    size_t          count;
    double         *times = forced_times(w, from, to, &count);
    *out = (trajectory){.samples = NULL};
    if (!times)
        return error_memory(error);
    const trajectory_source source = {place, &of, times, count};
    lmn_status              status = trajectory_create(out, &source, tolerance, TRAJECTORY_PLACES, error);
    mem_free(times);
    return status;
}
