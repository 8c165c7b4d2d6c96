#include "behaviour/evaluate.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "behaviour/map.h"
#include "scene/channel.h"
#include "scene/decompose.h"

int32_t schedule_driver(const schedule *s, const behaviour_property *p, double t, time_side side)
{
    size_t low = 0, high = p->time_count;
    (void)s;
    while (low < high) { /* how many times lie before t */
        size_t middle = low + (high - low) / 2;
        *(p->times[middle] < t ? &low : &high) = p->times[middle] < t ? middle + 1 : middle;
    }
    bool at = low < p->time_count && p->times[low] == t;
    return p->drivers[2 * low + (at ? (size_t)(1 + (int)side) : 0)];
}

void schedule_rest(const lmn_scene *scene, animation_path path, int32_t target, double *out)
{
    if (animation_thing_of(path) == ANIMATED_CAMERA) {
        *out = path == PATH_CAMERA_FOV ? scene->cameras[target].fov_y : scene->cameras[target].half_height;
        return;
    }
    if (animation_thing_of(path) == ANIMATED_LIGHT) {
        const light *l = &scene->lights[target];
        for (int k = 0; k < (path == PATH_LIGHT_COLOUR ? 3 : 1); k++)
            out[k] = (double)(path == PATH_LIGHT_COLOUR ? l->colour[k] : l->intensity);
        return;
    }
    const node *n = &scene->nodes[target];
    if (path == PATH_WEIGHTS) {
        size_t       count = behaviour_components(scene, path, target);
        const float *rest = n->morph_weights ? n->morph_weights : count ? scene->meshes[n->mesh].morph_weights : NULL;
        for (size_t k = 0; k < count; k++)
            out[k] = (double)rest[k];
        return;
    }
    double            t[3], r[4], size[3];
    const node_place *at = node_place_of(n);
    memcpy(t, at->translation, sizeof t);
    memcpy(r, at->rotation, sizeof r);
    memcpy(size, at->scale, sizeof size);
    if (n->has_matrix)
        mat4_decompose(&at->matrix, t, r, size);
    memcpy(out,
           path == PATH_TRANSLATION ? t
           : path == PATH_ROTATION  ? r
                                    : size,
           (path == PATH_ROTATION ? 4 : 3) * sizeof *out);
    if (path == PATH_ROTATION)
        quaternion_normalise(out);
}

/* Where another node was, seen from the parent of the one that follows. */
static void follow(const schedule *s, const behaviour_node *n, double t, double out[3])
{
    mat4    there = schedule_world(s, n->map.other, t - n->map.delay, SIDE_AT);
    int32_t parent = s->scene->nodes[n->target].parent;
    mat4 above = parent == NONE ? mat4_identity() : schedule_world(s, parent, t, SIDE_AT), back = mat4_inverse(&above);
    double at[3];
    for (int k = 0; k < 3; k++)
        at[k] = there.m[12 + k] + n->map.offset[k];
    for (int k = 0; k < 3; k++)
        out[k] = back.m[k] * at[0] + back.m[4 + k] * at[1] + back.m[8 + k] * at[2] + back.m[12 + k];
}

void schedule_span_value(const schedule *s, const behaviour_span *span, double t, double *out)
{
    const behaviour_node    *n = &s->nodes[span->node];
    const animation_channel *c = span_channel(s, span);
    t = fmin(fmax(t, span->from), span->to);
    if (c)
        animation_channel_at(c, span_local(s, span, t), out);
    else if (n->map.kind == MAP_FOLLOW)
        follow(s, n, t, out);
    else
        map_value(n, &s->curves[span->node], span_local(s, span, t), span->length, out);
}

void schedule_value(const schedule *s, const behaviour_property *p, double t, time_side side, double *out)
{
    int32_t driver = schedule_driver(s, p, t, side);
    if (driver == NONE)
        schedule_rest(s->scene, p->path, p->target, out);
    else
        schedule_span_value(s, &s->spans[driver], t, out);
}

mat4 schedule_local(const schedule *s, int32_t node_index, double t, time_side side)
{
    int32_t driven[3];
    bool    any = false;
    for (int k = 0; k < 3; k++) {
        driven[k] = schedule_property(s, (animation_path)k, node_index);
        any = any || driven[k] != NONE;
    }
    if (!any)
        return node_local_matrix(&s->scene->nodes[node_index]);
    double values[3][4];
    for (int k = 0; k < 3; k++)
        if (driven[k] == NONE)
            schedule_rest(s->scene, (animation_path)k, node_index, values[k]);
        else
            schedule_value(s, &s->properties[driven[k]], t, side, values[k]);
    return mat4_from_trs(values[PATH_TRANSLATION], values[PATH_ROTATION], values[PATH_SCALE]);
}

mat4 schedule_world(const schedule *s, int32_t node_index, double t, time_side side)
{
    mat4 world = mat4_identity();
    for (int32_t at = node_index; at != NONE; at = s->scene->nodes[at].parent) {
        mat4 local = schedule_local(s, at, t, side);
        world = mat4_multiply(&local, &world);
    }
    return world;
}

/* --- breaks --------------------------------------------------------------------------------------------- */

typedef struct breaking {
    const schedule       *s;
    const behaviour_span *span;
    double                begin, end;
    double              **times;
    size_t               *count, *capacity;
    bool                  failed;
} breaking;

static bool add_time(breaking *b, double t)
{
    if (!(t >= b->begin && t <= b->end))
        return true;
    if (*b->count >= BEHAVIOUR_STEPS_MAX ||
        !mem_grow((void **)b->times, b->capacity, *b->count + 1, sizeof **b->times)) {
        b->failed = true;
        return false;
    }
    (*b->times)[(*b->count)++] = t;
    return true;
}

static bool add_local(double local, void *user)
{
    breaking *b = user;
    return add_time(b, span_global(b->s, b->span, local));
}

bool schedule_breaks(const schedule *s, const behaviour_property *p, double begin, double end, double **times,
                     size_t *count, size_t *capacity)
{
    breaking b = {s, NULL, begin, end, times, count, capacity, false};
    for (size_t i = 0; i < p->time_count && !b.failed; i++)
        add_time(&b, p->times[i]);
    for (size_t i = 0; i < p->span_count && !b.failed; i++) {
        b.span = &s->spans[s->of_property[p->first_span + i]];
        const animation_channel *c = span_channel(s, b.span);
        const behaviour_node    *n = &s->nodes[b.span->node];
        if (b.span->to < begin || b.span->from > end)
            continue;
        for (size_t k = 0; c && k < c->key_count && !b.failed; k++)
            add_local((double)c->times[k], &b);
        if (!c)
            map_breaks(n, &s->curves[b.span->node], b.span->length, add_local, &b);
    }
    if (!b.failed)
        trajectory_sort_times(*times, count);
    return !b.failed;
}

/* --- followers ------------------------------------------------------------------------------------------ */

typedef struct following {
    const schedule *s;
    unsigned char  *state; /* per node of the scene: unseen, open, done */
    lmn_error      *error;
} following;

enum { FOLLOW_DEPTH_MAX = 64 };

/* Whose position a node's position needs: its parents', and that of those it follows. `by` is the constraint that asks.
 */
static lmn_status check_follower(following *f, int32_t index, int32_t by, int depth)
{
    const schedule *s = f->s;
    if (depth > FOLLOW_DEPTH_MAX)
        return behaviour_refuse(&s->nodes[by], (size_t)by, LMN_LIMIT, f->error,
                                "is one of more than %d, of which each follows what another one moves",
                                FOLLOW_DEPTH_MAX);
    for (int32_t at = index; at != NONE; at = s->scene->nodes[at].parent) {
        if (f->state[at] == 2)
            return LMN_OK;
        if (f->state[at] == 1)
            return behaviour_refuse(&s->nodes[by], (size_t)by, LMN_FORMAT, f->error,
                                    "makes the node '%.100s' follow itself, in a circle of followers",
                                    s->scene->nodes[at].name ? s->scene->nodes[at].name : "(no name)");
        f->state[at] = 1;
        int32_t property = schedule_property(s, PATH_TRANSLATION, at);
        for (size_t i = 0; property != NONE && i < s->properties[property].span_count; i++) {
            const behaviour_span *span = &s->spans[s->of_property[s->properties[property].first_span + i]];
            const behaviour_node *n = &s->nodes[span->node];
            if (span->channel != NONE || n->map.kind != MAP_FOLLOW)
                continue;
            lmn_status status = check_follower(f, n->map.other, span->node, depth + 1);
            if (status != LMN_OK)
                return status;
        }
    }
    for (int32_t at = index; at != NONE; at = s->scene->nodes[at].parent)
        f->state[at] = 2;
    return LMN_OK;
}

lmn_status schedule_check_followers(const schedule *s, lmn_error *error)
{
    following  f = {s, mem_calloc(s->scene->node_count, 1), error};
    lmn_status status = f.state ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < s->span_count && status == LMN_OK; i++)
        if (s->nodes[s->spans[i].node].kind == BEHAVIOUR_CONSTRAINT &&
            s->nodes[s->spans[i].node].map.kind == MAP_FOLLOW)
            status = check_follower(&f, s->nodes[s->spans[i].node].target, s->spans[i].node, 0);
    mem_free(f.state);
    return status;
}
