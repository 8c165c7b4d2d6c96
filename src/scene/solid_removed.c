/* What a solid's differences take away, as a solid of its own: to show what was cut where. Nothing of it is drawn
 * unless a look asks. */
#include "scene/solid.h"

#include "base/memory.h"

/* What is copied of one solid. */
typedef struct removal {
    const solid *from;
    solid       *into;
    mat4        *positions; /* per node of `from`: to the solid's space */
    int32_t     *painter;   /* per node: the outermost node on the way to it that has a colour; NONE */
    int32_t     *copies;    /* per node: its copy in `into`; NONE */
} removal;

/* Is the node's whole subtree taken away by the operation above it? Hidden ones may be called so, too. */
static bool is_taken_away(const solid *s, const solid_node *n, int32_t index)
{
    return n->parent != NONE && s->nodes[n->parent].kind == SOLID_DIFFERENCE &&
           solid_first_shown(s, n->parent) != index;
}

static bool takes_away(const solid *s)
{
    for (size_t i = 0; i < s->node_count; i++)
        if (is_taken_away(s, &s->nodes[i], (int32_t)i))
            return true;
    return false;
}

static bool copy_node(removal *r, int32_t index, int32_t parent)
{
    const solid_node *n = &r->from->nodes[index];
    int32_t           copy = solid_append(r->into, parent, n->kind);
    if (copy == NONE)
        return false;
    solid_node *c = &r->into->nodes[copy];
    bool        outermost = parent == 0;
    int32_t     painter = outermost ? r->painter[index] : n->has_colour ? index : NONE;
    c->matrix = outermost ? r->positions[index] : n->matrix;
    c->has_colour = painter != NONE;
    if (c->has_colour)
        c->colour = r->from->nodes[painter].colour;
    c->hidden = outermost ? solid_is_hidden(r->from, index) : n->hidden;
    c->mesh = n->mesh;
    c->line = n->line;
    c->name = mem_copy_text(n->name);
    r->copies[index] = copy;
    return !n->name || c->name;
}

/* Parents come before their children. What is taken away from something that is taken away itself stays, so
 * subtrees are copied whole. */
static bool copy_nodes(removal *r)
{
    for (size_t i = 0; i < r->from->node_count; i++) {
        const solid_node *n = &r->from->nodes[i];
        int32_t           up = n->parent;
        r->positions[i] = up == NONE ? n->matrix : mat4_multiply(&r->positions[up], &n->matrix);
        r->painter[i] = up != NONE && r->painter[up] != NONE ? r->painter[up] : n->has_colour ? (int32_t)i : NONE;
        r->copies[i] = NONE;
        int32_t parent = up != NONE && r->copies[up] != NONE     ? r->copies[up]
                         : is_taken_away(r->from, n, (int32_t)i) ? 0
                                                                 : NONE;
        if (parent != NONE && !copy_node(r, (int32_t)i, parent))
            return false;
    }
    return true;
}

static bool fill(removal *r)
{
    size_t count = r->from->node_count;
    r->positions = mem_alloc(count * sizeof *r->positions);
    r->painter = mem_alloc(count * sizeof *r->painter);
    r->copies = mem_alloc(count * sizeof *r->copies);
    bool good = r->positions && r->painter && r->copies && copy_nodes(r);
    mem_free(r->positions);
    mem_free(r->painter);
    mem_free(r->copies);
    return good;
}

bool scene_append_removed(lmn_scene *scene, int32_t node_index)
{
    int32_t whole = scene->nodes[node_index].solid;
    if (!takes_away(&scene->solids[whole]))
        return true;
    solid *into = scene_append_ghost(scene);
    if (!into)
        return false;
    removal r = {.from = &scene->solids[whole], .into = into};
    if (!fill(&r) || !solid_measure(scene, into))
        return false;
    if (into->triangles == 0) {
        solid_release(into);
        scene->solid_count--;
        return true;
    }
    int32_t index = (int32_t)scene->node_count;
    node   *n = scene_append_node(scene);
    if (!n || !(n->name = mem_copy_text("removed")))
        return false;
    n->solid = (int32_t)scene->solid_count - 1;
    n->ghost = true;
    scene_link_child(scene, node_index, index);
    return true;
}

/* The node of the solid's companion, and the one that draws the solid itself; NONE without. */
static int32_t companion_of(const lmn_scene *scene, size_t index, int32_t *own)
{
    *own = NONE;
    for (size_t i = 0; i < scene->node_count; i++) {
        const node *n = &scene->nodes[i];
        if (n->solid == (int32_t)index && !n->ghost)
            *own = (int32_t)i;
        if (n->ghost && n->parent != NONE && scene->nodes[n->parent].solid == (int32_t)index)
            return (int32_t)i;
    }
    return NONE;
}

bool scene_update_removed(lmn_scene *scene, size_t index)
{
    int32_t own, companion = companion_of(scene, index, &own);
    if (companion == NONE || scene->nodes[companion].solid == NONE)
        return own == NONE || scene_append_removed(scene, own);
    solid   fresh = {.ghost = true}, *kept = &scene->solids[scene->nodes[companion].solid];
    removal r = {.from = &scene->solids[index], .into = &fresh};
    if (solid_append(&fresh, NONE, SOLID_UNION) != 0 || (takes_away(r.from) && !fill(&r)) ||
        !solid_measure(scene, &fresh)) {
        solid_release(&fresh);
        return false;
    }
    solid_release(kept);
    *kept = fresh;
    kept->revision = scene_next_revision();
    return true;
}
