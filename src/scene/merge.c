/* Moving a finished scene into another, below a new root. */
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "scene/behaviour.h"
#include "scene/parts.h"
#include "scene/solid.h"

/* Where the elements of `from` begin in `into`. */
typedef struct offsets {
    int32_t nodes, meshes, materials, images, cameras, lights, skins, solids;
} offsets;

/* An empty scene takes the arrays over as they are: then the root has to fit in front of the nodes there. */
static bool reserve_nodes(lmn_scene *into, lmn_scene *from)
{
    lmn_scene *at = into->node_count ? into : from;
    return mem_grow((void **)&at->nodes, &at->node_capacity, into->node_count + from->node_count + 1,
                    sizeof *at->nodes);
}

static bool reserve_all(lmn_scene *into, lmn_scene *from)
{
#define RESERVE(array, count, capacity)                                                                                \
    (into->count == 0 ||                                                                                               \
     mem_grow((void **)&into->array, &into->capacity, into->count + from->count, sizeof *into->array))
    return reserve_nodes(into, from) && RESERVE(meshes, mesh_count, mesh_capacity) &&
           RESERVE(materials, material_count, material_capacity) && RESERVE(images, image_count, image_capacity) &&
           RESERVE(cameras, camera_count, camera_capacity) && RESERVE(lights, light_count, light_capacity) &&
           RESERVE(skins, skin_count, skin_capacity) && RESERVE(animations, animation_count, animation_capacity) &&
           mem_grow((void **)&into->solids, &into->solid_capacity, into->solid_count + 2 * from->solid_count,
                    sizeof *into->solids) &&
           mem_grow((void **)&into->files, &into->file_capacity, into->file_count + 1, sizeof *into->files) &&
           behaviour_reserve(into, from);
#undef RESERVE
}

static void shift(int32_t *index, int32_t by)
{
    if (*index != NONE)
        *index += by;
}

static void shift_channel(animation_channel *c, const offsets *by)
{
    const int32_t steps[] = {
        [ANIMATED_NODE] = by->nodes, [ANIMATED_CAMERA] = by->cameras, [ANIMATED_LIGHT] = by->lights};
    shift(&c->target, steps[animation_thing_of(c->path)]);
}

static void shift_references(lmn_scene *s, const offsets *by)
{
    for (size_t i = 0; i < s->node_count; i++) {
        node    *n = &s->nodes[i];
        int32_t *links[] = {&n->parent, &n->first_child, &n->last_child, &n->next_sibling};
        for (int k = 0; k < 4; k++)
            shift(links[k], by->nodes);
        shift(&n->mesh, by->meshes);
        shift(&n->skin, by->skins);
        shift(&n->camera, by->cameras);
        shift(&n->light, by->lights);
        shift(&n->solid, by->solids);
    }
    for (size_t i = 0; i < s->solid_count; i++)
        for (size_t k = 0; k < s->solids[i].node_count; k++)
            shift(&s->solids[i].nodes[k].mesh, by->meshes);
    for (size_t i = 0; i < s->mesh_count; i++)
        for (size_t k = 0; k < s->meshes[i].primitive_count; k++)
            shift(&s->meshes[i].primitives[k].material, by->materials);
    for (size_t i = 0; i < s->material_count; i++) {
        shift(&s->materials[i].base_texture.image, by->images);
        shift(&s->materials[i].normal_texture.image, by->images);
    }
    for (size_t i = 0; i < s->skin_count; i++)
        for (size_t k = 0; k < s->skins[i].joint_count; k++)
            shift(&s->skins[i].joints[k], by->nodes);
    for (size_t i = 0; i < s->animation_count; i++)
        for (size_t k = 0; k < s->animations[i].channel_count; k++)
            shift_channel(&s->animations[i].channels[k], by);
    for (size_t i = 0; i < s->part_count + s->ghost_count; i++)
        s->parts[i].node += by->nodes;
}

/* 0 … 2, and its sign. */
static int axis_of(char up, int *sign)
{
    bool negative = up >= 'X' && up <= 'Z';
    *sign = negative ? -1 : 1;
    return up - (negative ? 'X' : 'x');
}

/* The one axis goes to the other, and that to the first one's back; where both are one, upside down, around another. */
mat4 scene_up_rotation(char from, char to)
{
    mat4 m = mat4_identity();
    int  from_sign, to_sign, first = axis_of(from, &from_sign), second = axis_of(to, &to_sign),
                            sign = from_sign * to_sign;
    if (from == to || !from || !to)
        return m;
    if (first == second) {
        int other = first == 0 ? 1 : 0;
        for (int k = 0; k < 3; k++)
            m.m[5 * k] = k == other ? 1 : -1;
        return m;
    }
    m.m[5 * first] = m.m[5 * second] = 0;
    m.m[4 * first + second] = sign;
    m.m[4 * second + first] = -sign;
    return m;
}

char scene_up_together(const lmn_scene *into, const lmn_scene *from)
{
    return into->up ? into->up : !from->up || from->up == 'z' ? from->up : 'y';
}

/* The file's name, with a number behind it when another root has it. */
static char *root_name(const lmn_scene *into, const char *file)
{
    char *name = scene_name_of_file(file);
    char *tried = mem_copy_text(name);
    for (size_t number = 2; tried; number++) {
        bool taken = false;
        for (size_t i = 0; i < into->node_count && !taken; i++)
            taken = into->nodes[i].parent == NONE && into->nodes[i].name && strcmp(into->nodes[i].name, tried) == 0;
        if (!taken)
            break;
        text t = {0};
        text_append(&t, "%s#%zu", name, number);
        mem_free(tried);
        tried = text_take(&t);
    }
    mem_free(name);
    return tried;
}

static lmn_status check_capacity(const lmn_scene *into, const lmn_scene *from, const char *file, lmn_error *error)
{
    size_t           vertices = 0, triangles = 0, lines = 0, instances = 0;
    const lmn_scene *both[] = {into, from};
    for (int k = 0; k < 2; k++) {
        for (size_t i = 0; i < both[k]->mesh_count; i++)
            for (size_t j = 0; j < both[k]->meshes[i].primitive_count; j++) {
                vertices += both[k]->meshes[i].primitives[j].vertex_count;
                triangles += both[k]->meshes[i].primitives[j].index_count / 3;
                lines += both[k]->meshes[i].primitives[j].line_count;
            }
        for (size_t i = 0; i < both[k]->node_count; i++)
            instances += both[k]->nodes[i].instance_count;
    }
    const char *what = NULL;
    size_t      limit = 0;
    if (into->node_count + from->node_count + 1 > LIMIT_NODES)
        what = "nodes", limit = LIMIT_NODES;
    else if (vertices > LIMIT_VERTICES)
        what = "vertices", limit = LIMIT_VERTICES;
    else if (triangles > LIMIT_TRIANGLES)
        what = "triangles", limit = LIMIT_TRIANGLES;
    else if (lines > LIMIT_LINES)
        what = "lines", limit = LIMIT_LINES;
    else if (instances > LIMIT_INSTANCES)
        what = "instances", limit = LIMIT_INSTANCES;
    if (!what)
        return LMN_OK;
    return error_in_file(error, LMN_LIMIT, file, 0, "with this file the scene would have more than %zu %s", limit,
                         what);
}

static void swap_arrays(void **a, size_t *a_capacity, void **b, size_t *b_capacity)
{
    void  *array = *a;
    size_t capacity = *a_capacity;
    *a = *b;
    *a_capacity = *b_capacity;
    *b = array;
    *b_capacity = capacity;
}

static void move_nodes(lmn_scene *into, lmn_scene *from, char *name, node_place *place)
{
    size_t count = from->node_count;
    if (into->node_count == 0) {
        swap_arrays((void **)&into->nodes, &into->node_capacity, (void **)&from->nodes, &from->node_capacity);
        memmove(into->nodes + 1, into->nodes, count * sizeof *into->nodes);
    }
    node *root = scene_append_node(into); /* room was reserved */
    root->name = name;
    root->numbered = true; /* after the file, which is no name of a thing */
    root->has_matrix = true;
    root->place = place;
    if (into->node_count > 1 && count)
        memcpy(into->nodes + into->node_count, from->nodes, count * sizeof *into->nodes);
    into->node_count += count;
    from->node_count = 0;
}

/* An empty scene takes arrays over as they are; for others room was reserved. */
static void move_elements(lmn_scene *into, lmn_scene *from)
{
#define MOVE(array, count, capacity)                                                                                   \
    do {                                                                                                               \
        if (into->count && from->count)                                                                                \
            memcpy(into->array + into->count, from->array, from->count * sizeof *from->array);                         \
        else if (!into->count)                                                                                         \
            swap_arrays((void **)&into->array, &into->capacity, (void **)&from->array, &from->capacity);               \
        into->count += from->count;                                                                                    \
        from->count = 0;                                                                                               \
    } while (0)
    MOVE(meshes, mesh_count, mesh_capacity);
    MOVE(materials, material_count, material_capacity);
    MOVE(images, image_count, image_capacity);
    MOVE(cameras, camera_count, camera_capacity);
    MOVE(lights, light_count, light_capacity);
    MOVE(skins, skin_count, skin_capacity);
    MOVE(animations, animation_count, animation_capacity);
#undef MOVE
    if (from->solid_count)
        memcpy(into->solids + into->solid_count, from->solids, from->solid_count * sizeof *from->solids);
    into->solid_count += from->solid_count;
    from->solid_count = 0;
}

/* Ghosts stay behind the ordinary parts of all files; room was reserved. */
static void move_parts(lmn_scene *into, lmn_scene *from)
{
    if (into->part_count + into->ghost_count == 0) {
        mem_free(into->parts);
        into->parts = from->parts;
        into->part_count = from->part_count;
        into->ghost_count = from->ghost_count;
        from->parts = NULL;
        from->part_count = from->ghost_count = 0;
        return;
    }
    part *behind = into->parts + into->part_count;
    if (into->ghost_count)
        memmove(behind + from->part_count, behind, into->ghost_count * sizeof *behind);
    if (from->part_count)
        memcpy(behind, from->parts, from->part_count * sizeof *behind);
    behind += from->part_count + into->ghost_count;
    if (from->ghost_count)
        memcpy(behind, from->parts + from->part_count, from->ghost_count * sizeof *behind);
    into->part_count += from->part_count;
    into->ghost_count += from->ghost_count;
    from->part_count = from->ghost_count = 0;
}

/* Behind this nothing can fail. */
static void commit(lmn_scene *into, lmn_scene *from, char *name, char *path, node_place *place)
{
    offsets by = {(int32_t)into->node_count + 1, (int32_t)into->mesh_count,   (int32_t)into->material_count,
                  (int32_t)into->image_count,    (int32_t)into->camera_count, (int32_t)into->light_count,
                  (int32_t)into->skin_count,     (int32_t)into->solid_count};
    behaviour_take(into, from, &(behaviour_offsets){by.nodes, by.cameras, by.lights, (int32_t)into->animation_count});
    shift_references(from, &by);
    int32_t root = by.nodes - 1;
    move_nodes(into, from, name, place);
    move_elements(into, from);
    move_parts(into, from);
    for (size_t i = (size_t)by.nodes; i < into->node_count; i++)
        if (into->nodes[i].parent == NONE)
            scene_link_child(into, root, (int32_t)i);
    into->files[into->file_count++] = path;
    city_merge(&into->city, &from->city);
    warnings_append(&into->warnings, &from->warnings);
    warnings_release(&from->warnings);
    into->load_ms += from->load_ms;
    into->revision = scene_next_revision();
}

/* Two files of one city have origins of their own. */
static void put_in_place(mat4 *position, const lmn_scene *into, const lmn_scene *from)
{
    double offset[3];
    if (!city_offset(&into->city, &from->city, offset))
        return;
    mat4 up = scene_up_rotation('z', scene_up_together(into, from));
    for (int k = 0; k < 3; k++)
        position->m[12 + k] += up.m[k] * offset[0] + up.m[4 + k] * offset[1] + up.m[8 + k] * offset[2];
}

static bool is_identity(const mat4 *m)
{
    const mat4 identity = mat4_identity();
    return memcmp(m, &identity, sizeof identity) == 0;
}

/* The parts of `from` as they are called in `into`. Its own list goes. In an empty scene at the same place they only
 * get another path, which saves going through the tree once more. */
static bool list_parts(const lmn_scene *into, lmn_scene *from, const char *name, const mat4 *position, part_list *out)
{
    part_list own = {from->parts, from->part_count, from->ghost_count};
    from->parts = NULL;
    from->part_count = from->ghost_count = 0;
    if (into->part_count + into->ghost_count == 0 && own.parts && is_identity(position) && parts_fit(&own, name)) {
        *out = own;
        return parts_put_below(out, name);
    }
    parts_release(own.parts, own.part_count + own.ghost_count);
    return parts_list(from, name, (uint32_t)into->part_count, position, out);
}

static bool reserve_parts(lmn_scene *into, const part_list *more)
{
    size_t had = into->part_count + into->ghost_count;
    part  *grown = had ? mem_realloc(into->parts, (had + more->part_count + more->ghost_count) * sizeof *grown) : NULL;
    into->parts = grown ? grown : into->parts;
    return grown || !had;
}

lmn_status scene_merge(lmn_scene *into, lmn_scene *from, const char *file, lmn_error *error)
{
    lmn_status status = check_capacity(into, from, file, error);
    if (status != LMN_OK)
        return status;
    mat4 position = scene_up_rotation(from->up, scene_up_together(into, from));
    put_in_place(&position, into, from);
    char       *name = root_name(into, file), *path = scene_clean_name(file, strlen(file));
    node_place *place = mem_calloc(1, sizeof *place);
    part_list   list = {.parts = NULL};
    bool good = name && path && place && reserve_all(into, from) && list_parts(into, from, name, &position, &list) &&
                reserve_parts(into, &list);
    if (!good) {
        mem_free(name);
        mem_free(path);
        mem_free(place);
        parts_release(list.parts, list.part_count + list.ghost_count);
        return error_memory(error);
    }
    *place = (node_place){.matrix = position, .rotation = {0, 0, 0, 1}, .scale = {1, 1, 1}};
    from->parts = list.parts;
    from->part_count = list.part_count;
    from->ghost_count = list.ghost_count;
    into->up = scene_up_together(into, from);
    commit(into, from, name, path, place);
    return LMN_OK;
}
