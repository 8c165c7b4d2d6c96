/* Trees of set operations: building them and what can be said about them without drawing. */
#include "scene/solid.h"

#include <string.h>

#include "base/memory.h"

int32_t solid_append(solid *s, int32_t parent, solid_kind kind)
{
    if (s->node_count >= INT32_MAX - 1 || !mem_grow((void **)&s->nodes, &s->node_capacity, s->node_count + 1, sizeof *s->nodes))
        return NONE;
    int32_t index = (int32_t)s->node_count++;
    s->nodes[index] = (solid_node){.kind = kind, .parent = parent, .first_child = NONE, .last_child = NONE, .next_sibling = NONE,
                                   .matrix = mat4_identity(), .mesh = NONE};
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

void solid_release(solid *s)
{
    for (size_t i = 0; i < s->node_count; i++)
        mem_free(s->nodes[i].name);
    mem_free(s->nodes);
    memset(s, 0, sizeof *s);
}

/* What a node inherits. */
typedef struct inherited {
    mat4 matrix;
    bool has_colour;
    vec4 colour;
} inherited;

static bool has_triangles(const lmn_scene *scene, const solid_node *n)
{
    return n->kind == SOLID_OPERAND && n->mesh != NONE && mesh_triangle_count(&scene->meshes[n->mesh]) > 0;
}

/* Parents come before their children, so that one run hands everything down. NULL when memory is gone. */
static inherited *hand_down(const solid *s)
{
    inherited *out = mem_alloc(sizeof *out * s->node_count);
    for (size_t i = 0; out && i < s->node_count; i++) {
        const solid_node *n = &s->nodes[i];
        const inherited *above = n->parent == NONE ? NULL : &out[n->parent];
        out[i].matrix = above ? mat4_multiply(&above->matrix, &n->matrix) : n->matrix;
        out[i].has_colour = (above && above->has_colour) || n->has_colour;
        out[i].colour = above && above->has_colour ? above->colour : n->colour;
    }
    return out;
}

static box3 mesh_box(const mesh *m, const mat4 *place)
{
    box3 box = box3_empty();
    for (size_t i = 0; i < m->primitive_count; i++)
        for (uint32_t k = 0; k < m->primitives[i].vertex_count; k++)
            box = box3_with_point(box, mat4_transform_point(place, m->primitives[i].positions[k]));
    return box;
}

/* The next node depth first; NONE at the end. Order of the array is that of appending, which may differ. */
static int32_t next_node(const solid *s, int32_t current)
{
    if (s->nodes[current].first_child != NONE)
        return s->nodes[current].first_child;
    while (current != NONE && s->nodes[current].next_sibling == NONE)
        current = s->nodes[current].parent;
    return current == NONE ? NONE : s->nodes[current].next_sibling;
}

bool solid_operands(const lmn_scene *scene, const solid *s, solid_operand **out, size_t *count)
{
    size_t room = 0, made = 0;
    for (size_t i = 0; i < s->node_count; i++)
        room += has_triangles(scene, &s->nodes[i]);
    inherited *from = hand_down(s);
    *out = mem_calloc(room ? room : 1, sizeof **out);
    *count = 0;
    if (!from || !*out) {
        mem_free(from);
        mem_free(*out);
        *out = NULL;
        return false;
    }
    for (int32_t i = 0; i != NONE; i = next_node(s, i)) {
        if (!has_triangles(scene, &s->nodes[i]))
            continue;
        solid_operand *o = &(*out)[made++];
        *o = (solid_operand){.node = i, .mesh = s->nodes[i].mesh, .matrix = from[i].matrix, .has_colour = from[i].has_colour,
                             .colour = from[i].colour};
        o->box = mesh_box(&scene->meshes[o->mesh], &o->matrix);
    }
    mem_free(from);
    *count = made;
    return true;
}

static box3 box3_intersection(box3 a, box3 b)
{
    box3 out = {{a.min.x > b.min.x ? a.min.x : b.min.x, a.min.y > b.min.y ? a.min.y : b.min.y, a.min.z > b.min.z ? a.min.z : b.min.z},
                {a.max.x < b.max.x ? a.max.x : b.max.x, a.max.y < b.max.y ? a.max.y : b.max.y, a.max.z < b.max.z ? a.max.z : b.max.z}};
    return out;
}

/* Children come after their parents: from the back, each box is complete when it is handed up. */
static void gather_boxes(const solid *s, box3 *boxes, bool *begun)
{
    for (size_t i = s->node_count; i-- > 0;) {
        const solid_node *n = &s->nodes[i];
        if (n->kind == SOLID_OPERAND)
            continue;
        boxes[i] = box3_empty();
        for (int32_t c = n->first_child; c != NONE; c = s->nodes[c].next_sibling) {
            if (n->kind == SOLID_UNION)
                boxes[i] = box3_union(boxes[i], boxes[c]);
            else if (!begun[i])
                boxes[i] = boxes[c];
            else if (n->kind == SOLID_INTERSECTION)
                boxes[i] = box3_intersection(boxes[i], boxes[c]);
            begun[i] = true;
            if (box3_is_empty(boxes[i]))
                boxes[i] = box3_empty();
        }
    }
}

box3 solid_bounds(const lmn_scene *scene, const solid *s)
{
    box3 *boxes = mem_alloc(sizeof *boxes * s->node_count);
    bool *begun = mem_calloc(s->node_count, sizeof *begun);
    solid_operand *operands = NULL;
    size_t count = 0;
    box3 out = box3_empty();
    if (boxes && begun && solid_operands(scene, s, &operands, &count)) {
        for (size_t i = 0; i < s->node_count; i++)
            boxes[i] = box3_empty();
        for (size_t i = 0; i < count; i++)
            boxes[operands[i].node] = operands[i].box;
        gather_boxes(s, boxes, begun);
        out = boxes[0];
    }
    mem_free(operands);
    mem_free(boxes);
    mem_free(begun);
    return out;
}

uint64_t solid_triangle_count(const lmn_scene *scene, const solid *s)
{
    uint64_t count = 0;
    for (size_t i = 0; i < s->node_count; i++)
        if (has_triangles(scene, &s->nodes[i]))
            count += mesh_triangle_count(&scene->meshes[s->nodes[i].mesh]);
    return count;
}

uint64_t node_triangle_count(const lmn_scene *scene, const node *n)
{
    if (n->solid != NONE)
        return solid_triangle_count(scene, &scene->solids[n->solid]);
    return n->mesh != NONE ? mesh_triangle_count(&scene->meshes[n->mesh]) : 0;
}
