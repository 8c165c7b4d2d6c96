/* `limner info --dynamics --json`: what drives what, and when. The keys are documented in docs/reference/info.md and
 * only ever added to. */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "behaviour/inspect.h"
#include "info/info.h"
#include "pose/moment.h"

static json_t *text_or_null(const char *t)
{
    json_t *string = t ? json_string(t) : json_null();
    return string ? string : json_null();
}

static json_t *vector(const double v[3])
{
    json_t *array = json_array();
    for (int k = 0; k < 3; k++)
        json_array_append_new(array, json_real(isfinite(v[k]) ? v[k] : 0));
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

static json_t *span_json(const schedule *s, const behaviour_span *span)
{
    const behaviour_node *n = &s->nodes[span->node];
    json_t *o = json_pack("{s:o,s:f,s:f}", "name", text_or_null(n->name), "from", span->from, "to", span->to);
    bool    event = n->kind == BEHAVIOUR_EVENT;
    json_object_set_new(o, "kind", json_string(event ? "event" : "constraint"));
    if (!event) {
        json_object_set_new(o, "property", json_string(property_name(s->properties[span->property].path)));
        json_object_set_new(o, "map", json_string(map_name(s, span)));
    }
    return o;
}

/* Few samples of long motions: who wants more has limner/behaviour.h's way, or asks for frames. */
static bool put_trajectory(json_t *object, const schedule *s, int32_t index)
{
    enum { SAMPLES_SHOWN = 2000 };
    trajectory t;
    json_t    *list = json_array();
    double     reach = 0;
    for (int i = 0; i <= 16; i++) {
        mat4 world = schedule_world(s, index, s->duration * i / 16, SIDE_AT),
             first = schedule_world(s, index, 0, SIDE_AT);
        for (int k = 12; k < 15; k++)
            reach = fmax(reach, fabs(world.m[k] - first.m[k]));
    }
    bool done = schedule_trajectory(&t, s, index, NULL, 0, s->duration, fmax(reach / 500, 1e-9), NULL) == LMN_OK;
    for (size_t i = 0; i < t.count && i < SAMPLES_SHOWN; i++)
        json_array_append_new(list, json_pack("{s:f,s:o,s:o,s:o}", "time", t.samples[i].seconds, "position",
                                              vector(t.samples[i].position), "velocity", vector(t.samples[i].velocity),
                                              "acceleration", vector(t.samples[i].acceleration)));
    trajectory_release(&t);
    json_object_set_new(object, "trajectory", list);
    return done;
}

/* NULL: memory is gone, or nothing drives it and it is nothing. */
static json_t *node_json(const schedule *s, int32_t index, bool *failed)
{
    dynamics    d;
    const char *semantics = semantics_of(s->scene, index);
    bool        own = false;
    *failed = dynamics_create(&d, s, index, -INFINITY, INFINITY, NULL) != LMN_OK;
    json_t *o = NULL, *spans = json_array(), *path = json_array();
    for (size_t i = 0; i < d.span_count; i++) {
        const behaviour_span *span = &s->spans[d.spans[i]];
        int32_t target = span->property == NONE ? s->nodes[span->node].target : s->properties[span->property].target;
        own =
            own || target == index || (span->property != NONE && s->properties[span->property].path >= PATH_CAMERA_FOV);
        json_array_append_new(spans, span_json(s, span));
    }
    for (size_t i = 0; i < d.path_count; i++)
        json_array_append_new(path, text_or_null(s->scene->nodes[d.path[i]].name));
    if (!*failed && (own || semantics || (d.span_count && s->scene->nodes[index].mesh != NONE))) {
        o = json_pack("{s:o,s:o,s:O,s:O}", "node", text_or_null(s->scene->nodes[index].name), "semantics",
                      text_or_null(semantics), "path", path, "constraints", spans);
        if (d.span_count)
            *failed = !put_trajectory(o, s, index);
    }
    json_decref(path);
    json_decref(spans);
    dynamics_release(&d);
    return o;
}

char *scene_dynamics_json(const lmn_scene *scene)
{
    schedule   s = {.scene = scene};
    moment     when = moment_at_rest();
    bool       failed = false;
    lmn_status status =
        scene->behaviour && scene->behaviour->root_count ? LMN_OK : moment_find(&when, scene, NULL, 0, NULL, NULL);
    if (status == LMN_OK && scene->behaviour && scene->behaviour->root_count)
        status = schedule_create(&s, scene, NULL);
    else if (status == LMN_OK)
        status = schedule_of_clips(&s, scene, when.clips, when.clip_count, NULL);
    json_t *nodes = json_array(), *events = json_array(), *root = NULL;
    for (size_t i = 0; status == LMN_OK && i < scene->node_count && !failed; i++) {
        json_t *o = node_json(&s, (int32_t)i, &failed);
        if (o)
            json_array_append_new(nodes, o);
    }
    for (size_t i = 0; status == LMN_OK && i < s.span_count; i++)
        if (s.nodes[s.spans[i].node].kind == BEHAVIOUR_EVENT)
            json_array_append_new(events, json_pack("{s:o,s:f}", "name", text_or_null(s.nodes[s.spans[i].node].name),
                                                    "time", s.spans[i].from));
    if (status == LMN_OK && !failed)
        root = json_pack("{s:f,s:O,s:O}", "duration", s.duration, "nodes", nodes, "events", events);
    char *dumped = root ? json_dumps(root, JSON_INDENT(2)) : NULL, *out = mem_copy_text(dumped);
    free(dumped);
    json_decref(root);
    json_decref(nodes);
    json_decref(events);
    schedule_release(&s);
    return out;
}
