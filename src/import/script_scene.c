/* What stands in a script's scene: nodes with shapes, models, cameras and lights. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "base/vector3.h"
#include "import/access.h"
#include "import/build.h"
#include "import/script.h"
#include "scene/channel.h"

enum { NAMES_MAX = 256 };

const script_node *script_find_declared(script_reader *r, const char *name)
{
    for (size_t i = 0; i < r->node_count; i++)
        if (strcmp(r->nodes[i].name, name) == 0)
            return &r->nodes[i];
    return NULL;
}

int32_t script_find_node(script_reader *r, const char *name)
{
    const char        *names[NAMES_MAX];
    size_t             count = 0;
    const script_node *declared = script_find_declared(r, name);
    if (declared)
        return declared->node;
    for (size_t i = 0; i < r->scene->node_count; i++)
        if (r->scene->nodes[i].name && strcmp(r->scene->nodes[i].name, name) == 0)
            return (int32_t)i;
    for (size_t i = 0; i < r->node_count && count < NAMES_MAX; i++)
        names[count++] = r->nodes[i].name;
    const char *nearest = text_nearest(name, names, count);
    script_fail(r, LMN_FORMAT, "there is no node '%.100s'%s%.100s%s", name, nearest ? "; did you mean '" : "",
                nearest ? nearest : "", nearest ? "'?" : "");
    return NONE;
}

/* --- where it stands ------------------------------------------------------------------------------------- */

/* Turns −z to a direction and y as near to up as may be, as cameras look. */
static void look_along(script_reader *r, const double direction[3], double out[4])
{
    double up[3] = {0, r->scene->up == 'y', r->scene->up == 'z'}, m[3][3];
    for (int k = 0; k < 3; k++)
        m[2][k] = -direction[k];
    if (!vector3_normalise_sure(m[2]))
        return;
    vector3_cross(m[0], up, m[2]);
    if (!vector3_normalise_sure(m[0])) {
        memcpy(m[0], (double[3]){1, 0, 0}, sizeof m[0]);
    }
    vector3_cross(m[1], m[2], m[0]);
    double four[4] = {1 + m[0][0] - m[1][1] - m[2][2], 1 - m[0][0] + m[1][1] - m[2][2], 1 - m[0][0] - m[1][1] + m[2][2],
                      1 + m[0][0] + m[1][1] + m[2][2]};
    int    most = 0;
    for (int k = 1; k < 4; k++)
        most = four[k] > four[most] ? k : most;
    /* Rows of m are the columns of the rotation. */
    const double twice[3] = {m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]};
    for (int k = 0; k < 4; k++)
        out[k] = k == most ? four[k] : k == 3 || most == 3 ? twice[k == 3 ? most : k] : m[k][most] + m[most][k];
    quaternion_normalise(out);
}

bool script_rotation(script_reader *r, json_t *value, double out[4])
{
    double axis[3], angle = 0;
    if (json_is_array(value) && json_array_size(value) == 4) {
        double square = 0;
        for (size_t k = 0; k < 4; k++) {
            out[k] = json_number_value(json_array_get(value, k));
            square += out[k] * out[k];
        }
        if (isfinite(square) && square > 1e-12) {
            quaternion_normalise(out);
            return true;
        }
    }
    if (json_is_object(value)) {
        script_check_keys(r, value, "axis angle");
        bool there = script_vector(r, value, "axis", 3, 1, axis);
        if (there && script_number(r, value, "angle", r->file->angle, &angle) && vector3_normalise_sure(axis)) {
            for (int k = 0; k < 3; k++)
                out[k] = axis[k] * sin(angle / 2);
            out[3] = cos(angle / 2);
            return true;
        }
    }
    script_fail(r, LMN_FORMAT, "a rotation is four numbers x, y, z, w, or an object with axis and angle");
    return false;
}

static void place_node(script_reader *r, json_t *object, int32_t index)
{
    double t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1}, at[3];
    script_vector(r, object, "translation", 3, r->file->length, t);
    json_t *rotation = json_object_get(object, "rotation");
    if (rotation && script_enter(r, "rotation", 0)) {
        script_rotation(r, rotation, q);
        script_leave(r);
    }
    if (json_is_number(json_object_get(object, "scale"))) {
        script_number(r, object, "scale", 1, &s[0]);
        s[1] = s[2] = s[0];
    } else {
        script_vector(r, object, "scale", 3, 1, s);
    }
    if (script_vector(r, object, "look_at", 3, r->file->length, at)) {
        const double along[3] = {at[0] - t[0], at[1] - t[1], at[2] - t[2]};
        look_along(r, along, q);
    }
    node_place *own = node_own_place(&r->scene->nodes[index]);
    if (!own) {
        script_out_of_memory(r);
        return;
    }
    memcpy(own->translation, t, sizeof t);
    memcpy(own->rotation, q, sizeof q);
    memcpy(own->scale, s, sizeof s);
}

/* --- what it is ------------------------------------------------------------------------------------------ */

static void read_camera(script_reader *r, json_t *object, int32_t index)
{
    camera *c = scene_append_camera(r->scene);
    double  fov = 0.5235987755982988;
    if (!c) {
        script_out_of_memory(r);
        return;
    }
    script_check_keys(r, object, "fov half_height near far");
    script_number(r, object, "fov", r->file->angle, &fov);
    c->orthographic = script_number(r, object, "half_height", r->file->length, &c->half_height);
    c->fov_y = fov;
    c->near = 0.01;
    script_number(r, object, "near", r->file->length, &c->near);
    script_number(r, object, "far", r->file->length, &c->far);
    if (!(fov > 0 && fov < 3.1) || !(c->near > 0) || c->far < 0 || (c->orthographic && !(c->half_height > 0)))
        script_fail(r, LMN_FORMAT, "a camera sees an angle above 0 and below 178 degrees, from a distance above 0 on");
    r->scene->nodes[index].camera = (int32_t)r->scene->camera_count - 1;
}

static void read_light(script_reader *r, json_t *object, int32_t index)
{
    static const char *const types[] = {"directional", "point", "spot", NULL};
    light                   *l = scene_append_light(r->scene);
    double                   linear[3], intensity = 1, range = 0;
    if (!l) {
        script_out_of_memory(r);
        return;
    }
    script_check_keys(r, object, "type colour intensity range");
    l->type = (light_type)script_choice(r, object, "type", types, 0);
    json_t *value = json_object_get(object, "colour");
    for (int k = 0; value && script_colour(r, value, linear) && k < 3; k++)
        l->colour[k] = (float)linear[k];
    script_number(r, object, "intensity", 1, &intensity);
    script_number(r, object, "range", r->file->length, &range);
    if (!(intensity >= 0) || !(range >= 0))
        script_fail(r, LMN_FORMAT, "a light's intensity and range are not below 0");
    l->intensity = (float)intensity;
    l->range = (float)range;
    r->scene->nodes[index].light = (int32_t)r->scene->light_count - 1;
}

/* Puts a model below the node, with its animations. */
static void read_model(script_reader *r, const char *name, int32_t index, script_node *declared)
{
    lmn_scene *loaded = NULL, *s = r->scene;
    char      *path = file_beside(r->file->path, name);
    int32_t    root = (int32_t)s->node_count;
    if (!path) {
        script_out_of_memory(r);
        return;
    }
    declared->first_clip = (int32_t)s->animation_count;
    r->status = import_named_file(&loaded, r->job, path, r->error);
    if (r->status == LMN_OK)
        r->status = scene_merge(s, loaded, path, r->error);
    if (r->status == LMN_OK)
        scene_link_child(s, index, root);
    declared->clip_count = (int32_t)s->animation_count - declared->first_clip;
    scene_free(loaded);
    mem_free(path);
}

static void read_content(script_reader *r, json_t *object, int32_t index, script_node *declared)
{
    static const char *const shapes[] = {"sphere", "box", "cylinder", "cone", "plane"};
    int                      found = 0;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        if (!script_member(r, object, shapes[i], JSON_OBJECT) || !script_enter(r, shapes[i], 0))
            continue;
        found++;
        int32_t mesh_index = script_shape(r, object, shapes[i]);
        script_leave(r);
        r->scene->nodes[index].mesh = mesh_index;
    }
    const char *model = script_text(r, object, "model");
    json_t     *seen = script_member(r, object, "camera", JSON_OBJECT),
           *lit = script_member(r, object, "light", JSON_OBJECT);
    if (found + (model != NULL) > 1)
        script_fail(r, LMN_FORMAT, "a node has one shape or one model");
    if (model && script_enter(r, "model", 0)) {
        read_model(r, model, index, declared);
        script_leave(r);
    }
    if (seen && script_enter(r, "camera", 0)) {
        read_camera(r, seen, index);
        script_leave(r);
    }
    if (lit && script_enter(r, "light", 0)) {
        read_light(r, lit, index);
        script_leave(r);
    }
}

static void read_attributes(script_reader *r, json_t *object, int32_t index)
{
    const char *semantics = script_text(r, object, "semantics"), *key;
    json_t     *value, *list = script_member(r, object, "attributes", JSON_OBJECT);
    if (semantics && !build_attribute(&r->scene->nodes[index], "semantics", semantics))
        script_out_of_memory(r);
    json_object_foreach(list, key, value)
    {
        if (!json_is_string(value))
            script_fail(r, LMN_FORMAT, "the attribute '%.60s' has to be a text", key);
        else if (!build_attribute(&r->scene->nodes[index], key, json_string_value(value)))
            script_out_of_memory(r);
    }
}

static void read_node(script_reader *r, json_t *object)
{
    if (!json_is_object(object)) {
        script_fail(r, LMN_FORMAT, "a node has to be an object");
        return;
    }
    script_check_keys(r, object,
                      "name parent sphere box cylinder cone plane model camera light colour translation rotation scale "
                      "look_at semantics attributes");
    const char *name = script_text(r, object, "name"), *parent = script_text(r, object, "parent");
    int32_t     index = (int32_t)r->scene->node_count, above = NONE;
    if (r->status == LMN_OK && (!name || !*name))
        script_fail(r, LMN_FORMAT, "a node needs a name");
    if (r->status == LMN_OK && script_find_declared(r, name))
        script_fail(r, LMN_FORMAT, "there are two nodes '%.100s'", name);
    if (parent && script_enter(r, "parent", 0)) {
        above = script_find_node(r, parent);
        script_leave(r);
    }
    if (r->status != LMN_OK)
        return;
    node *n = scene_append_node(r->scene);
    if (!n || !mem_grow((void **)&r->nodes, &r->node_capacity, r->node_count + 1, sizeof *r->nodes)) {
        script_out_of_memory(r);
        return;
    }
    n->name = scene_clean_name(name, strlen(name));
    if (!n->name)
        script_out_of_memory(r);
    scene_link_child(r->scene, above, index);
    script_node declared = {name, index, 0, 0};
    place_node(r, object, index);
    read_content(r, object, index, &declared);
    read_attributes(r, object, index);
    r->nodes[r->node_count++] = declared;
}

void script_read_nodes(script_reader *r, json_t *list)
{
    for (size_t i = 0; i < json_array_size(list) && script_enter(r, NULL, i); i++) {
        read_node(r, json_array_get(list, i));
        script_leave(r);
    }
}
