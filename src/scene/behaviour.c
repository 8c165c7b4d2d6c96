#include "scene/behaviour.h"

#include <string.h>

#include "base/memory.h"

typedef struct behaviour behaviour;

static behaviour *behaviour_of(lmn_scene *s)
{
    if (!s->behaviour) {
        s->behaviour = mem_calloc(1, sizeof *s->behaviour);
        if (s->behaviour)
            s->behaviour->written = NONE;
    }
    return s->behaviour;
}

behaviour_node behaviour_blank(behaviour_kind kind)
{
    behaviour_node n;
    memset(&n, 0, sizeof n);
    n.kind = kind;
    n.duration = -1;
    n.times = 1;
    n.exponent = 1;
    n.target = n.clip = n.map.other = NONE;
    n.fit = FIT_START;
    return n;
}

int32_t behaviour_append(lmn_scene *s, behaviour_kind kind)
{
    behaviour *b = behaviour_of(s);
    if (!b || b->node_count >= INT32_MAX - 1 ||
        !mem_grow((void **)&b->nodes, &b->node_capacity, b->node_count + 1, sizeof *b->nodes))
        return NONE;
    b->nodes[b->node_count] = behaviour_blank(kind);
    return (int32_t)b->node_count++;
}

void behaviour_node_release(behaviour_node *n)
{
    if (n->map.release)
        n->map.release(n->map.user);
    mem_free(n->name);
    mem_free(n->children);
    mem_free(n->map.values);
    mem_free(n->map.times);
}

void behaviour_take_back(lmn_scene *s)
{
    behaviour_node_release(&s->behaviour->nodes[--s->behaviour->node_count]);
}

bool behaviour_append_child(lmn_scene *s, int32_t parent, int32_t child, double start, double duration)
{
    behaviour_node *n = &s->behaviour->nodes[parent];
    if (!mem_grow((void **)&n->children, &n->child_capacity, n->child_count + 1, sizeof *n->children))
        return false;
    n->children[n->child_count++] = (behaviour_child){child, start, duration};
    return true;
}

bool behaviour_append_root(lmn_scene *s, int32_t root)
{
    behaviour *b = s->behaviour;
    if (!mem_grow((void **)&b->roots, &b->root_capacity, b->root_count + 1, sizeof *b->roots))
        return false;
    b->roots[b->root_count++] = root;
    return true;
}

bool behaviour_target_exists(const lmn_scene *s, animation_path path, int32_t target)
{
    size_t count = 0;
    switch (animation_thing_of(path)) {
    case ANIMATED_NODE: count = s->node_count; break;
    case ANIMATED_CAMERA: count = s->camera_count; break;
    case ANIMATED_LIGHT: count = s->light_count; break;
    }
    return target >= 0 && (size_t)target < count;
}

int32_t behaviour_target_of(const lmn_scene *s, animation_path path, int32_t node_index)
{
    switch (animation_thing_of(path)) {
    case ANIMATED_CAMERA: return s->nodes[node_index].camera;
    case ANIMATED_LIGHT: return s->nodes[node_index].light;
    default: return node_index;
    }
}

size_t behaviour_components(const lmn_scene *s, animation_path path, int32_t target)
{
    const node *n = &s->nodes[path == PATH_WEIGHTS ? target : 0];
    switch (path) {
    case PATH_TRANSLATION:
    case PATH_SCALE:
    case PATH_LIGHT_COLOUR: return 3;
    case PATH_ROTATION: return 4;
    case PATH_WEIGHTS:
        return n->morph_weights ? n->morph_weight_count : n->mesh != NONE ? s->meshes[n->mesh].morph_weight_count : 0;
    default: return 1;
    }
}

void behaviour_free(behaviour *b)
{
    if (!b)
        return;
    for (size_t i = 0; i < b->node_count; i++)
        behaviour_node_release(&b->nodes[i]);
    mem_free(b->nodes);
    mem_free(b->roots);
    mem_free(b);
}

/* --- into another scene --------------------------------------------------------------------------------- */

bool behaviour_reserve(lmn_scene *into, const lmn_scene *from)
{
    const behaviour *more = from->behaviour;
    if (!more)
        return true;
    behaviour *b = behaviour_of(into);
    return b && mem_grow((void **)&b->nodes, &b->node_capacity, b->node_count + more->node_count, sizeof *b->nodes) &&
           mem_grow((void **)&b->roots, &b->root_capacity, b->root_count + more->root_count, sizeof *b->roots);
}

static void shift(int32_t *index, int32_t by)
{
    if (*index != NONE)
        *index += by;
}

static void shift_node(behaviour_node *n, int32_t before, const behaviour_offsets *by)
{
    const int32_t steps[] = {
        [ANIMATED_NODE] = by->nodes, [ANIMATED_CAMERA] = by->cameras, [ANIMATED_LIGHT] = by->lights};
    for (size_t k = 0; k < n->child_count; k++)
        shift(&n->children[k].node, before);
    shift(&n->target, n->kind == BEHAVIOUR_CONSTRAINT ? steps[animation_thing_of(n->path)] : by->nodes);
    shift(&n->map.other, by->nodes);
    shift(&n->clip, by->animations);
}

void behaviour_take(lmn_scene *into, lmn_scene *from, const behaviour_offsets *by)
{
    behaviour *b = into->behaviour, *more = from->behaviour;
    if (!more)
        return;
    int32_t before = (int32_t)b->node_count;
    for (size_t i = 0; i < more->node_count; i++) {
        shift_node(&more->nodes[i], before, by);
        b->nodes[b->node_count++] = more->nodes[i];
    }
    for (size_t i = 0; i < more->root_count; i++)
        b->roots[b->root_count++] = more->roots[i] + before;
    if (more->written != NONE)
        b->written = more->written + by->animations;
    more->node_count = 0;
    behaviour_free(more);
    from->behaviour = NULL;
}
