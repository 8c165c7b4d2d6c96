#include "behaviour/inspect.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

bool span_meets(const behaviour_span *s, double from, double to)
{
    bool begins = s->open_from ? to > s->from : to >= s->from, ends = s->open_to ? from < s->to : from <= s->to;
    return begins && ends;
}

/* Does the property belong to a node, or to the camera or light that it has? */
static bool belongs(const lmn_scene *scene, const behaviour_property *p, int32_t index)
{
    const node *n = &scene->nodes[index];
    switch (animation_thing_of(p->path)) {
    case ANIMATED_CAMERA: return n->camera == p->target;
    case ANIMATED_LIGHT: return n->light == p->target;
    default: return p->target == index;
    }
}

static bool concerns(const schedule *s, const behaviour_span *span, const dynamics *d)
{
    for (size_t i = 0; i < d->path_count; i++)
        if (span->property == NONE ? s->nodes[span->node].target == d->path[i]
                                   : belongs(s->scene, &s->properties[span->property], d->path[i]))
            return true;
    return false;
}

lmn_status dynamics_create(dynamics *out, const schedule *s, int32_t node_index, double from, double to,
                           lmn_error *error)
{
    size_t depth = 0, capacity = 0;
    *out = (dynamics){.path = NULL};
    for (int32_t at = node_index; at != NONE; at = s->scene->nodes[at].parent)
        depth++;
    out->path = mem_calloc(depth, sizeof *out->path);
    if (!out->path)
        return error_memory(error);
    out->path_count = depth;
    for (int32_t at = node_index; at != NONE; at = s->scene->nodes[at].parent)
        out->path[--depth] = at;
    for (size_t i = 0; i < s->span_count; i++) {
        if (!span_meets(&s->spans[i], from, to) || !concerns(s, &s->spans[i], out))
            continue;
        if (!mem_grow((void **)&out->spans, &capacity, out->span_count + 1, sizeof *out->spans))
            return error_memory(error);
        out->spans[out->span_count++] = i;
    }
    return LMN_OK;
}

void dynamics_release(dynamics *d)
{
    mem_free(d->path);
    mem_free(d->spans);
    memset(d, 0, sizeof *d);
}
