/* `limner info --dynamics --json`: what drives what, and when. The keys are documented in docs/reference/info.md and
 * only ever added to. */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "contact/contact.h"
#include "info/info.h"
#include "pose/face.h"

/* A document while it is written: once something of it could not be made, there is none. */
typedef struct writer {
    const lmn_scene *scene;
    const schedule  *s;
    const moment    *clips;
    pose             begin; /* where all is when clips begin */
    bool             is_posed, failed;
} writer;

static void set(writer *w, json_t *object, const char *key, json_t *value)
{
    w->failed = !value || json_object_set_new(object, key, value) != 0 || w->failed;
}

static void append(writer *w, json_t *array, json_t *value)
{
    w->failed = !value || json_array_append_new(array, value) != 0 || w->failed;
}

static json_t *text_or_null(const char *t)
{
    json_t *string = t ? json_string(t) : json_null();
    return string || !t ? string : json_null();
}

static json_t *vector(writer *w, const double v[3])
{
    json_t *array = json_array();
    for (int k = 0; k < 3; k++)
        append(w, array, json_real(isfinite(v[k]) ? v[k] : 0));
    return array;
}

static const char *property_name(animation_path path)
{
    static const char *const names[] = {"translation", "rotation",    "scale",  "weights",
                                        "fov",         "half_height", "colour", "intensity"};
    return names[path];
}

static const char *map_name(const schedule *s, const behaviour_span *span)
{
    static const char *const names[] = {"constant", "linear",    "curve", "tangent", "fall",
                                        "bounce",   "oscillate", "spin",  "follow",  "callback"};
    return span->channel != NONE ? "clip" : names[s->nodes[span->node].map.kind];
}

static json_t *span_json(writer *w, const behaviour_span *span)
{
    const behaviour_node *n = &w->s->nodes[span->node];
    const bool            event = n->kind == BEHAVIOUR_EVENT;
    json_t               *o = json_object();
    set(w, o, "name", text_or_null(n->name));
    set(w, o, "from", json_real(span->from));
    set(w, o, "to", json_real(span->to));
    set(w, o, "kind", json_string(event ? "event" : "constraint"));
    if (!event) {
        set(w, o, "property", json_string(property_name(w->s->properties[span->property].path)));
        set(w, o, "map", json_string(map_name(w->s, span)));
    }
    return o;
}

static json_t *sample_json(writer *w, const trajectory_sample *sample)
{
    json_t *o = json_object();
    set(w, o, "time", json_real(sample->seconds));
    set(w, o, "position", vector(w, sample->position));
    set(w, o, "velocity", vector(w, sample->velocity));
    set(w, o, "acceleration", vector(w, sample->acceleration));
    return o;
}

/* Few samples of long motions: who wants more has limner/behaviour.h, or asks for frames. */
static json_t *trajectory_json(writer *w, int32_t index)
{
    enum { SAMPLES_SHOWN = 2000 };
    trajectory t;
    json_t    *list = json_array();
    double     reach = 0;
    for (int i = 0; i <= 16; i++) {
        mat4 world = schedule_world(w->s, index, w->s->duration * i / 16, SIDE_AT),
             first = schedule_world(w->s, index, 0, SIDE_AT);
        for (int k = 12; k < 15; k++)
            reach = fmax(reach, fabs(world.m[k] - first.m[k]));
    }
    w->failed =
        schedule_trajectory(&t, w->s, index, NULL, 0, w->s->duration, fmax(reach / 500, 1e-9), NULL) != LMN_OK ||
        w->failed;
    for (size_t i = 0; i < t.count && i < SAMPLES_SHOWN && !w->failed; i++)
        append(w, list, sample_json(w, &t.samples[i]));
    trajectory_release(&t);
    return list;
}

/* The strongest ones alone: rest is approached in ever smaller hops. */
static json_t *contacts_json(writer *w, int32_t index)
{
    contact *found = NULL;
    size_t   count = 0;
    double   strongest = 0;
    json_t  *list = json_array();
    w->failed = contacts_find(&found, &count, w->s, w->clips, index, 0, w->s->duration, 0, NULL) != LMN_OK || w->failed;
    for (size_t i = 0; i < count; i++)
        strongest = fmax(strongest, found[i].hit.speed);
    for (size_t i = 0; i < count && !w->failed; i++) {
        const contact *c = &found[i];
        if (c->hit.speed < 0.05 * strongest)
            continue;
        json_t *o = json_object();
        set(w, o, "time", json_real(c->hit.seconds));
        set(w, o, "place", vector(w, c->hit.place));
        set(w, o, "normal", vector(w, c->hit.normal));
        set(w, o, "impulse", json_real(c->hit.speed));
        set(w, o, "other", text_or_null(c->other == NONE ? NULL : w->scene->nodes[c->other].name));
        set(w, o, "other_node", c->other == NONE ? json_null() : json_integer(c->other + 1));
        set(w, o, "distance", json_real(c->distance));
        append(w, list, o);
    }
    mem_free(found);
    return list;
}

/* Does one of the spans drive the node itself? */
static bool is_driven(const schedule *s, const dynamics *d, int32_t index)
{
    for (size_t i = 0; i < d->span_count; i++) {
        const behaviour_span *span = &s->spans[d->spans[i]];
        int32_t target = span->property == NONE ? s->nodes[span->node].target : s->properties[span->property].target;
        if (target == index || (span->property != NONE && s->properties[span->property].path >= PATH_CAMERA_FOV))
            return true;
    }
    return false;
}

/* Where a character's face is when clips begin, as far as its nodes name anything of it; NULL: they do not. */
static json_t *face_json(writer *w, int32_t index)
{
    static const char *const names[] = {"head", "mouth", "eyes"};
    face                     f;
    moment                   when = *w->clips;
    when.seconds = 0;
    if (!w->is_posed)
        w->failed = pose_create(&w->begin, w->scene, &when, NULL) != LMN_OK || w->failed;
    w->is_posed = true;
    if (w->failed || face_find(&f, &w->begin, index, &w->begin.worlds[index].m[12], 0, NULL) != LMN_OK) {
        w->failed = true;
        return NULL;
    }
    const bool named[] = {f.named_head, f.named_mouth, f.named_eyes};
    if (!named[0] && !named[1] && !named[2])
        return NULL;
    json_t *o = json_object(), *eyes = json_array(), *by = json_array();
    set(w, o, "head", vector(w, f.head));
    set(w, o, "mouth", vector(w, f.mouth));
    for (int i = 0; i < 2; i++)
        append(w, eyes, vector(w, f.eyes[i]));
    set(w, o, "eyes", eyes);
    set(w, o, "gaze", vector(w, f.gaze));
    for (int i = 0; i < 3; i++)
        if (named[i])
            append(w, by, json_string(names[i]));
    set(w, o, "named", by);
    return o;
}

/* Nothing of what is not driven and is nothing. */
static void put_node(writer *w, json_t *nodes, int32_t index)
{
    dynamics    d;
    const char *semantics = semantics_of(w->scene, index);
    w->failed = dynamics_create(&d, w->s, index, -INFINITY, INFINITY, NULL) != LMN_OK || w->failed;
    if (!w->failed &&
        (semantics || is_driven(w->s, &d, index) || (d.span_count && w->scene->nodes[index].mesh != NONE))) {
        json_t *o = json_object(), *spans = json_array(), *path = json_array();
        for (size_t i = 0; i < d.path_count; i++)
            append(w, path, text_or_null(w->scene->nodes[d.path[i]].name));
        for (size_t i = 0; i < d.span_count; i++)
            append(w, spans, span_json(w, &w->s->spans[d.spans[i]]));
        set(w, o, "node", text_or_null(w->scene->nodes[index].name));
        set(w, o, "semantics", text_or_null(semantics));
        json_t *where = semantics && strcmp(semantics, "character") == 0 ? face_json(w, index) : NULL;
        if (where)
            set(w, o, "face", where);
        set(w, o, "path", path);
        set(w, o, "constraints", spans);
        if (d.span_count) {
            set(w, o, "trajectory", trajectory_json(w, index));
            set(w, o, "contacts", contacts_json(w, index));
        }
        append(w, nodes, o);
    }
    dynamics_release(&d);
}

static json_t *dynamics_json(writer *w)
{
    json_t *root = json_object(), *nodes = json_array(), *events = json_array();
    for (size_t i = 0; i < w->scene->node_count && !w->failed; i++)
        put_node(w, nodes, (int32_t)i);
    for (size_t i = 0; i < w->s->span_count && !w->failed; i++) {
        const behaviour_span *span = &w->s->spans[i];
        if (w->s->nodes[span->node].kind != BEHAVIOUR_EVENT)
            continue;
        json_t *o = json_object();
        set(w, o, "name", text_or_null(w->s->nodes[span->node].name));
        set(w, o, "time", json_real(span->from));
        append(w, events, o);
    }
    set(w, root, "duration", json_real(w->s->duration));
    set(w, root, "nodes", nodes);
    set(w, root, "events", events);
    return root;
}

char *scene_dynamics_json(const lmn_scene *scene)
{
    schedule   s = {.scene = scene};
    moment     clips;
    writer     w = {.scene = scene, .s = &s, .clips = &clips};
    char      *out = NULL;
    lmn_status status = schedule_of_moment(&s, &clips, scene, NULL, NULL);
    json_t    *root = status == LMN_OK ? dynamics_json(&w) : NULL;
    if (root && !w.failed) {
        char *dumped = json_dumps(root, JSON_INDENT(2));
        out = mem_copy_text(dumped);
        free(dumped);
    }
    json_decref(root);
    if (w.is_posed)
        pose_release(&w.begin);
    schedule_release(&s);
    return out;
}
