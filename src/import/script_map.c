/* Maps of scripts: what a property does in the time of its constraint. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "behaviour/map.h"
#include "import/script.h"

/* What is read for one constraint; pointers into the graph move while it grows. */
typedef struct map_reader {
    script_reader  *r;
    json_t         *object;
    behaviour_node *n;
    behaviour_map  *m;
    double          unit; /* of the property's numbers */
} map_reader;

static double unit_of(const script_reader *r, const behaviour_node *n)
{
    if (n->path == PATH_TRANSLATION || n->path == PATH_CAMERA_HALF_HEIGHT)
        return r->file->length;
    return n->path == PATH_CAMERA_FOV || n->about ? r->file->angle : 1;
}

/* One value into `out`; numbers stand for arrays of one. */
static void read_value(map_reader *q, json_t *value, double *out)
{
    size_t n = q->m->components;
    double linear[3];
    if (q->n->path == PATH_ROTATION && !q->n->about) {
        script_rotation(q->r, value, out);
        return;
    }
    if (q->n->path == PATH_LIGHT_COLOUR && json_is_string(value)) {
        if (script_colour(q->r, value, linear))
            memcpy(out, linear, sizeof linear);
        return;
    }
    bool right = n == 1 && json_is_number(value);
    if (right)
        out[0] = json_number_value(value) * q->unit;
    else
        right = json_is_array(value) && json_array_size(value) == n;
    for (size_t k = 0; right && k < n && json_is_array(value); k++) {
        right = json_is_number(json_array_get(value, k));
        out[k] = json_number_value(json_array_get(value, k)) * q->unit;
    }
    if (!right)
        script_fail(q->r, LMN_FORMAT, "a value of this property has to be %zu number%s", n, n == 1 ? "" : "s");
}

static bool room_for_values(map_reader *q, size_t count)
{
    q->m->values = mem_calloc(count * q->m->components, sizeof *q->m->values);
    q->m->value_count = count;
    return q->m->values || script_out_of_memory(q->r);
}

static void read_values(map_reader *q, json_t *list, const char *key)
{
    if (!script_enter(q->r, key, 0))
        return;
    if (!json_is_array(list))
        script_fail(q->r, LMN_FORMAT, "'%s' has to be an array of values", key);
    else if (room_for_values(q, json_array_size(list)))
        for (size_t i = 0; i < json_array_size(list) && script_enter(q->r, NULL, i); i++) {
            read_value(q, json_array_get(list, i), q->m->values + i * q->m->components);
            script_leave(q->r);
        }
    script_leave(q->r);
}

static void read_times(map_reader *q)
{
    json_t *list = script_member(q->r, q->object, "times", JSON_ARRAY);
    if (!list)
        return;
    size_t  count = json_array_size(list);
    double *times = mem_calloc(count, sizeof *times);
    q->m->times = times;
    if (!times)
        script_out_of_memory(q->r);
    else if (script_vector(q->r, q->object, "times", q->m->value_count, q->r->file->time, times) && count)
        return;
}

static void read_curve(map_reader *q, const char *key)
{
    static const char *const kinds[] = {"bezier", "catmull-rom", NULL}, *const ways[] = {"parameter", "length", NULL};
    script_reader *r = q->r;
    json_t        *curve = script_member(r, q->object, key, JSON_OBJECT);
    if (!curve || !script_enter(r, key, 0))
        return;
    bool tangent = strcmp(key, "tangent") == 0;
    script_check_keys(r, curve, "points kind closed by forward up");
    q->m->curve = (curve_kind)script_choice(r, curve, "kind", kinds, CURVE_CATMULL_ROM);
    q->m->by_length = script_choice(r, curve, "by", ways, 0) == 1;
    q->m->closed = script_flag(r, curve, "closed");
    if (tangent) {
        q->m->components = 3;
        q->unit = r->file->length;
        script_vector(r, curve, "forward", 3, 1, q->m->forward);
        script_vector(r, curve, "up", 3, 1, q->m->up);
    }
    json_t *points = json_object_get(curve, "points");
    /* Points of a tangent are places, whatever the property is. */
    animation_path path = q->n->path;
    q->n->path = tangent ? PATH_TRANSLATION : path;
    read_values(q, points, "points");
    q->n->path = path;
    script_leave(r);
}

static void read_function(map_reader *q)
{
    static const char *const names[] = {"fall", "bounce", "oscillate", "spin", "follow", NULL};
    static const map_kind    kinds[] = {MAP_FALL, MAP_BOUNCE, MAP_OSCILLATE, MAP_SPIN, MAP_FOLLOW};
    script_reader           *r = q->r;
    behaviour_map           *m = q->m;
    double                   length = r->file->length, rate = r->file->time;
    m->kind = kinds[script_choice(r, q->object, "function", names, 0)];
    if (m->kind == MAP_OSCILLATE) {
        if (m->components > 3)
            script_fail(r, LMN_FORMAT, "only properties of up to three numbers oscillate");
        else if (m->components == 1) {
            script_number(r, q->object, "start", q->unit, m->start);
            script_number(r, q->object, "amplitude", q->unit, m->velocity);
        } else {
            script_vector(r, q->object, "start", 3, q->unit, m->start);
            script_vector(r, q->object, "amplitude", 3, q->unit, m->velocity);
        }
        script_number(r, q->object, "frequency", 1 / rate, &m->frequency);
        script_number(r, q->object, "phase", 1, &m->phase);
        return;
    }
    if (m->kind == MAP_SPIN) {
        script_vector(r, q->object, "axis", 3, 1, m->axis);
        script_number(r, q->object, "rate", r->file->angle / rate, &m->rate);
        script_number(r, q->object, "phase", r->file->angle, &m->phase);
        return;
    }
    if (!script_vector(r, q->object, "start", 3, length, m->start) && q->n->path == PATH_TRANSLATION)
        memcpy(m->start, node_place_of(&r->scene->nodes[q->n->target])->translation, sizeof m->start);
    script_vector(r, q->object, "velocity", 3, length / rate, m->velocity);
    script_vector(r, q->object, "gravity", 3, length / (rate * rate), m->gravity);
    script_number(r, q->object, "floor", length, &m->floor);
    script_number(r, q->object, "restitution", 1, &m->restitution);
    script_number(r, q->object, "delay", rate, &m->delay);
    script_vector(r, q->object, "offset", 3, length, m->offset);
    const char *other = script_text(r, q->object, "node");
    if (other && script_enter(r, "node", 0)) {
        m->other = script_find_node(r, other);
        script_leave(r);
    } else if (m->kind == MAP_FOLLOW) {
        script_fail(r, LMN_FORMAT, "who follows names a node");
    }
}

void script_read_map(script_reader *r, json_t *object, int32_t index)
{
    behaviour_node          *n = &r->scene->behaviour->nodes[index];
    map_reader               q = {r, object, n, &n->map, 1};
    int                      maps = 0;
    static const char *const keys[] = {"constant", "linear", "curve", "tangent", "function"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        maps += json_object_get(object, keys[i]) != NULL;
    if (maps != 1)
        script_fail(r, LMN_FORMAT, "a constraint has one map: constant, linear, curve, tangent or function");
    if (n->path == PATH_ROTATION && !json_object_get(object, "function") && json_object_get(object, "axis"))
        n->about = script_vector(r, object, "axis", 3, 1, n->axis);
    q.m->components = n->about ? 1 : behaviour_components(r->scene, n->path, n->target);
    q.unit = unit_of(r, n);
    map_defaults(q.m, r->scene);
    if (r->status != LMN_OK)
        return;
    if (json_object_get(object, "constant")) {
        q.m->kind = MAP_CONSTANT;
        if (room_for_values(&q, 1) && script_enter(r, "constant", 0)) {
            read_value(&q, json_object_get(object, "constant"), q.m->values);
            script_leave(r);
        }
    } else if (json_object_get(object, "linear")) {
        q.m->kind = MAP_LINEAR;
        read_values(&q, json_object_get(object, "linear"), "linear");
        read_times(&q);
    } else if (json_object_get(object, "curve")) {
        q.m->kind = MAP_CURVE;
        read_curve(&q, "curve");
    } else if (json_object_get(object, "tangent")) {
        q.m->kind = MAP_TANGENT;
        read_curve(&q, "tangent");
    } else {
        read_function(&q);
    }
}
