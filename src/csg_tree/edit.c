#include "csg_tree/edit.h"

#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "scene/content.h"
#include "csg_tree/links.h"

/* --- after an edit -------------------------------------------------------------------------------------- */

/* Do the parts, and behind them the ghosts, list just those solids that have triangles? */
static bool parts_hold(const lmn_scene *scene)
{
    size_t listed = 0, wanted = 0;
    for (size_t i = 0; i < scene->part_count + scene->ghost_count; i++) {
        int32_t own = scene->nodes[scene->parts[i].node].solid;
        if (own != NONE && scene->solids[own].triangles == 0)
            return false;
        listed += own != NONE;
    }
    for (size_t i = 0; i < scene->node_count; i++)
        wanted += scene->nodes[i].solid != NONE && scene->solids[scene->nodes[i].solid].triangles > 0;
    return listed == wanted;
}

/* Solids without triangles are no parts. Only where that changes is the list made again, and only then can this
 * fail: parts are as they were then. */
static lmn_status settle_part(lmn_scene *scene, size_t index, lmn_error *error)
{
    if (!scene_update_removed(scene, index))
        return error_memory(error);
    if (!parts_hold(scene)) {
        lmn_status status = scene_list_parts(scene, error);
        if (status != LMN_OK)
            return status;
    }
    for (size_t i = 0; i < scene->part_count + scene->ghost_count; i++) {
        part   *p = &scene->parts[i];
        int32_t own = scene->nodes[p->node].solid;
        if (own != (int32_t)index && (own == NONE || !scene->solids[own].ghost))
            continue;
        mat4 world = scene_world_matrix(scene, p->node);
        p->triangles = scene->solids[own].triangles;
        p->bounds = box3_transform(solid_bounds(&scene->solids[own]), &world);
    }
    scene->solids[index].revision = scene->revision = scene_next_revision();
    return LMN_OK;
}

static lmn_status settle(lmn_scene *scene, size_t index, lmn_error *error)
{
    solid_sum_up(&scene->solids[index]);
    return settle_part(scene, index, error);
}

static lmn_status too_far(lmn_error *error)
{
    error_set(error, LMN_USAGE, "an operand would lie farther than 1e18 from the solid's origin");
    error_hint(error, "check its matrix and those above it");
    return LMN_USAGE;
}

/* Measures what is below a node, then settles. */
static lmn_status settle_below(lmn_scene *scene, size_t index, int32_t node, lmn_error *error)
{
    solid *s = &scene->solids[index];
    if (!solid_measure_below(scene, s, node))
        return too_far(error);
    if (s->nodes[node].kind == SOLID_OPERAND)
        solid_sum_up_above(s, node);
    else
        solid_sum_up(s);
    return settle_part(scene, index, error);
}

/* --- meshes --------------------------------------------------------------------------------------------- */

static void spare_mesh(lmn_scene *scene, int32_t index)
{
    if (index == NONE)
        return;
    mesh_release(&scene->meshes[index]);
    scene->meshes[index].revision = scene->meshes[index].topology = scene_next_revision();
    scene->meshes[index].spare = true;
    scene->spare_meshes++;
}

/* Moves a mesh into the scene, where another one was if there is room. NONE when memory is gone. */
static int32_t take_mesh(lmn_scene *scene, mesh *m)
{
    size_t at = 0;
    while (scene->spare_meshes && at < scene->mesh_count && !scene->meshes[at].spare)
        at++;
    if (scene->spare_meshes) {
        scene->spare_meshes--;
    } else if (scene_append_mesh(scene)) {
        at = scene->mesh_count - 1;
    } else {
        mesh_release(m);
        return NONE;
    }
    scene->meshes[at] = *m;
    scene->meshes[at].revision = scene->meshes[at].topology = scene_next_revision();
    memset(m, 0, sizeof *m);
    return (int32_t)at;
}

/* Frees the meshes marked in `dropped` that nothing uses. */
static void drop_meshes(lmn_scene *scene, bool *dropped)
{
    for (size_t i = 0; i < scene->node_count; i++)
        if (scene->nodes[i].mesh != NONE)
            dropped[scene->nodes[i].mesh] = false;
    for (size_t i = 0; i < scene->solid_count; i++)
        for (size_t k = 0; k < scene->solids[i].node_count; k++)
            if (scene->solids[i].nodes[k].mesh != NONE)
                dropped[scene->solids[i].nodes[k].mesh] = false;
    for (size_t i = 0; i < scene->mesh_count; i++)
        if (dropped[i])
            spare_mesh(scene, (int32_t)i);
}

static lmn_status check_triangles(const lmn_scene *scene, uint64_t more, lmn_error *error)
{
    uint64_t triangles = more;
    for (size_t i = 0; i < scene->mesh_count; i++)
        triangles += mesh_triangle_count(&scene->meshes[i]);
    if (triangles <= LIMIT_TRIANGLES)
        return LMN_OK;
    return error_set(error, LMN_LIMIT, "the scene would have more than %zu triangles", LIMIT_TRIANGLES);
}

/* --- adding --------------------------------------------------------------------------------------------- */

static size_t depth_of(const solid *s, int32_t node)
{
    size_t depth = 0;
    for (int32_t i = node; i != NONE; i = s->nodes[i].parent)
        depth++;
    return depth;
}

/* Levels below and with a node. */
static size_t height_of(const solid *s, int32_t node)
{
    size_t height = 0, above = depth_of(s, node) - 1;
    for (int32_t i = node; i != NONE; i = solid_next(s, node, i)) {
        size_t depth = depth_of(s, i) - above;
        height = depth > height ? depth : height;
    }
    return height;
}

static lmn_status check_capacity(const solid *s, int32_t parent, size_t operands, size_t nodes, size_t levels,
                                 lmn_error *error)
{
    if (s->operand_count + operands > SOLID_OPERANDS_MAX)
        return error_set(error, LMN_LIMIT, "the solid would have more than %d operands", SOLID_OPERANDS_MAX);
    if (s->node_count + nodes > LIMIT_NODES)
        return error_set(error, LMN_LIMIT, "the solid would have more than %zu operations and operands", LIMIT_NODES);
    if (depth_of(s, parent) + levels > SOLID_DEPTH_MAX)
        return error_set(error, LMN_LIMIT, "the solid would be more than %d levels deep", SOLID_DEPTH_MAX);
    return LMN_OK;
}

static void take_back(lmn_scene *scene, size_t index, size_t node_count)
{
    solid *s = &scene->solids[index];
    while (s->node_count > node_count)
        solid_take_back(s);
    solid_sum_up(s);
}

lmn_status solid_edit_create(lmn_scene *scene, solid_kind root, const char *name, size_t *out, lmn_error *error)
{
    if (scene->node_count >= LIMIT_NODES)
        return error_set(error, LMN_LIMIT, "the scene would have more than %zu nodes", LIMIT_NODES);
    char  *copy = name ? scene_clean_name(name, strlen(name)) : NULL;
    solid *s = name && !copy ? NULL : scene_append_solid(scene, root);
    node  *n = s ? scene_append_node(scene) : NULL;
    if (!n) {
        if (s)
            solid_release(&scene->solids[--scene->solid_count]);
        mem_free(copy);
        return error_memory(error);
    }
    n->name = copy;
    n->solid = (int32_t)(*out = scene->solid_count - 1);
    /* What comes first decides, as with files; shapes stand on the plane of x and y, as in OpenSCAD. */
    if (!scene->up)
        scene->up = 'z';
    s->revision = scene->revision = scene_next_revision();
    return LMN_OK;
}

lmn_status solid_edit_add(lmn_scene *scene, size_t index, int32_t parent, const solid_addition *what, uint32_t *id,
                          lmn_error *error)
{
    solid     *s = &scene->solids[index];
    size_t     count = s->node_count;
    int32_t    mesh_index = NONE;
    lmn_status status = check_capacity(s, parent, what->kind == SOLID_OPERAND, 1, 1, error);
    if (status == LMN_OK && what->mesh)
        status = check_triangles(scene, mesh_triangle_count(what->mesh), error);
    if (status != LMN_OK) {
        if (what->mesh)
            mesh_release(what->mesh);
        return status;
    }
    char *name = what->name ? scene_clean_name(what->name, strlen(what->name)) : NULL;
    if (what->mesh)
        mesh_index = take_mesh(scene, what->mesh);
    bool    good = (!what->name || name) && (!what->mesh || mesh_index != NONE);
    int32_t at = good ? solid_append(s, parent, what->kind) : NONE;
    if (at == NONE) {
        mem_free(name);
        spare_mesh(scene, mesh_index);
        return error_memory(error);
    }
    s->nodes[at].name = name;
    s->nodes[at].mesh = mesh_index;
    s->nodes[at].matrix = what->matrix;
    *id = s->nodes[at].id;
    status = settle_below(scene, index, at, error);
    if (status != LMN_OK) {
        take_back(scene, index, count);
        spare_mesh(scene, mesh_index);
    }
    return status;
}

/* Appends what is below and with a node of `from`, which may be the same solid: only what was there before is
 * copied. `meshes`: what they are called here; NULL: the same. */
static bool append_tree(solid *into, int32_t parent, const solid *from, int32_t source, const int32_t *meshes)
{
    bool     good = true;
    int32_t *positions = mem_alloc(from->node_count * sizeof *positions),
            *order = mem_alloc(from->node_count * sizeof *order);
    size_t count = 0;
    for (int32_t i = source; positions && order && i != NONE; i = solid_next(from, source, i))
        order[count++] = i;
    good = positions && order;
    for (size_t k = 0; k < count && good; k++) {
        solid_node n = from->nodes[order[k]];
        int32_t    at = solid_append(into, k == 0 ? parent : positions[n.parent], n.kind);
        good = at != NONE;
        if (!good)
            break;
        solid_node *made = &into->nodes[positions[order[k]] = at];
        made->matrix = n.matrix;
        made->has_colour = n.has_colour;
        made->colour = n.colour;
        made->hidden = n.hidden;
        made->mesh = n.mesh == NONE || !meshes ? n.mesh : meshes[n.mesh];
        made->line = n.line;
        made->name = mem_copy_text(n.name);
        good = !n.name || made->name;
    }
    mem_free(positions);
    mem_free(order);
    return good;
}

static size_t operands_below(const solid *s, int32_t node, size_t *nodes)
{
    size_t operands = 0;
    *nodes = 0;
    for (int32_t i = node; i != NONE; i = solid_next(s, node, i)) {
        operands += s->nodes[i].kind == SOLID_OPERAND;
        ++*nodes;
    }
    return operands;
}

lmn_status solid_edit_copy(lmn_scene *scene, size_t index, int32_t parent, int32_t source, uint32_t *id,
                           lmn_error *error)
{
    solid     *s = &scene->solids[index];
    size_t     count = s->node_count, nodes, operands = operands_below(s, source, &nodes);
    lmn_status status = check_capacity(s, parent, operands, nodes, height_of(s, source), error);
    if (status != LMN_OK)
        return status;
    status = append_tree(s, parent, s, source, NULL) ? settle_below(scene, index, (int32_t)count, error)
                                                     : error_memory(error);
    if (status == LMN_OK)
        *id = s->nodes[count].id;
    else
        take_back(scene, index, count);
    return status;
}

/* --- another scene's solids ----------------------------------------------------------------------------- */

static lmn_status check_graft(const lmn_scene *scene, const solid *s, int32_t parent, const lmn_scene *from,
                              lmn_error *error)
{
    size_t   operands = 0, nodes = 1, levels = 1;
    uint64_t triangles = 0;
    for (size_t i = 0; i < from->solid_count; i++) {
        if (from->solids[i].ghost)
            continue;
        size_t height = 1 + height_of(&from->solids[i], 0);
        operands += from->solids[i].operand_count;
        nodes += from->solids[i].node_count;
        levels = height > levels ? height : levels;
    }
    for (size_t i = 0; i < from->mesh_count; i++)
        triangles += mesh_triangle_count(&from->meshes[i]);
    lmn_status status = check_capacity(s, parent, operands, nodes, levels, error);
    return status == LMN_OK ? check_triangles(scene, triangles, error) : status;
}

/* Meshes of `from` in this scene; what could not be taken is NONE, and false is returned. */
static bool take_meshes(lmn_scene *scene, lmn_scene *from, int32_t *meshes)
{
    bool good = true;
    for (size_t i = 0; i < from->mesh_count; i++) {
        for (size_t k = 0; k < from->meshes[i].primitive_count; k++)
            from->meshes[i].primitives[k].material = NONE;
        meshes[i] = good ? take_mesh(scene, &from->meshes[i]) : NONE;
        good = meshes[i] != NONE;
    }
    return good;
}

static bool append_solids(lmn_scene *scene, size_t index, int32_t top, const lmn_scene *from, const int32_t *meshes)
{
    for (size_t i = 0; i < from->part_count; i++) {
        int32_t n = from->parts[i].node;
        solid  *s = &scene->solids[index];
        size_t  at = s->node_count;
        if (from->nodes[n].solid == NONE)
            continue;
        if (!append_tree(s, top, &from->solids[from->nodes[n].solid], 0, meshes))
            return false;
        mat4 world = scene_world_matrix(from, n);
        s->nodes[at].matrix = mat4_multiply(&world, &s->nodes[at].matrix);
    }
    return true;
}

lmn_status solid_edit_graft(lmn_scene *scene, size_t index, int32_t parent, lmn_scene *from, const solid_addition *what,
                            uint32_t *id, lmn_error *error)
{
    solid     *s = &scene->solids[index];
    size_t     count = s->node_count;
    lmn_status status = check_graft(scene, s, parent, from, error);
    if (status != LMN_OK)
        return status;
    char    *name = what->name ? scene_clean_name(what->name, strlen(what->name)) : NULL;
    int32_t *meshes = mem_alloc((from->mesh_count + 1) * sizeof *meshes);
    for (size_t i = 0; meshes && i < from->mesh_count; i++)
        meshes[i] = NONE;
    bool    good = (!what->name || name) && meshes && take_meshes(scene, from, meshes);
    int32_t top = good ? solid_append(s, parent, SOLID_UNION) : NONE;
    if (top != NONE) {
        s->nodes[top].name = name;
        s->nodes[top].matrix = what->matrix;
        *id = s->nodes[top].id;
        name = NULL;
    }
    good = top != NONE && append_solids(scene, index, top, from, meshes);
    status = good ? settle_below(scene, index, top, error) : error_memory(error);
    if (status != LMN_OK) {
        take_back(scene, index, count);
        for (size_t i = 0; meshes && i < from->mesh_count; i++)
            spare_mesh(scene, meshes[i]);
    }
    mem_free(name);
    mem_free(meshes);
    return status;
}

/* --- changing ------------------------------------------------------------------------------------------- */

/* Brings back what is below a node after an edit that was taken back; what was true once needs no check. */
static void restore(lmn_scene *scene, size_t index, int32_t node)
{
    solid_measure_below(scene, &scene->solids[index], node);
    solid_sum_up(&scene->solids[index]);
}

lmn_status solid_edit_set_mesh(lmn_scene *scene, size_t index, int32_t node, mesh *shape, lmn_error *error)
{
    int32_t    before = scene->solids[index].nodes[node].mesh;
    lmn_status status = check_triangles(scene, mesh_triangle_count(shape), error);
    bool      *dropped = status == LMN_OK ? mem_calloc(scene->mesh_count + 1, sizeof *dropped) : NULL;
    if (!dropped) {
        mesh_release(shape);
        return status == LMN_OK ? error_memory(error) : status;
    }
    int32_t now = take_mesh(scene, shape);
    scene->solids[index].nodes[node].mesh = now;
    status = now == NONE ? error_memory(error) : settle_below(scene, index, node, error);
    if (status != LMN_OK) {
        scene->solids[index].nodes[node].mesh = before;
        restore(scene, index, node);
        spare_mesh(scene, now);
    } else if (before != NONE) {
        /* `now` may be new, and then `dropped` has just room for it. */
        dropped[before] = true;
        drop_meshes(scene, dropped);
    }
    mem_free(dropped);
    return status;
}

lmn_status solid_edit_set_matrix(lmn_scene *scene, size_t index, int32_t node, const mat4 *matrix, lmn_error *error)
{
    solid_node *n = &scene->solids[index].nodes[node];
    mat4        before = n->matrix;
    n->matrix = *matrix;
    lmn_status status = settle_below(scene, index, node, error);
    if (status != LMN_OK) {
        n->matrix = before;
        restore(scene, index, node);
    }
    return status;
}

lmn_status solid_edit_set_shown(lmn_scene *scene, size_t index, int32_t node, bool shown, lmn_error *error)
{
    solid_node *n = &scene->solids[index].nodes[node];
    if (n->hidden == !shown)
        return LMN_OK;
    n->hidden = !shown;
    lmn_status status = settle_below(scene, index, node, error);
    if (status != LMN_OK) {
        n->hidden = shown;
        restore(scene, index, node);
    }
    return status;
}

void solid_edit_set_colour(lmn_scene *scene, size_t index, int32_t node, const vec4 *colour)
{
    solid *s = &scene->solids[index];
    s->nodes[node].has_colour = colour != NULL;
    s->nodes[node].colour = colour ? *colour : (vec4){0, 0, 0, 0};
    s->revision = scene->revision = scene_next_revision();
}

lmn_status solid_edit_set_operation(lmn_scene *scene, size_t index, int32_t node, solid_kind kind, lmn_error *error)
{
    scene->solids[index].nodes[node].kind = kind;
    return settle(scene, index, error); /* as many triangles as before: the list of parts stays */
}

/* Names of parts are those of scene nodes. */
static lmn_status rename_part(lmn_scene *scene, size_t index, const char *name, lmn_error *error)
{
    for (size_t i = 0; i < scene->node_count; i++) {
        if (scene->nodes[i].solid != (int32_t)index)
            continue;
        char *before = scene->nodes[i].name, *copy = mem_copy_text(name);
        if (name && !copy)
            return error_memory(error);
        scene->nodes[i].name = copy;
        lmn_status status = scene_list_parts(scene, error);
        if (status != LMN_OK)
            scene->nodes[i].name = before;
        mem_free(status == LMN_OK ? before : copy);
        return status;
    }
    return LMN_OK;
}

lmn_status solid_edit_set_name(lmn_scene *scene, size_t index, int32_t node, const char *name, lmn_error *error)
{
    solid_node *n = &scene->solids[index].nodes[node];
    char       *copy = name ? scene_clean_name(name, strlen(name)) : NULL;
    if (name && !copy)
        return error_memory(error);
    lmn_status status = node == 0 ? rename_part(scene, index, copy, error) : LMN_OK;
    if (status != LMN_OK) {
        mem_free(copy);
        return status;
    }
    mem_free(n->name);
    n->name = copy;
    scene->revision = scene_next_revision();
    return LMN_OK;
}

/* --- removing and moving -------------------------------------------------------------------------------- */

static lmn_status remove_solid(lmn_scene *scene, size_t index, bool *dropped, lmn_error *error)
{
    solid removed = scene->solids[index];
    scene->solids[index] = (solid){.revision = removed.revision};
    lmn_status status = settle(scene, index, error);
    if (status != LMN_OK) {
        scene->solids[index] = removed;
        return status;
    }
    for (size_t i = 0; i < scene->node_count; i++)
        if (scene->nodes[i].solid == (int32_t)index)
            scene->nodes[i].solid = NONE;
    drop_meshes(scene, dropped);
    solid_release(&removed);
    return LMN_OK;
}

static void release_names(solid *s, int32_t top)
{
    for (int32_t i = top; i != NONE; i = solid_next(s, top, i))
        mem_free(s->nodes[i].name);
}

lmn_status solid_edit_remove(lmn_scene *scene, size_t index, int32_t node, lmn_error *error)
{
    solid *s = &scene->solids[index], before = *s;
    bool  *dropped = mem_calloc(scene->mesh_count + 1, sizeof *dropped);
    if (!dropped)
        return error_memory(error);
    for (int32_t i = node; i != NONE; i = solid_next(s, node, i))
        if (s->nodes[i].mesh != NONE)
            dropped[s->nodes[i].mesh] = true;
    lmn_status status;
    if (node == 0) {
        status = remove_solid(scene, index, dropped, error);
        mem_free(dropped);
        return status;
    }
    solid_seat seat = solid_unlink(s, node);
    status = solid_arrange(s, error);
    if (status == LMN_OK) {
        status = settle(scene, index, error);
        if (status == LMN_OK) {
            release_names(&before, node);
            drop_meshes(scene, dropped);
            mem_free(before.nodes);
            mem_free(before.positions);
        } else {
            mem_free(s->nodes);
            mem_free(s->positions);
            *s = before;
        }
    }
    if (status != LMN_OK) {
        solid_link(s, node, seat);
        solid_sum_up(s);
    }
    mem_free(dropped);
    return status;
}

static bool is_below(const solid *s, int32_t node, int32_t top)
{
    while (node != NONE && node != top)
        node = s->nodes[node].parent;
    return node == top;
}

lmn_status solid_edit_move(lmn_scene *scene, size_t index, int32_t node, int32_t parent, int32_t before,
                           lmn_error *error)
{
    solid *s = &scene->solids[index];
    if (is_below(s, parent, node)) {
        error_set(error, LMN_USAGE, "an operation cannot be moved to itself or to what is below it");
        error_hint(error, "the parent must be an operation elsewhere in the solid");
        return LMN_USAGE;
    }
    if (depth_of(s, parent) + height_of(s, node) > SOLID_DEPTH_MAX)
        return error_set(error, LMN_LIMIT, "the solid would be more than %d levels deep", SOLID_DEPTH_MAX);
    if (before == node)
        return LMN_OK;
    uint32_t   id = s->nodes[node].id;
    solid      whole = *s;
    solid_seat seat = solid_unlink(s, node);
    solid_link(s, node, (solid_seat){parent, before});
    lmn_status status = solid_arrange(s, error);
    bool       arranged = status == LMN_OK;
    if (arranged) /* what it was taken from changes too */
        status = solid_measure_below(scene, s, s->positions[id - 1]) ? settle(scene, index, error) : too_far(error);
    if (status == LMN_OK) {
        mem_free(whole.nodes);
        mem_free(whole.positions);
        return LMN_OK;
    }
    if (arranged) {
        mem_free(s->nodes);
        mem_free(s->positions);
        *s = whole;
    }
    solid_unlink(s, node);
    solid_link(s, node, seat);
    restore(scene, index, node);
    return status;
}
