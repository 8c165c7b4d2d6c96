/* What `limner info` tells about a solid. */
#include "info/solid_info.h"

#include "base/memory.h"
#include "csg_tree/products.h"

/* Enough to know a model by; the tree is for people, level by level. */
enum { TREE_NODES_MAX = 256, TREE_LEVELS_MAX = 64 };

static const char *const kind_names[] = {"operand", "union", "intersection", "difference"};

/* Levels of each node, 1 for the root. NULL when memory is gone. */
static uint32_t *levels_of(const solid *s)
{
    uint32_t *levels = mem_alloc(s->node_count * sizeof *levels);
    for (size_t i = 0; levels && i < s->node_count; i++)
        levels[i] = s->nodes[i].parent == NONE ? 1 : levels[s->nodes[i].parent] + 1;
    return levels;
}

/* Which nodes the tree shows: the upper levels whole, as far as the room goes. NULL when memory is gone. */
static bool *choose_nodes(const solid *s, const uint32_t *levels)
{
    bool   *shown = mem_calloc(s->node_count, sizeof *shown);
    int32_t queue[TREE_NODES_MAX];
    size_t  count = 0;
    if (!shown)
        return NULL;
    shown[0] = true;
    queue[count++] = 0;
    for (size_t i = 0; i < count; i++)
        for (int32_t c = s->nodes[queue[i]].first_child; c != NONE && count < TREE_NODES_MAX;
             c = s->nodes[c].next_sibling)
            if (levels[c] <= TREE_LEVELS_MAX) {
                shown[c] = true;
                queue[count++] = c;
            }
    return shown;
}

static json_t *name_json(const char *name)
{
    json_t *text = name ? json_string(name) : NULL;
    return text ? text : json_null();
}

static json_t *tree_json(const lmn_scene *scene, const solid *s, const bool *shown, int32_t index)
{
    const solid_node *n = &s->nodes[index];
    json_t *entry = json_pack("{s:s,s:o,s:I}", "kind", kind_names[n->kind], "name", name_json(n->name), "line",
                              (json_int_t)n->line);
    if (!entry)
        return NULL;
    if (n->kind == SOLID_OPERAND) {
        uint64_t triangles = n->mesh == NONE ? 0 : mesh_triangle_count(&scene->meshes[n->mesh]);
        json_object_set_new(entry, "triangles", json_integer((json_int_t)triangles));
        return entry;
    }
    json_t *children = json_array();
    size_t  omitted = 0;
    for (int32_t c = n->first_child; c != NONE; c = s->nodes[c].next_sibling) {
        if (shown[c])
            json_array_append_new(children, tree_json(scene, s, shown, c));
        else
            omitted++;
    }
    json_object_set_new(entry, "children", children);
    json_object_set_new(entry, "omitted", json_integer((json_int_t)omitted));
    return entry;
}

/* How many partial products the normal form has; null when they are too many. */
static json_t *products_json(const solid *s)
{
    solid_form   form;
    product_list products = {.too_many = true};
    if (solid_form_create(&form, s, true, NULL) == LMN_OK &&
        solid_products_create(&products, &form, form.root, true, NULL) != LMN_OK)
        products.too_many = true;
    json_t *out = products.too_many ? json_null() : json_integer((json_int_t)products.count);
    solid_products_release(&products);
    solid_form_release(&form);
    return out;
}

json_t *solid_info_json(const lmn_scene *scene, const solid *s, json_t *bounds)
{
    json_int_t counts[4] = {0};
    uint32_t   depth = 0;
    uint32_t  *levels = levels_of(s);
    bool      *shown = levels ? choose_nodes(s, levels) : NULL;
    for (size_t i = 0; i < s->node_count; i++) {
        counts[s->nodes[i].kind]++;
        depth = levels && levels[i] > depth ? levels[i] : depth;
    }
    json_t *out =
        json_pack("{s:I,s:I,s:I,s:{s:I,s:I,s:I},s:o}", "operands", counts[SOLID_OPERAND], "triangles",
                  (json_int_t)s->triangles, "depth", (json_int_t)depth, "operations", "union", counts[SOLID_UNION],
                  "intersection", counts[SOLID_INTERSECTION], "difference", counts[SOLID_DIFFERENCE], "bounds", bounds);
    if (out)
        json_object_set_new(out, "products", products_json(s));
    if (out && shown)
        json_object_set_new(out, "tree", tree_json(scene, s, shown, 0));
    mem_free(levels);
    mem_free(shown);
    return out;
}
