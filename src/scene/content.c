#include "scene/content.h"

#include <math.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "scene/parts.h"

static lmn_status list_now(lmn_scene *s, lmn_error *error)
{
    part_list list;
    if (!parts_list(s, NULL, 0, NULL, &list))
        return error_memory(error);
    parts_release(s->parts, s->part_count + s->ghost_count);
    s->parts = list.parts;
    s->part_count = list.part_count;
    s->ghost_count = list.ghost_count;
    return LMN_OK;
}

lmn_status scene_list_parts(lmn_scene *s, lmn_error *error)
{
    lmn_status status = s->changes_open ? LMN_OK : list_now(s, error);
    if (status == LMN_OK)
        s->revision = scene_next_revision();
    return status;
}

void scene_begin_changes(lmn_scene *s)
{
    s->changes_open++;
    s->revision = scene_next_revision();
}

lmn_status scene_end_changes(lmn_scene *s, lmn_error *error)
{
    if (s->changes_open == 0)
        return error_set(error, LMN_USAGE, "lmn_scene_end_changes: no changes have begun");
    lmn_status status = s->changes_open == 1 ? list_now(s, error) : LMN_OK;
    if (status == LMN_OK) {
        s->changes_open--;
        s->revision = scene_next_revision();
    }
    return status;
}

void scene_drop_changes(lmn_scene *s)
{
    s->changes_open--;
    s->revision = scene_next_revision();
}

/* --- where parts are ------------------------------------------------------------------------------------ */

static bool is_far(box3 b)
{
    const float farthest = 1e18f; /* squares of single precision overflow beyond */
    float       reach[6] = {b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z};
    bool        far = false;
    for (int k = 0; k < 6; k++)
        far = far || !(fabsf(reach[k]) <= farthest);
    return far && !box3_is_empty(b);
}

static bool is_below(const lmn_scene *s, int32_t n, int32_t root)
{
    while (n != NONE && n != root)
        n = s->nodes[n].parent;
    return n == root;
}

typedef bool touches_fn(const lmn_scene *s, int32_t node_index, int32_t what);

static bool has_mesh(const lmn_scene *s, int32_t node_index, int32_t mesh_index)
{
    return s->nodes[node_index].mesh == mesh_index;
}

/* New boxes of the parts that this touches: all of them, or with an error none. Skinned ones may be moved by nodes that
 * are not above them. */
static lmn_status measure_parts(lmn_scene *s, touches_fn *touches, int32_t what, lmn_error *error)
{
    size_t count = s->part_count + s->ghost_count;
    mat4  *worlds = s->changes_open ? NULL : scene_world_matrices(s, NULL);
    box3  *boxes = worlds ? mem_alloc((count + 1) * sizeof *boxes) : NULL;
    if (!s->changes_open && !boxes) {
        mem_free(worlds);
        return error_memory(error);
    }
    lmn_status status = LMN_OK;
    for (size_t i = 0; boxes && i < count && status == LMN_OK; i++) {
        const node *n = &s->nodes[s->parts[i].node];
        boxes[i] = s->parts[i].bounds;
        if (touches(s, s->parts[i].node, what) || n->skin != NONE)
            boxes[i] = node_bounds(s, worlds, s->parts[i].node, NULL, NULL);
        if (is_far(boxes[i]))
            status = error_set(error, LMN_FORMAT, "part '%.100s' would lie farther than 1e18 from the origin",
                               s->parts[i].name);
    }
    for (size_t i = 0; boxes && i < count && status == LMN_OK; i++)
        s->parts[i].bounds = boxes[i];
    mem_free(worlds);
    mem_free(boxes);
    if (status == LMN_OK)
        s->revision = scene_next_revision();
    return status;
}

/* --- nodes ---------------------------------------------------------------------------------------------- */

static void unlink_node(lmn_scene *s, int32_t index)
{
    node *n = &s->nodes[index];
    if (n->parent == NONE)
        return;
    node   *above = &s->nodes[n->parent];
    int32_t before = NONE;
    for (int32_t i = above->first_child; i != index; i = s->nodes[i].next_sibling)
        before = i;
    if (before == NONE)
        above->first_child = n->next_sibling;
    else
        s->nodes[before].next_sibling = n->next_sibling;
    if (above->last_child == index)
        above->last_child = before;
    n->parent = n->next_sibling = NONE;
}

static int depth_of(const lmn_scene *s, int32_t index)
{
    int depth = 0;
    for (; index != NONE; index = s->nodes[index].parent)
        depth++;
    return depth;
}

lmn_status scene_add_node(lmn_scene *s, const node *wanted, lmn_error *error)
{
    if (s->node_count >= LIMIT_NODES)
        return error_set(error, LMN_LIMIT, "more than %zu nodes", LIMIT_NODES);
    if (depth_of(s, wanted->parent) >= LIMIT_NODE_DEPTH)
        return error_set(error, LMN_LIMIT, "the node tree is deeper than %d", LIMIT_NODE_DEPTH);
    node *n = scene_append_node(s);
    if (!n)
        return error_memory(error);
    int32_t index = (int32_t)s->node_count - 1;
    *n = *wanted;
    n->parent = NONE;
    scene_link_child(s, wanted->parent, index);
    lmn_status status = scene_list_parts(s, error);
    for (size_t i = 0; status == LMN_OK && i < s->part_count; i++)
        if (!s->changes_open && s->parts[i].node == index && is_far(s->parts[i].bounds))
            status = error_set(error, LMN_FORMAT, "the node would lie farther than 1e18 from the origin");
    if (status == LMN_OK)
        return LMN_OK;
    unlink_node(s, index);
    s->node_count--;
    if (status == LMN_FORMAT)
        return scene_list_parts(s, NULL) == LMN_OK ? status : error_memory(error);
    return status;
}

lmn_status scene_move_node(lmn_scene *s, int32_t index, const mat4 *matrix, lmn_error *error)
{
    node      *n = &s->nodes[index];
    const bool had = n->has_matrix;
    const mat4 before = node_place_of(n)->matrix;
    if (!node_set_matrix(n, matrix))
        return error_memory(error);
    lmn_status status = measure_parts(s, is_below, index, error);
    if (status != LMN_OK) {
        n->has_matrix = had;
        n->place->matrix = before;
    }
    return status;
}

lmn_status scene_set_instances(lmn_scene *s, int32_t index, mat4 *instances, size_t count, lmn_error *error)
{
    node   before = s->nodes[index];
    size_t total = count;
    for (size_t i = 0; i < s->node_count; i++)
        total += (int32_t)i == index ? 0 : s->nodes[i].instance_count;
    if (total > LIMIT_INSTANCES)
        return error_set(error, LMN_LIMIT, "more than %zu instances", LIMIT_INSTANCES);
    s->nodes[index].instances = instances;
    s->nodes[index].instance_count = (uint32_t)count;
    lmn_status status = measure_parts(s, is_below, index, error);
    if (status == LMN_OK)
        mem_free(before.instances);
    else
        s->nodes[index] = before;
    return status;
}

lmn_status scene_remove_node(lmn_scene *s, int32_t index, lmn_error *error)
{
    for (int32_t n = index; n != NONE; n = scene_next_node(s, index, n))
        if (s->nodes[n].solid != NONE)
            return error_set(error, LMN_USAGE, "a solid belongs to node %d", (int)n + 1);
    size_t below = 0, k = 0;
    for (int32_t n = index; n != NONE; n = scene_next_node(s, index, n))
        below++;
    node *kept = mem_alloc(below * sizeof *kept);
    if (!kept)
        return error_memory(error);
    for (int32_t n = index; n != NONE; n = scene_next_node(s, index, n))
        kept[k++] = s->nodes[n];
    k = 0;
    for (int32_t n = index; n != NONE; n = scene_next_node(s, index, n)) {
        s->nodes[n].mesh = s->nodes[n].skin = s->nodes[n].camera = s->nodes[n].light = NONE;
        s->nodes[n].removed = true;
    }
    lmn_status status = scene_list_parts(s, error);
    for (int32_t n = index; n != NONE && status != LMN_OK; n = scene_next_node(s, index, n))
        s->nodes[n] = kept[k++];
    if (status == LMN_OK)
        unlink_node(s, index);
    mem_free(kept);
    return status;
}

void scene_hide_node(lmn_scene *s, int32_t index, bool hidden)
{
    if (s->nodes[index].hidden != hidden)
        s->revision = scene_next_revision();
    s->nodes[index].hidden = hidden;
}

bool scene_is_hidden(const lmn_scene *s, int32_t index)
{
    while (index != NONE && !s->nodes[index].hidden)
        index = s->nodes[index].parent;
    return index != NONE;
}

const char *scene_attribute_of(const lmn_scene *scene, int32_t node_index, const char *key)
{
    for (; node_index >= 0 && (size_t)node_index < scene->node_count; node_index = scene->nodes[node_index].parent) {
        const node *n = &scene->nodes[node_index];
        for (size_t i = 0; i < n->attribute_count; i++)
            if (strcmp(n->attributes[i].key, key) == 0)
                return n->attributes[i].value ? n->attributes[i].value : "";
    }
    return NULL;
}

lmn_status scene_set_attribute(lmn_scene *s, int32_t index, const char *key, const char *value, lmn_error *error)
{
    node  *n = &s->nodes[index];
    size_t at = 0;
    while (at < n->attribute_count && strcmp(n->attributes[at].key, key) != 0)
        at++;
    bool      known = at < n->attribute_count;
    attribute made = {NULL, NULL};
    bool      good = (!value || attribute_make(&made, key, value)) && node_own_facts(n);
    if (good && !known && value) {
        attribute *more = mem_realloc(n->attributes, (n->attribute_count + 1) * sizeof *more);
        good = more != NULL;
        n->attributes = more ? more : n->attributes;
    }
    if (!good || (!known && !value)) {
        attribute_release(&made);
        return good ? LMN_OK : error_memory(error);
    }
    if (known)
        attribute_release(&n->attributes[at]);
    if (value) {
        n->attributes[at] = made;
        n->attribute_count += !known;
    } else {
        n->attributes[at] = n->attributes[--n->attribute_count];
    }
    s->revision = scene_next_revision();
    return LMN_OK;
}

/* --- meshes --------------------------------------------------------------------------------------------- */

lmn_status scene_check_mesh(const lmn_scene *s, int32_t index, const primitive *wanted, lmn_error *error)
{
    uint64_t vertices = wanted->vertex_count, triangles = wanted->index_count / 3, lines = wanted->line_count;
    for (size_t i = 0; i < s->mesh_count; i++)
        for (size_t k = 0; (int32_t)i != index && k < s->meshes[i].primitive_count; k++) {
            vertices += s->meshes[i].primitives[k].vertex_count;
            triangles += s->meshes[i].primitives[k].index_count / 3;
            lines += s->meshes[i].primitives[k].line_count;
        }
    if (vertices > LIMIT_VERTICES)
        return error_set(error, LMN_LIMIT, "the scene would have more than %zu vertices", LIMIT_VERTICES);
    if (triangles > LIMIT_TRIANGLES)
        return error_set(error, LMN_LIMIT, "the scene would have more than %zu triangles", LIMIT_TRIANGLES);
    if (lines > LIMIT_LINES)
        return error_set(error, LMN_LIMIT, "the scene would have more than %zu lines", LIMIT_LINES);
    return LMN_OK;
}

static box3 bounds_of(const vec3 *positions, uint32_t count)
{
    box3 b = box3_empty();
    for (uint32_t i = 0; i < count; i++) { /* as box3_with_point, which would be called for each */
        vec3 p = positions[i];
        b.min = (vec3){b.min.x < p.x ? b.min.x : p.x, b.min.y < p.y ? b.min.y : p.y, b.min.z < p.z ? b.min.z : p.z};
        b.max = (vec3){b.max.x > p.x ? b.max.x : p.x, b.max.y > p.y ? b.max.y : p.y, b.max.z > p.z ? b.max.z : p.z};
    }
    return b;
}

lmn_status scene_exchange_mesh(lmn_scene *s, int32_t index, const primitive *wanted, lmn_error *error)
{
    mesh      *m = &s->meshes[index];
    primitive *before = m->primitives, *now = mem_copy(wanted, sizeof *wanted);
    size_t     count = m->primitive_count;
    if (!now)
        return error_memory(error);
    now->bounds = bounds_of(now->positions, now->vertex_count);
    m->primitives = now;
    m->primitive_count = 1;
    lmn_status status = scene_list_parts(s, error); /* triangles and lines are counted there, too */
    if (status != LMN_OK) {
        m->primitives = before;
        m->primitive_count = count;
        mem_free(now);
        return status;
    }
    for (size_t i = 0; i < count; i++)
        primitive_release(&before[i]);
    mem_free(before);
    m->revision = m->topology = s->revision = scene_next_revision();
    m->moved = false;
    return LMN_OK;
}

lmn_status scene_exchange_positions(lmn_scene *s, int32_t index, vec3 *positions, vec3 *normals, lmn_error *error)
{
    mesh     *m = &s->meshes[index];
    primitive before = m->primitives[0], *p = &m->primitives[0];
    p->positions = positions;
    p->normals = normals;
    p->bounds = bounds_of(positions, p->vertex_count);
    lmn_status status = measure_parts(s, has_mesh, index, error);
    if (status != LMN_OK) {
        *p = before;
        return status;
    }
    mem_free(before.positions);
    mem_free(before.normals);
    m->revision = s->revision = scene_next_revision();
    m->moved = true;
    return LMN_OK;
}
