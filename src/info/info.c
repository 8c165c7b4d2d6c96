/* `limner info --json`. The keys are documented in docs/reference/info.md and only ever added to. */
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "info/city_info.h"
#include "info/info.h"
#include "info/mesh_info.h"
#include "info/solid_info.h"

static json_t *real(double value)
{
    return json_real(isfinite(value) ? value : 0);
}

/* Names that do not come from files may hold anything; JSON needs UTF-8. */
static json_t *string_or_null(const char *t)
{
    if (!t)
        return json_null();
    json_t *string = json_string(t);
    if (string)
        return string;
    char *clean = scene_clean_name(t, strlen(t));
    string = clean ? json_string(clean) : NULL;
    mem_free(clean);
    return string;
}

static json_t *vector(vec3 v)
{
    return json_pack("[o,o,o]", real(v.x), real(v.y), real(v.z));
}

static json_t *bounds_json(box3 box)
{
    if (box3_is_empty(box))
        box = (box3){{0, 0, 0}, {0, 0, 0}};
    return json_pack("{s:o,s:o}", "min", vector(box.min), "max", vector(box.max));
}

static json_t *attributes_json(const node *n)
{
    json_t *object = json_object();
    for (size_t i = 0; i < n->attribute_count; i++)
        json_object_set_new(object, n->attributes[i].key, string_or_null(n->attributes[i].value));
    return object;
}

/* Each material once, in the order of the primitives. */
static json_t *part_materials(const lmn_scene *s, const mesh *m)
{
    json_t *list = json_array();
    for (size_t i = 0; m && i < m->primitive_count; i++) {
        int32_t index = m->primitives[i].material;
        bool    seen = false;
        for (size_t k = 0; k < i && !seen && i < 64; k++)
            seen = m->primitives[k].material == index;
        if (!seen && index != NONE)
            json_array_append_new(list, string_or_null(s->materials[index].name));
    }
    return list;
}

/* What is told of a mesh, once for all parts that have it; `told` (may be NULL) holds one for each mesh. */
static json_t *mesh_json(const lmn_scene *s, int32_t index, json_t **told)
{
    if (!told || index == NONE)
        return NULL;
    if (!told[index])
        told[index] = mesh_info_json(&s->meshes[index]);
    return json_incref(told[index]);
}

static json_t *parts_json(const lmn_scene *s, size_t first, size_t count)
{
    json_t  *list = json_array();
    json_t **told = mem_calloc(s->mesh_count + 1, sizeof *told);
    for (size_t i = first; i < first + count; i++) {
        const part *p = &s->parts[i];
        const node *n = &s->nodes[p->node];
        size_t      instances = node_draw_count(n);
        json_t     *entry = json_pack(
                "{s:I,s:o,s:o,s:I,s:I,s:o,s:o,s:o}", "id", (json_int_t)(i + 1), "name", string_or_null(p->name), "path",
                string_or_null(p->path), "triangles", (json_int_t)(p->triangles * instances), "instances",
                (json_int_t)instances, "bounds", bounds_json(p->bounds), "materials",
                part_materials(s, n->mesh != NONE ? &s->meshes[n->mesh] : NULL), "attributes", attributes_json(n));
        json_t *edges = mesh_json(s, n->mesh, told);
        if (entry && edges)
            json_object_set_new(entry, "mesh", edges);
        else
            json_decref(edges);
        if (entry && p->lines)
            json_object_set_new(entry, "lines", json_integer((json_int_t)(p->lines * instances)));
        if (entry && n->solid != NONE) {
            const solid *tree = &s->solids[n->solid];
            json_object_set_new(entry, "solid", solid_info_json(s, tree, bounds_json(solid_bounds(tree))));
        }
        json_array_append_new(list, entry);
    }
    for (size_t i = 0; told && i < s->mesh_count; i++)
        json_decref(told[i]);
    mem_free(told);
    return list;
}

/* How many things an animation moves: nodes by their position, rotation or scale, nodes by their weights, cameras,
 * lights. */
typedef struct moved_counts {
    size_t nodes, weights, cameras, lights;
} moved_counts;

/* `seen` holds for each node, camera and light the number of the animation that it was counted for last. */
static moved_counts count_moved(const lmn_scene *s, const animation *a, uint32_t *seen, uint32_t number)
{
    moved_counts counts = {0};
    for (size_t i = 0; i < a->channel_count; i++) {
        const animation_channel *c = &a->channels[i];
        size_t                   slot = (size_t)c->target, *count = &counts.nodes;
        if (c->path == PATH_WEIGHTS) {
            counts.weights++;
            continue;
        }
        if (animation_thing_of(c->path) == ANIMATED_CAMERA) {
            slot += s->node_count;
            count = &counts.cameras;
        } else if (animation_thing_of(c->path) == ANIMATED_LIGHT) {
            slot += s->node_count + s->camera_count;
            count = &counts.lights;
        }
        *count += seen[slot] != number;
        seen[slot] = number;
    }
    return counts;
}

static json_t *animations_json(const lmn_scene *s)
{
    json_t   *list = json_array();
    uint32_t *seen = mem_calloc(s->node_count + s->camera_count + s->light_count, sizeof *seen);
    for (size_t i = 0; seen && i < s->animation_count; i++) {
        const animation *a = &s->animations[i];
        moved_counts     n = count_moved(s, a, seen, (uint32_t)i + 1);
        json_array_append_new(list, json_pack("{s:I,s:o,s:o,s:I,s:{s:I,s:I,s:I,s:I}}", "id", (json_int_t)(i + 1),
                                              "name", string_or_null(a->name), "duration", real(a->duration),
                                              "channels", (json_int_t)a->channel_count, "moves", "nodes",
                                              (json_int_t)n.nodes, "weights", (json_int_t)n.weights, "cameras",
                                              (json_int_t)n.cameras, "lights", (json_int_t)n.lights));
    }
    mem_free(seen);
    return list;
}

static json_t *materials_json(const lmn_scene *s)
{
    static const char *const modes[] = {"opaque", "mask", "blend"};
    json_t                  *list = json_array();
    for (size_t i = 0; i < s->material_count; i++) {
        const material *m = &s->materials[i];
        json_t         *entry =
            json_pack("{s:o,s:[o,o,o,o],s:s,s:b,s:b}", "name", string_or_null(m->name), "base_colour",
                      real(m->base_colour.x), real(m->base_colour.y), real(m->base_colour.z), real(m->base_colour.w),
                      "alpha", modes[m->alpha], "double_sided", m->double_sided, "unlit", m->unlit);
        int32_t texture = m->base_texture.image;
        if (entry)
            json_object_set_new(entry, "texture", texture == NONE ? json_null() : json_integer(texture));
        json_array_append_new(list, entry);
    }
    return list;
}

static json_t *textures_json(const lmn_scene *s)
{
    json_t *list = json_array();
    for (size_t i = 0; i < s->image_count; i++) {
        const image *m = &s->images[i];
        json_array_append_new(list,
                              json_pack("{s:o,s:[I,I],s:b}", "name", string_or_null(m->name), "size",
                                        (json_int_t)m->width, (json_int_t)m->height, "loaded", m->pixels != NULL));
    }
    return list;
}

static json_t *cameras_json(const lmn_scene *s)
{
    json_t      *list = json_array();
    char         numbered[CAMERA_NAME_CAPACITY];
    const char **node_names = mem_calloc(s->camera_count, sizeof *node_names);
    for (size_t i = s->node_count; node_names && i-- > 0;)
        if (s->nodes[i].camera != NONE && s->nodes[i].name)
            node_names[s->nodes[i].camera] = s->nodes[i].name;
    for (size_t i = 0; node_names && i < s->camera_count; i++) {
        const camera *c = &s->cameras[i];
        json_t       *angle = c->orthographic ? json_null() : real(c->fov_y * 57.295779513082320877);
        json_array_append_new(
            list, json_pack("{s:o,s:s,s:o}", "name", string_or_null(scene_camera_name(s, i, node_names[i], numbered)),
                            "projection", c->orthographic ? "orthographic" : "perspective", "fov_deg", angle));
    }
    mem_free(node_names);
    return list;
}

static json_t *lights_json(const lmn_scene *s)
{
    static const char *const types[] = {"directional", "point", "spot"};
    json_t                  *list = json_array();
    for (size_t i = 0; i < s->light_count; i++) {
        const light *l = &s->lights[i];
        json_array_append_new(list, json_pack("{s:o,s:s,s:o}", "name", string_or_null(l->name), "type", types[l->type],
                                              "intensity", real(l->intensity)));
    }
    return list;
}

static json_t *skins_json(const lmn_scene *s)
{
    json_t *list = json_array();
    for (size_t i = 0; i < s->skin_count; i++)
        json_array_append_new(list, json_pack("{s:o,s:I}", "name", string_or_null(s->skins[i].name), "joints",
                                              (json_int_t)s->skins[i].joint_count));
    return list;
}

static json_t *warnings_json(const lmn_scene *s)
{
    json_t *list = json_array();
    for (size_t i = 0; i < s->warnings.count; i++) {
        const warning *w = &s->warnings.items[i];
        json_array_append_new(list, json_pack("{s:s,s:o,s:I}", "code", warning_code_text(w->code), "text",
                                              string_or_null(w->text), "count", (json_int_t)w->count));
    }
    return list;
}

static json_t *files_json(const lmn_scene *s)
{
    json_t *list = json_array();
    for (size_t i = 0; i < s->file_count; i++)
        json_array_append_new(list, string_or_null(s->files[i]));
    return list;
}

char *scene_info_json(const lmn_scene *s)
{
    uint64_t triangles = 0, lines = 0;
    box3     box = box3_empty();
    for (size_t i = 0; i < s->part_count; i++) {
        triangles += s->parts[i].triangles * node_draw_count(&s->nodes[s->parts[i].node]);
        lines += s->parts[i].lines * node_draw_count(&s->nodes[s->parts[i].node]);
        box = box3_union(box, s->parts[i].bounds);
    }
    const char up[2] = {s->up ? s->up : 'y', '\0'};
    json_t    *root =
        json_pack("{s:o,s:I,s:I,s:I,s:I,s:o,s:s}", "files", files_json(s), "triangles", (json_int_t)triangles, "lines",
                  (json_int_t)lines, "nodes", (json_int_t)scene_plain_node_count(s), "meshes",
                  (json_int_t)(s->mesh_count - s->spare_meshes), "bounds", bounds_json(box), "up", up);
    if (!root)
        return NULL;
    json_object_set_new(root, "load_ms", real(s->load_ms));
    json_object_set_new(root, "parts", parts_json(s, 0, s->part_count));
    json_object_set_new(root, "removed", parts_json(s, s->part_count, s->ghost_count));
    json_object_set_new(root, "animations", animations_json(s));
    json_object_set_new(root, "materials", materials_json(s));
    json_object_set_new(root, "textures", textures_json(s));
    json_object_set_new(root, "cameras", cameras_json(s));
    json_object_set_new(root, "lights", lights_json(s));
    json_object_set_new(root, "skins", skins_json(s));
    json_object_set_new(root, "city", city_info_json(s));
    json_object_set_new(root, "warnings", warnings_json(s));
    /* Floats have nine digits; more would print 0.100000001490116. */
    char *dumped = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    json_decref(root);
    char *copy = mem_copy_text(dumped);
    free(dumped);
    return copy;
}
