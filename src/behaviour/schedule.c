/* What everything needs, and when everything is. */
#include "behaviour/schedule.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"
#include "behaviour/map.h"

/* --- requirements --------------------------------------------------------------------------------------- */

enum { UNSEEN, OPEN, DONE };

typedef struct measuring {
    const lmn_scene        *scene;
    const struct behaviour *graph;
    requirement            *all;
    lmn_error              *error;
} measuring;

static lmn_status measure(measuring *m, int32_t index, uint32_t depth);

static void measure_leaf(measuring *m, int32_t index)
{
    const behaviour_node *n = &m->graph->nodes[index];
    requirement          *r = &m->all[index];
    r->leaves = 1;
    if (n->kind == BEHAVIOUR_CLIP) {
        r->own = m->scene->animations[n->clip].duration;
        r->leaves = m->scene->animations[n->clip].channel_count;
    } else if (n->kind == BEHAVIOUR_CONSTRAINT) {
        r->own = n->duration >= 0 ? n->duration : map_requirement(&n->map);
    }
}

/* What a child of this kind of parent adds. */
static lmn_status add_child(measuring *m, int32_t index, const behaviour_child *c)
{
    const behaviour_node *n = &m->graph->nodes[index];
    requirement          *r = &m->all[index];
    const requirement    *child = &m->all[c->node];
    double                needed = c->duration >= 0 && n->kind == BEHAVIOUR_TABLE ? c->duration : child->needed;
    if (n->kind == BEHAVIOUR_TABLE && c->duration >= 0 && !(child->needed > 0))
        return behaviour_refuse(n, (size_t)index, LMN_FORMAT, m->error, "gives an event a duration");
    r->own = n->kind == BEHAVIOUR_SEQUENCE                      ? r->own + needed
             : n->kind == BEHAVIOUR_TABLE                       ? fmax(r->own, c->start + needed)
             : n->kind == BEHAVIOUR_REPEAT                      ? needed * n->times
             : n->fit == FIT_SHRINK && needed > 0 && r->own > 0 ? fmin(r->own, needed)
                                                                : fmax(r->own, needed);
    r->height = child->height + 1 > r->height ? child->height + 1 : r->height;
    r->leaves += child->leaves * (n->kind == BEHAVIOUR_REPEAT ? n->times : 1); /* both below 2^32: no overflow */
    if (r->leaves > BEHAVIOUR_SPANS_MAX)
        return behaviour_refuse(n, (size_t)index, LMN_LIMIT, m->error,
                                "comes to more than %d activities, repeats counted", BEHAVIOUR_SPANS_MAX);
    return LMN_OK;
}

static lmn_status measure_group(measuring *m, int32_t index, uint32_t depth)
{
    const behaviour_node *n = &m->graph->nodes[index];
    lmn_status            status = LMN_OK;
    for (size_t i = 0; i < n->child_count && status == LMN_OK; i++) {
        status = measure(m, n->children[i].node, depth + 1);
        if (status == LMN_OK)
            status = add_child(m, index, &n->children[i]);
    }
    if (status == LMN_OK && n->duration >= 0 && !(n->duration > 0 && m->all[index].own > 0))
        status = behaviour_refuse(n, (size_t)index, LMN_FORMAT, m->error,
                                  n->duration > 0 ? "has a duration and nothing in it that lasts" : "lasts no time");
    return status;
}

static lmn_status measure(measuring *m, int32_t index, uint32_t depth)
{
    const behaviour_node *n = &m->graph->nodes[index];
    requirement          *r = &m->all[index];
    if (r->state == OPEN)
        return behaviour_refuse(n, (size_t)index, LMN_FORMAT, m->error, "contains itself");
    if (depth + r->height > BEHAVIOUR_DEPTH_MAX)
        return behaviour_refuse(n, (size_t)index, LMN_LIMIT, m->error, "lies deeper than %d levels",
                                BEHAVIOUR_DEPTH_MAX);
    if (r->state == DONE)
        return LMN_OK;
    r->state = OPEN;
    lmn_status status = behaviour_check(m->scene, m->graph, index, m->error);
    if (status == LMN_OK && n->kind >= BEHAVIOUR_CONSTRAINT)
        measure_leaf(m, index);
    else if (status == LMN_OK)
        status = measure_group(m, index, depth);
    if (status == LMN_OK && !(r->own <= 1e9))
        status =
            behaviour_refuse(n, (size_t)index, LMN_FORMAT, m->error, "lasts %g s, and at most 1e9 are allowed", r->own);
    r->needed = n->duration >= 0 ? n->duration : r->own;
    r->state = DONE;
    return status;
}

lmn_status behaviour_requirements(requirement **out, const lmn_scene *scene, const struct behaviour *b,
                                  lmn_error *error)
{
    measuring m = {scene, b, mem_calloc(b->node_count, sizeof *m.all), error};
    *out = m.all;
    lmn_status status = m.all ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < b->root_count && status == LMN_OK; i++)
        status = measure(&m, b->roots[i], 1);
    return status;
}

/* --- spans ---------------------------------------------------------------------------------------------- */

/* Steps from global time on, the last one first; those above lie in the frames of the calls above. */
typedef struct step_link {
    const struct step_link *above;
    time_step               step;
} step_link;

/* Where a node stands: its interval, and the way from global time to its allotment, which runs from 0 to `allotted`. */
typedef struct position {
    double    from, to, allotted;
    bool      open_from, open_to;
    bool      reversed; /* does its own time run against the global one? */
    step_link chain;
    size_t    count;
} position;

typedef struct laying {
    schedule          *s;
    const requirement *all;
    lmn_error         *error;
    uint64_t           visits;
} laying;

/* Behind the chain of `p`, a copy of `of`: t becomes offset + scale · t. Two such steps are one. */
static void then(position *p, const position *of, double scale, double offset)
{
    time_step *last = &p->chain.step;
    if (last->exponent == 1) {
        last->offset = offset + scale * last->offset;
        last->scale *= scale;
    } else {
        p->chain = (step_link){&of->chain, {scale, offset, 0, 1}};
        p->count++;
    }
}

static double step_back(const time_step *step, double t)
{
    if (step->exponent != 1)
        t = step->length * pow(fmin(fmax(t / step->length, 0), 1), 1 / step->exponent);
    return (t - step->offset) / step->scale;
}

static double chain_back(const step_link *chain, double t)
{
    for (; chain; chain = chain->above)
        t = step_back(&chain->step, t);
    return t;
}

static double forwards(const time_step *steps, size_t count, double t)
{
    for (size_t i = 0; i < count; i++) {
        t = steps[i].offset + steps[i].scale * t;
        if (steps[i].exponent != 1)
            t = steps[i].length * pow(fmin(fmax(t / steps[i].length, 0), 1), steps[i].exponent);
    }
    return t;
}

static double backwards(const time_step *steps, size_t count, double t)
{
    for (size_t i = count; i-- > 0;)
        t = step_back(&steps[i], t);
    return t;
}

/* The position of something that has the interval begin … end of its parent's own time. Ends that are the parent's are
 * exactly its. */
static void place(position *out, const position *parent, double own, double begin, double end, bool open_begin,
                  bool open_end)
{
    double low = parent->reversed ? parent->to : parent->from, high = parent->reversed ? parent->from : parent->to;
    bool   open_low = parent->reversed ? parent->open_to : parent->open_from,
         open_high = parent->reversed ? parent->open_from : parent->open_to;
    *out = *parent;
    double first = begin <= 0 ? low : begin >= own ? high : chain_back(&parent->chain, begin);
    double last = end >= own ? high : end <= 0 ? low : chain_back(&parent->chain, end);
    bool   open_first = open_begin || (begin <= 0 && open_low), open_last = open_end || (end >= own && open_high);
    out->from = parent->reversed ? last : first;
    out->to = parent->reversed ? first : last;
    out->open_from = parent->reversed ? open_last : open_first;
    out->open_to = parent->reversed ? open_first : open_last;
    out->allotted = end - begin;
    then(out, parent, 1, -begin);
}

static lmn_status lay(laying *l, int32_t index, const position *given);

static lmn_status add_span(laying *l, int32_t index, const position *p, int32_t channel, double length)
{
    schedule *s = l->s;
    if (s->step_count + p->count > BEHAVIOUR_STEPS_MAX)
        return error_set(l->error, LMN_LIMIT, "the behaviour takes more than %d steps of time", BEHAVIOUR_STEPS_MAX);
    if (!mem_grow((void **)&s->spans, &s->span_capacity, s->span_count + 1, sizeof *s->spans) ||
        !mem_grow((void **)&s->steps, &s->step_capacity, s->step_count + p->count, sizeof *s->steps))
        return error_memory(l->error);
    size_t behind = s->step_count + p->count;
    for (const step_link *at = &p->chain; at; at = at->above)
        s->steps[--behind] = at->step;
    bool event = s->nodes[index].kind == BEHAVIOUR_EVENT;
    s->spans[s->span_count++] = (behaviour_span){.node = index,
                                                 .channel = channel,
                                                 .from = p->from,
                                                 .to = p->to,
                                                 .open_from = !event && p->open_from,
                                                 .open_to = !event && p->open_to,
                                                 .length = length,
                                                 .step = s->step_count,
                                                 .step_count = p->count,
                                                 .property = NONE};
    s->step_count += p->count;
    return LMN_OK;
}

static lmn_status lay_clip(laying *l, int32_t index, const position *p)
{
    const schedule  *s = l->s;
    const animation *a = &s->scene->animations[s->nodes[index].clip];
    lmn_status       status = LMN_OK;
    for (size_t i = 0; i < a->channel_count && status == LMN_OK; i++)
        if (a->channels[i].key_count > 0)
            status = add_span(l, index, p, (int32_t)i, l->all[index].own);
    return status;
}

/* One child after the other. The last that lasts owns its end. */
static lmn_status lay_sequence(laying *l, int32_t index, const position *p)
{
    const behaviour_node *n = &l->s->nodes[index];
    double                own = l->all[index].own, at = 0;
    size_t                last = 0;
    lmn_status            status = LMN_OK;
    for (size_t i = 0; i < n->child_count; i++)
        if (l->all[n->children[i].node].needed > 0)
            last = i;
    for (size_t i = 0; i < n->child_count && status == LMN_OK; i++) {
        double   needed = l->all[n->children[i].node].needed, end = i >= last ? own : at + needed;
        position child;
        place(&child, p, own, at, end, false, i < last);
        child.allotted = needed;
        status = lay(l, n->children[i].node, &child);
        at = end;
    }
    return status;
}

static lmn_status lay_together(laying *l, int32_t index, const position *p)
{
    const behaviour_node *n = &l->s->nodes[index];
    double                own = l->all[index].own;
    lmn_status            status = LMN_OK;
    for (size_t i = 0; i < n->child_count && status == LMN_OK; i++) {
        const behaviour_child *c = &n->children[i];
        double                 needed = l->all[c->node].needed, begin = 0;
        if (n->kind == BEHAVIOUR_TABLE) {
            begin = c->start;
            needed = c->duration >= 0 ? c->duration : needed;
        } else if ((n->fit == FIT_STRETCH || n->fit == FIT_SHRINK) && needed > 0) {
            needed = own;
        } else {
            begin = n->fit == FIT_CENTRE ? (own - needed) / 2 : n->fit == FIT_END ? own - needed : 0;
        }
        double   end = n->kind == BEHAVIOUR_SIMULTANEITY && n->fit == FIT_END ? own : begin + needed;
        position child;
        place(&child, p, own, begin, end, false, false);
        child.allotted = needed;
        status = lay(l, c->node, &child);
    }
    return status;
}

static lmn_status lay_modified(laying *l, int32_t index, const position *p)
{
    const behaviour_node *n = &l->s->nodes[index];
    int32_t               below = n->children[0].node;
    double                own = l->all[index].own, needed = l->all[below].needed;
    position              child = *p;
    lmn_status            status = LMN_OK;
    if (n->kind == BEHAVIOUR_REPEAT) {
        for (uint32_t i = 0; i < n->times && status == LMN_OK; i++) {
            bool last = i + 1 == n->times;
            place(&child, p, own, i * needed, last ? own : (i + 1) * needed, false, !last && needed > 0);
            child.allotted = needed;
            status = lay(l, below, &child);
        }
        return status;
    }
    if (n->kind == BEHAVIOUR_REVERSE) {
        then(&child, p, -1, own);
        child.reversed = !child.reversed;
    } else if (n->exponent != 1 && own > 0) {
        then(&child, p, 1, 0);
        child.chain.step.length = own;
        child.chain.step.exponent = n->exponent;
    }
    child.allotted = own;
    return lay(l, below, &child);
}

/* From what it is given to what it has by itself, and on to what is in it. */
static lmn_status lay(laying *l, int32_t index, const position *given)
{
    const behaviour_node *n = &l->s->nodes[index];
    double                own = l->all[index].own;
    position              p = *given;
    if (l->visits++ > 4 * (uint64_t)BEHAVIOUR_SPANS_MAX)
        return behaviour_refuse(n, (size_t)index, LMN_LIMIT, l->error, "is reached too often");
    if (work_stopped())
        return work_check(l->error);
    if (own > 0 && p.allotted != own)
        then(&p, given, own / p.allotted, 0);
    switch (n->kind) {
    case BEHAVIOUR_SEQUENCE: return lay_sequence(l, index, &p);
    case BEHAVIOUR_SIMULTANEITY:
    case BEHAVIOUR_TABLE: return lay_together(l, index, &p);
    case BEHAVIOUR_CLIP: return lay_clip(l, index, &p);
    case BEHAVIOUR_CONSTRAINT:
    case BEHAVIOUR_EVENT: return add_span(l, index, &p, NONE, own);
    default: return lay_modified(l, index, &p);
    }
}

static lmn_status lay_roots(schedule *s, const struct behaviour *b, lmn_error *error)
{
    requirement *all = NULL;
    lmn_status   status = behaviour_requirements(&all, s->scene, b, error);
    laying       l = {s, all, error, 0};
    for (size_t i = 0; i < b->root_count && status == LMN_OK; i++) {
        double   needed = all[b->roots[i]].needed;
        position p = {.to = needed, .allotted = needed, .chain = {NULL, {1, 0, 0, 1}}, .count = 1};
        s->duration = fmax(s->duration, needed);
        status = lay(&l, b->roots[i], &p);
    }
    mem_free(all);
    return status;
}

/* --- the whole ------------------------------------------------------------------------------------------ */

static lmn_status measure_curves(schedule *s, lmn_error *error)
{
    s->curves = mem_calloc(s->node_count, sizeof *s->curves);
    bool good = s->curves;
    for (size_t i = 0; good && i < s->node_count; i++) {
        const behaviour_map *m = &s->nodes[i].map;
        if (s->nodes[i].kind == BEHAVIOUR_CONSTRAINT && (m->kind == MAP_CURVE || m->kind == MAP_TANGENT) &&
            m->by_length && !map_fault(s->scene, &s->nodes[i]))
            good = curve_measure(&s->curves[i], m);
    }
    return good ? LMN_OK : error_memory(error);
}

static lmn_status lay_out(schedule *s, const struct behaviour *b, lmn_error *error)
{
    s->nodes = b->nodes;
    s->node_count = b->node_count;
    lmn_status status = lay_roots(s, b, error);
    if (status == LMN_OK)
        status = measure_curves(s, error);
    return status == LMN_OK ? schedule_find_drivers(s, error) : status;
}

lmn_status schedule_create(schedule *out, const lmn_scene *scene, lmn_error *error)
{
    static const struct behaviour nothing;
    *out = (schedule){.scene = scene};
    return lay_out(out, scene->behaviour ? scene->behaviour : &nothing, error);
}

/* Behind its last key a channel only holds what it has. */
static void narrow_to_keys(schedule *s)
{
    for (size_t i = 0; i < s->span_count; i++) {
        behaviour_span          *span = &s->spans[i];
        const animation_channel *c = span_channel(s, span);
        double                   last = (double)c->times[c->key_count - 1];
        if (c->key_count > 1 && last > span->from)
            span->to = fmin(span->to, last);
    }
}

lmn_status schedule_of_clips(schedule *out, const lmn_scene *scene, const uint32_t *clips, size_t count,
                             lmn_error *error)
{
    *out = (schedule){.scene = scene};
    lmn_scene holder = {.node_count = 0}; /* the calls that make graphs want a scene to put them into */
    bool      good = true;
    for (size_t i = 0; i < count && good; i++) {
        int32_t at = scene->animations[clips[i]].duration > 0 ? behaviour_append(&holder, BEHAVIOUR_CLIP) : NONE;
        good = at != NONE ? behaviour_append_root(&holder, at) : !(scene->animations[clips[i]].duration > 0);
        if (at != NONE)
            holder.behaviour->nodes[at].clip = (int32_t)clips[i];
    }
    out->own = holder.behaviour;
    if (!good)
        return error_memory(error);
    if (!out->own)
        return LMN_OK;
    out->nodes = out->own->nodes;
    out->node_count = out->own->node_count;
    lmn_status status = lay_roots(out, out->own, error);
    if (status == LMN_OK)
        status = measure_curves(out, error);
    if (status == LMN_OK)
        narrow_to_keys(out);
    return status == LMN_OK ? schedule_find_drivers(out, error) : status;
}

void schedule_release(schedule *s)
{
    for (size_t i = 0; i < s->property_count; i++) {
        mem_free(s->properties[i].times);
        mem_free(s->properties[i].drivers);
    }
    for (size_t i = 0; s->curves && i < s->node_count; i++)
        mem_free(s->curves[i].lengths);
    mem_free(s->spans);
    mem_free(s->steps);
    mem_free(s->properties);
    mem_free(s->of_property);
    mem_free(s->curves);
    behaviour_free(s->own);
    memset(s, 0, sizeof *s);
}

/* --- one span ------------------------------------------------------------------------------------------- */

bool span_is_alive(const behaviour_span *s, double t)
{
    return (s->open_from ? t > s->from : t >= s->from) && (s->open_to ? t < s->to : t <= s->to);
}

double span_local(const schedule *s, const behaviour_span *span, double t)
{
    return fmin(fmax(forwards(s->steps + span->step, span->step_count, t), 0), span->length);
}

double span_global(const schedule *s, const behaviour_span *span, double local)
{
    return fmin(fmax(backwards(s->steps + span->step, span->step_count, local), span->from), span->to);
}

const animation_channel *span_channel(const schedule *s, const behaviour_span *span)
{
    return span->channel == NONE ? NULL : &s->scene->animations[s->nodes[span->node].clip].channels[span->channel];
}
