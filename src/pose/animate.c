#include "pose/animate.h"

#include <string.h>

#include "base/memory.h"
#include "scene/channel.h"

/* --- all channels --------------------------------------------------------------------------------------- */

/* A node's own translation, rotation and scale, as far as channels do not replace them. */
typedef struct node_state {
    double translation[3], rotation[4], scale[3];
} node_state;

typedef struct animator {
    animated_state  *out;
    const lmn_scene *scene;
    double           seconds;
    node_state      *nodes;  /* per node */
    bool            *moved;  /* per node */
    double          *values; /* room for those of any channel */
} animator;

/* How many weights of a node can move. */
static size_t weight_count_of(const lmn_scene *s, const node *n)
{
    return n->morph_weights ? n->morph_weight_count : n->mesh != NONE ? s->meshes[n->mesh].morph_weight_count : 0;
}

/* Room for the weights of all nodes that have such a channel, filled with those at rest. */
static bool open_weights(animator *a, const moment *when)
{
    const lmn_scene *s = a->scene;
    size_t           total = 0;
    a->out->weights = mem_calloc(s->node_count, sizeof *a->out->weights);
    bool *moves = mem_calloc(s->node_count, sizeof *moves);
    for (size_t i = 0; moves && i < when->clip_count; i++) {
        const animation *clip = &s->animations[when->clips[i]];
        for (size_t k = 0; k < clip->channel_count; k++)
            if (clip->channels[k].path == PATH_WEIGHTS && !moves[clip->channels[k].target]) {
                moves[clip->channels[k].target] = true;
                total += weight_count_of(s, &s->nodes[clip->channels[k].target]);
            }
    }
    a->out->weight_data = mem_calloc(total, sizeof *a->out->weight_data);
    bool   done = a->out->weights && moves && a->out->weight_data;
    float *at = a->out->weight_data;
    for (size_t i = 0; done && i < s->node_count; i++) {
        const node  *n = &s->nodes[i];
        size_t       count = moves[i] ? weight_count_of(s, n) : 0;
        const float *rest = n->morph_weights ? n->morph_weights : count ? s->meshes[n->mesh].morph_weights : NULL;
        if (!count)
            continue;
        a->out->weights[i] = at;
        memcpy(at, rest, count * sizeof *at);
        at += count;
    }
    mem_free(moves);
    return done;
}

static void move_weights(animator *a, const animation_channel *c)
{
    float *to = a->out->weights[c->target];
    size_t count = weight_count_of(a->scene, &a->scene->nodes[c->target]);
    if (!to)
        return;
    animation_channel_at(c, a->seconds, a->values);
    for (size_t k = 0; k < c->components && k < count; k++)
        to[k] = (float)a->values[k];
}

static void move_node(animator *a, const animation_channel *c)
{
    node_state *n = &a->nodes[c->target];
    animation_channel_at(c, a->seconds,
                         c->path == PATH_TRANSLATION ? n->translation
                         : c->path == PATH_ROTATION  ? n->rotation
                                                     : n->scale);
    a->moved[c->target] = true;
}

static void move_light(animator *a, const animation_channel *c)
{
    light *l = &a->out->lights[c->target];
    double values[3];
    animation_channel_at(c, a->seconds, values);
    if (c->path == PATH_LIGHT_INTENSITY)
        l->intensity = (float)values[0];
    for (int k = 0; k < 3 && c->path == PATH_LIGHT_COLOUR; k++)
        l->colour[k] = (float)values[k];
}

static void move_camera(animator *a, const animation_channel *c)
{
    double value;
    animation_channel_at(c, a->seconds, &value);
    *(c->path == PATH_CAMERA_FOV ? &a->out->cameras[c->target].fov_y : &a->out->cameras[c->target].half_height) = value;
}

static void move(animator *a, const animation_channel *c)
{
    switch (animation_thing_of(c->path)) {
    case ANIMATED_LIGHT: move_light(a, c); break;
    case ANIMATED_CAMERA: move_camera(a, c); break;
    default:
        if (c->path == PATH_WEIGHTS)
            move_weights(a, c);
        else
            move_node(a, c);
    }
}

static void set_locals(animator *a)
{
    for (size_t i = 0; i < a->scene->node_count; i++) {
        const node_state *n = &a->nodes[i];
        a->out->locals[i] =
            a->moved[i] ? mat4_from_trs(n->translation, n->rotation, n->scale) : node_local_matrix(&a->scene->nodes[i]);
    }
}

static bool open_nodes(animator *a)
{
    const lmn_scene *s = a->scene;
    a->nodes = mem_alloc(s->node_count * sizeof *a->nodes);
    a->moved = mem_calloc(s->node_count, sizeof *a->moved);
    a->out->locals = mem_alloc(s->node_count * sizeof *a->out->locals);
    for (size_t i = 0; a->nodes && i < s->node_count; i++) {
        const node_place *at = node_place_of(&s->nodes[i]);
        memcpy(a->nodes[i].translation, at->translation, sizeof at->translation);
        memcpy(a->nodes[i].rotation, at->rotation, sizeof at->rotation);
        memcpy(a->nodes[i].scale, at->scale, sizeof at->scale);
    }
    return a->nodes && a->moved && a->out->locals;
}

static bool open_values(animator *a, const moment *when)
{
    size_t most = 4;
    for (size_t i = 0; i < when->clip_count; i++) {
        const animation *clip = &a->scene->animations[when->clips[i]];
        for (size_t k = 0; k < clip->channel_count; k++)
            most = clip->channels[k].components > most ? clip->channels[k].components : most;
    }
    a->values = mem_calloc(most, sizeof *a->values);
    return a->values;
}

/* A copy of an array that may be empty. */
static void *copy_of(const void *from, size_t count, size_t size)
{
    void *out = mem_calloc(count, size);
    if (out && count)
        memcpy(out, from, count * size);
    return out;
}

lmn_status animate(animated_state *out, const lmn_scene *scene, const moment *when, lmn_error *error)
{
    animator a = {.out = out, .scene = scene, .seconds = when->seconds};
    memset(out, 0, sizeof *out);
    out->cameras = copy_of(scene->cameras, scene->camera_count, sizeof *out->cameras);
    out->lights = copy_of(scene->lights, scene->light_count, sizeof *out->lights);
    bool done = out->cameras && out->lights;
    if (done && when->clip_count)
        done = open_nodes(&a) && open_weights(&a, when) && open_values(&a, when);
    for (size_t i = 0; i < when->clip_count && done; i++) {
        const animation *clip = &scene->animations[when->clips[i]];
        for (size_t k = 0; k < clip->channel_count; k++)
            move(&a, &clip->channels[k]);
    }
    if (done && when->clip_count)
        set_locals(&a);
    mem_free(a.nodes);
    mem_free(a.moved);
    mem_free(a.values);
    return done ? LMN_OK : error_memory(error);
}

void animated_state_release(animated_state *s)
{
    mem_free(s->locals);
    mem_free(s->weights);
    mem_free(s->weight_data);
    mem_free(s->cameras);
    mem_free(s->lights);
    memset(s, 0, sizeof *s);
}
