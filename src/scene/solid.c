/* Trees of set operations: building them and what can be said about them without drawing. */
#include "scene/solid.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

int32_t solid_append(solid *s, int32_t parent, solid_kind kind)
{
    if (s->id_count >= INT32_MAX - 1 ||
        !mem_grow((void **)&s->nodes, &s->node_capacity, s->node_count + 1, sizeof *s->nodes) ||
        !mem_grow((void **)&s->positions, &s->position_capacity, s->id_count + 1, sizeof *s->positions))
        return NONE;
    int32_t index = (int32_t)s->node_count++;
    s->positions[s->id_count++] = index;
    s->operand_count += kind == SOLID_OPERAND;
    s->nodes[index] = (solid_node){.kind = kind,
                                   .id = (uint32_t)s->id_count,
                                   .parent = parent,
                                   .first_child = NONE,
                                   .last_child = NONE,
                                   .next_sibling = NONE,
                                   .matrix = mat4_identity(),
                                   .mesh = NONE,
                                   .box = box3_empty()};
    if (parent == NONE)
        return index;
    solid_node *above = &s->nodes[parent];
    if (above->last_child == NONE)
        above->first_child = index;
    else
        s->nodes[above->last_child].next_sibling = index;
    above->last_child = index;
    return index;
}

void solid_take_back(solid *s)
{
    int32_t index = (int32_t)--s->node_count, before = NONE;
    s->id_count--;
    solid_node *above = &s->nodes[s->nodes[index].parent];
    s->operand_count -= s->nodes[index].kind == SOLID_OPERAND;
    s->triangles -= s->nodes[index].triangles;
    mem_free(s->nodes[index].name);
    for (int32_t c = above->first_child; c != index; c = s->nodes[c].next_sibling)
        before = c;
    if (before == NONE)
        above->first_child = NONE;
    else
        s->nodes[before].next_sibling = NONE;
    above->last_child = before;
}

void solid_release(solid *s)
{
    for (size_t i = 0; i < s->node_count; i++)
        mem_free(s->nodes[i].name);
    mem_free(s->nodes);
    mem_free(s->positions);
    memset(s, 0, sizeof *s);
}

/* What a node inherits. */
typedef struct inherited {
    mat4 matrix;
    bool has_colour, hidden;
    vec4 colour;
} inherited;

/* Parents come before their children, so that one run hands everything down. NULL when memory is gone. */
static inherited *hand_down(const solid *s)
{
    inherited *out = mem_alloc(sizeof *out * s->node_count);
    for (size_t i = 0; out && i < s->node_count; i++) {
        const solid_node *n = &s->nodes[i];
        const inherited  *above = n->parent == NONE ? NULL : &out[n->parent];
        out[i].matrix = above ? mat4_multiply(&above->matrix, &n->matrix) : n->matrix;
        out[i].has_colour = (above && above->has_colour) || n->has_colour;
        out[i].colour = above && above->has_colour ? above->colour : n->colour;
        out[i].hidden = (above && above->hidden) || n->hidden;
    }
    return out;
}

static box3 mesh_box(const mesh *m, const mat4 *position)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < m->primitive_count; i++)
        for (uint32_t k = 0; k < m->primitives[i].vertex_count; k++)
            box = box3_with_point(box, mat4_transform_point(position, m->primitives[i].positions[k]));
    return box;
}

int32_t solid_next(const solid *s, int32_t top, int32_t current)
{
    if (s->nodes[current].first_child != NONE)
        return s->nodes[current].first_child;
    while (current != top && s->nodes[current].next_sibling == NONE)
        current = s->nodes[current].parent;
    return current == top ? NONE : s->nodes[current].next_sibling;
}

static int32_t shown_from(const solid *s, int32_t operand)
{
    while (operand != NONE && s->nodes[operand].hidden)
        operand = s->nodes[operand].next_sibling;
    return operand;
}

int32_t solid_first_shown(const solid *s, int32_t operation)
{
    return shown_from(s, s->nodes[operation].first_child);
}

int32_t solid_next_shown(const solid *s, int32_t operand)
{
    return shown_from(s, s->nodes[operand].next_sibling);
}

bool solid_is_hidden(const solid *s, int32_t node)
{
    while (node != NONE && !s->nodes[node].hidden)
        node = s->nodes[node].parent;
    return node != NONE;
}

/* Triangles of hidden operands count: whether a solid is a part does not depend on what of it is shown. */
static void measure_operand(const lmn_scene *scene, solid *s, int32_t index, const mat4 *position, bool hidden)
{
    solid_node *n = &s->nodes[index];
    s->triangles -= n->triangles;
    n->triangles = n->mesh == NONE ? 0 : mesh_triangle_count(&scene->meshes[n->mesh]);
    s->triangles += n->triangles;
    n->box = n->triangles && !hidden ? mesh_box(&scene->meshes[n->mesh], position) : box3_empty();
}

bool solid_measure(const lmn_scene *scene, solid *s)
{
    inherited *from = hand_down(s);
    for (size_t i = 0; from && i < s->node_count; i++)
        if (s->nodes[i].kind == SOLID_OPERAND)
            measure_operand(scene, s, (int32_t)i, &from[i].matrix, from[i].hidden);
    solid_sum_up(s);
    mem_free(from);
    return from != NULL;
}

/* Multiplied from the root on, as hand_down does: the same numbers, bit by bit. */
static mat4 position_of(const solid *s, int32_t index)
{
    int32_t above[SOLID_DEPTH_MAX];
    size_t  depth = 0;
    for (int32_t i = s->nodes[index].parent; i != NONE && depth < SOLID_DEPTH_MAX; i = s->nodes[i].parent)
        above[depth++] = i;
    if (depth == 0)
        return s->nodes[index].matrix;
    mat4 position = s->nodes[above[--depth]].matrix;
    while (depth-- > 0)
        position = mat4_multiply(&position, &s->nodes[above[depth]].matrix);
    return mat4_multiply(&position, &s->nodes[index].matrix);
}

static bool is_within_reach(const solid_node *n)
{
    const float reach[6] = {n->box.min.x, n->box.min.y, n->box.min.z, n->box.max.x, n->box.max.y, n->box.max.z};
    for (int i = 0; i < 6; i++)
        if (!(fabsf(reach[i]) <= SOLID_FARTHEST))
            return n->triangles == 0;
    return true;
}

bool solid_measure_below(const lmn_scene *scene, solid *s, int32_t top)
{
    bool good = true;
    for (int32_t i = top; i != NONE; i = solid_next(s, top, i)) {
        if (s->nodes[i].kind != SOLID_OPERAND)
            continue;
        mat4 position = position_of(s, i);
        bool hidden = solid_is_hidden(s, i);
        measure_operand(scene, s, i, &position, hidden);
        good = good && (hidden || is_within_reach(&s->nodes[i]));
    }
    return good;
}

static box3 box_of_operation(const solid *s, int32_t index)
{
    const solid_node *n = &s->nodes[index];
    int32_t           first = solid_first_shown(s, index);
    box3              box = first == NONE ? box3_empty() : s->nodes[first].box;
    for (int32_t c = first; c != NONE && n->kind != SOLID_DIFFERENCE; c = solid_next_shown(s, c)) {
        box = n->kind == SOLID_UNION ? box3_union(box, s->nodes[c].box) : box3_intersection(box, s->nodes[c].box);
        if (box3_is_empty(box))
            box = box3_empty();
    }
    return box;
}

/* Children come after their parents: from the back, each box is complete when it is asked for. */
void solid_sum_up(solid *s)
{
    s->operand_count = 0;
    s->triangles = 0;
    for (size_t i = s->node_count; i-- > 0;) {
        solid_node *n = &s->nodes[i];
        if (n->kind != SOLID_OPERAND)
            n->box = box_of_operation(s, (int32_t)i);
        s->operand_count += n->kind == SOLID_OPERAND;
        s->triangles += n->triangles;
    }
}

void solid_sum_up_above(solid *s, int32_t node)
{
    for (int32_t i = s->nodes[node].parent; i != NONE; i = s->nodes[i].parent)
        s->nodes[i].box = box_of_operation(s, i);
}

bool solid_operands(const solid *s, solid_operand **out, size_t *count)
{
    size_t     capacity = s->operand_count, made = 0;
    inherited *from = hand_down(s);
    *out = mem_calloc(capacity ? capacity : 1, sizeof **out);
    *count = 0;
    if (!from || !*out) {
        mem_free(from);
        mem_free(*out);
        *out = NULL;
        return false;
    }
    /* In the order of the tree; that of the array is the order of appending, which may differ. */
    for (int32_t i = 0; i != NONE; i = solid_next(s, 0, i)) {
        const solid_node *n = &s->nodes[i];
        if (n->triangles == 0 || from[i].hidden)
            continue;
        (*out)[made++] = (solid_operand){.node = i,
                                         .mesh = n->mesh,
                                         .matrix = from[i].matrix,
                                         .has_colour = from[i].has_colour,
                                         .colour = from[i].colour,
                                         .box = n->box};
    }
    mem_free(from);
    *count = made;
    return true;
}

box3 solid_bounds(const solid *s)
{
    return s->node_count ? s->nodes[0].box : box3_empty();
}

uint64_t node_triangle_count(const lmn_scene *scene, const node *n)
{
    if (n->solid != NONE)
        return scene->solids[n->solid].triangles;
    return n->mesh != NONE ? mesh_triangle_count(&scene->meshes[n->mesh]) : 0;
}
