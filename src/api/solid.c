/* include/limner/solid.h: checks arguments and forwards. */
#include "limner/solid.h"

#include <math.h>
#include <string.h>

#include "api/load_desc.h"
#include "api/solid_shape.h"
#include "base/colour.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "construct/construct.h"
#include "import/gather.h"
#include "import/import.h"
#include "csg_tree/edit.h"

/* --- ids ------------------------------------------------------------------------------------------------ */

static const solid *solid_of(const lmn_scene *scene, uint32_t id)
{
    if (!scene || id == 0 || id > scene->solid_count || scene->solids[id - 1].node_count == 0 ||
        scene->solids[id - 1].ghost)
        return NULL;
    return &scene->solids[id - 1];
}

static int32_t node_of(const solid *s, uint32_t id)
{
    return id == 0 || id > s->id_count ? NONE : s->positions[id - 1];
}

/* A node that a caller named. */
typedef struct found {
    size_t            solid;
    int32_t           node;
    const solid_node *at;
} found;

static lmn_status find(found *out, const lmn_scene *scene, uint32_t solid_id, uint32_t node_id, const char *caller,
                       lmn_error *error)
{
    if (!scene)
        return error_set(error, LMN_USAGE, "%s: `scene` is NULL", caller);
    const solid *s = solid_of(scene, solid_id);
    if (!s) {
        error_set(error, LMN_USAGE, "%s: the scene has no solid %u", caller, (unsigned)solid_id);
        error_hint(error, "take ids from lmn_scene_add_solid or lmn_scene_solid_at; those of removed solids are gone");
        return LMN_USAGE;
    }
    *out = (found){solid_id - 1, node_of(s, node_id), NULL};
    if (out->node == NONE) {
        error_set(error, LMN_USAGE, "%s: solid %u has no node %u", caller, (unsigned)solid_id, (unsigned)node_id);
        error_hint(error, "take ids from what adds nodes or from lmn_solid_info_of; those of removed nodes are gone");
        return LMN_USAGE;
    }
    out->at = &s->nodes[out->node];
    return LMN_OK;
}

static lmn_status find_operation(found *out, const lmn_scene *scene, uint32_t solid_id, uint32_t node_id,
                                 const char *caller, lmn_error *error)
{
    lmn_status status = find(out, scene, solid_id, node_id, caller, error);
    if (status != LMN_OK || out->at->kind != SOLID_OPERAND)
        return status;
    error_set(error, LMN_USAGE, "%s: node %u is a shape", caller, (unsigned)node_id);
    error_hint(error, "only operations have operands and can become other operations");
    return LMN_USAGE;
}

static lmn_status check_operation(lmn_operation operation, const char *caller, lmn_error *error)
{
    if (operation == LMN_UNION || operation == LMN_INTERSECTION || operation == LMN_DIFFERENCE)
        return LMN_OK;
    error_set(error, LMN_USAGE, "%s: %d is no operation", caller, (int)operation);
    error_hint(error, "give LMN_UNION, LMN_INTERSECTION or LMN_DIFFERENCE");
    return LMN_USAGE;
}

/* Both count in the same order. */
static solid_kind kind_of(lmn_operation operation)
{
    return (solid_kind)operation;
}

static void give(uint32_t *out, uint32_t id)
{
    if (out)
        *out = id;
}

/* --- building ------------------------------------------------------------------------------------------- */

lmn_status lmn_scene_add_solid(lmn_scene *scene, const char *name, lmn_operation root, uint32_t *out, lmn_error *error)
{
    if (!scene)
        return error_set(error, LMN_USAGE, "lmn_scene_add_solid: `scene` is NULL");
    size_t     index = 0;
    lmn_status status = check_operation(root, "lmn_scene_add_solid", error);
    if (status == LMN_OK)
        status = solid_edit_create(scene, kind_of(root), name, &index, error);
    if (status == LMN_OK)
        give(out, (uint32_t)index + 1);
    return status;
}

lmn_status lmn_solid_add_operation(lmn_scene *scene, uint32_t solid, uint32_t parent, lmn_operation operation,
                                   uint32_t *node, lmn_error *error)
{
    found      above;
    uint32_t   id = 0;
    lmn_status status = find_operation(&above, scene, solid, parent, "lmn_solid_add_operation", error);
    if (status == LMN_OK)
        status = check_operation(operation, "lmn_solid_add_operation", error);
    if (status != LMN_OK)
        return status;
    const solid_addition what = {.kind = kind_of(operation), .matrix = mat4_identity()};
    status = solid_edit_add(scene, above.solid, above.node, &what, &id, error);
    if (status == LMN_OK)
        give(node, id);
    return status;
}

lmn_status lmn_solid_add_shape(lmn_scene *scene, uint32_t solid, uint32_t parent, const lmn_shape *shape,
                               uint32_t *node, lmn_error *error)
{
    found      above;
    mesh       made;
    uint32_t   id = 0;
    lmn_status status = find_operation(&above, scene, solid, parent, "lmn_solid_add_shape", error);
    if (status == LMN_OK)
        status = solid_shape_make(&made, shape, "lmn_solid_add_shape", error);
    if (status != LMN_OK)
        return status;
    const solid_addition what = {SOLID_OPERAND, &made, mat4_identity(), solid_shape_name(shape->kind)};
    status = solid_edit_add(scene, above.solid, above.node, &what, &id, error);
    if (status == LMN_OK)
        give(node, id);
    return status;
}

lmn_status lmn_solid_add_copy(lmn_scene *scene, uint32_t solid, uint32_t parent, uint32_t source, uint32_t *node,
                              lmn_error *error)
{
    found      above, from;
    uint32_t   id = 0;
    lmn_status status = find_operation(&above, scene, solid, parent, "lmn_solid_add_copy", error);
    if (status == LMN_OK)
        status = find(&from, scene, solid, source, "lmn_solid_add_copy", error);
    if (status == LMN_OK)
        status = solid_edit_copy(scene, above.solid, above.node, from.node, &id, error);
    if (status == LMN_OK)
        give(node, id);
    return status;
}

/* One shape of all meshes. */
static lmn_status add_meshes(lmn_scene *scene, const found *above, const lmn_scene *loaded, solid_addition *what,
                             const char *path, uint32_t *id, lmn_error *error)
{
    polyhedron gathered = {0};
    mesh       made = {.name = NULL};
    bool       open = false;
    lmn_status status = import_gather(&gathered, loaded, &open, error);
    if (status == LMN_OK && !polyhedron_into_mesh(&made, &gathered))
        status = error_memory(error);
    polyhedron_release(&gathered);
    if (status != LMN_OK)
        return status;
    what->kind = SOLID_OPERAND;
    what->mesh = &made;
    status = solid_edit_add(scene, above->solid, above->node, what, id, error);
    if (status == LMN_OK && open)
        warnings_add(&scene->warnings, WARNING_BAD_GEOMETRY, "the mesh in \"%.200s\" is not closed", path);
    return status;
}

lmn_status lmn_solid_add_file(lmn_scene *scene, uint32_t solid, uint32_t parent, const char *path,
                              const lmn_load_desc *desc, uint32_t *node, lmn_error *error)
{
    found         above;
    uint32_t      id = 0;
    lmn_load_desc full;
    lmn_status    status = find_operation(&above, scene, solid, parent, "lmn_solid_add_file", error);
    if (status == LMN_OK && (!path || !path[0]))
        status = error_set(error, LMN_USAGE, "lmn_solid_add_file: the path is empty");
    if (status == LMN_OK)
        status = load_desc_complete(&full, desc, "lmn_solid_add_file", error);
    if (status != LMN_OK)
        return status;
    work w;
    work_begin(&w, full.progress, full.progress_user);
    lmn_scene *loaded = NULL;
    status = import_file(&loaded, path, &full, error);
    if (status == LMN_OK)
        status = work_check(error);
    char *name = status == LMN_OK ? scene_name_of_file(path) : NULL;
    if (status == LMN_OK && !name)
        status = error_memory(error);
    if (status == LMN_OK) {
        solid_addition what = {.kind = SOLID_UNION,
                               .matrix = scene_up_rotation(loaded->up, scene_up_together(scene, loaded)),
                               .name = name};
        status = loaded->solid_count ? solid_edit_graft(scene, above.solid, above.node, loaded, &what, &id, error)
                                     : add_meshes(scene, &above, loaded, &what, path, &id, error);
    }
    if (status == LMN_OK) {
        warnings_append(&scene->warnings, &loaded->warnings);
        give(node, id);
    }
    mem_free(name);
    scene_free(loaded);
    return status == LMN_OK ? work_end_done(&w) : work_end(&w, status, error);
}

/* --- editing -------------------------------------------------------------------------------------------- */

static lmn_status check_matrix(const double m[16], lmn_error *error)
{
    if (!m)
        return error_set(error, LMN_USAGE, "lmn_solid_set_matrix: `matrix` is NULL");
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i]))
            return error_set(error, LMN_USAGE, "lmn_solid_set_matrix: number %d of the matrix is %g", i, m[i]);
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) {
        error_set(error, LMN_USAGE, "lmn_solid_set_matrix: the last row is %g %g %g %g, not 0 0 0 1", m[3], m[7], m[11],
                  m[15]);
        error_hint(error, "numbers are given column after column, so a translation is numbers 12, 13 and 14");
        return LMN_USAGE;
    }
    double determinant =
        m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) + m[8] * (m[1] * m[6] - m[2] * m[5]);
    double volume = hypot(hypot(m[0], m[1]), m[2]) * hypot(hypot(m[4], m[5]), m[6]) * hypot(hypot(m[8], m[9]), m[10]);
    if (fabs(determinant) > 1e-14 * volume && volume > 0)
        return LMN_OK;
    error_set(error, LMN_USAGE, "lmn_solid_set_matrix: the matrix flattens what is below it");
    error_hint(error, "its first three columns must not lie in a plane; to take a shape away, remove it");
    return LMN_USAGE;
}

lmn_status lmn_solid_set_matrix(lmn_scene *scene, uint32_t solid, uint32_t node, const double matrix[16],
                                lmn_error *error)
{
    found      it;
    mat4       own;
    lmn_status status = find(&it, scene, solid, node, "lmn_solid_set_matrix", error);
    if (status == LMN_OK)
        status = check_matrix(matrix, error);
    if (status != LMN_OK)
        return status;
    memcpy(own.m, matrix, sizeof own.m);
    return solid_edit_set_matrix(scene, it.solid, it.node, &own, error);
}

lmn_status lmn_solid_set_colour(lmn_scene *scene, uint32_t solid, uint32_t node, const float c[4], lmn_error *error)
{
    found      it;
    lmn_status status = find(&it, scene, solid, node, "lmn_solid_set_colour", error);
    for (int i = 0; i < 4 && c && status == LMN_OK; i++)
        if (!(c[i] >= 0 && c[i] <= 1)) {
            status =
                error_set(error, LMN_USAGE, "lmn_solid_set_colour: number %d of the colour is %g", i, (double)c[i]);
            error_hint(error, "red, green, blue and opacity are 0 to 1");
        }
    if (status != LMN_OK)
        return status;
    const vec4 linear =
        c ? (vec4){colour_to_linear(c[0]), colour_to_linear(c[1]), colour_to_linear(c[2]), c[3]} : (vec4){0, 0, 0, 0};
    solid_edit_set_colour(scene, it.solid, it.node, c ? &linear : NULL);
    return LMN_OK;
}

lmn_status lmn_solid_set_shown(lmn_scene *scene, uint32_t solid, uint32_t node, bool shown, lmn_error *error)
{
    found      it;
    lmn_status status = find(&it, scene, solid, node, "lmn_solid_set_shown", error);
    return status == LMN_OK ? solid_edit_set_shown(scene, it.solid, it.node, shown, error) : status;
}

lmn_status lmn_solid_set_operation(lmn_scene *scene, uint32_t solid, uint32_t node, lmn_operation operation,
                                   lmn_error *error)
{
    found      it;
    lmn_status status = find_operation(&it, scene, solid, node, "lmn_solid_set_operation", error);
    if (status == LMN_OK)
        status = check_operation(operation, "lmn_solid_set_operation", error);
    return status == LMN_OK ? solid_edit_set_operation(scene, it.solid, it.node, kind_of(operation), error) : status;
}

lmn_status lmn_solid_set_shape(lmn_scene *scene, uint32_t solid, uint32_t node, const lmn_shape *shape,
                               lmn_error *error)
{
    found      it;
    mesh       made;
    lmn_status status = find(&it, scene, solid, node, "lmn_solid_set_shape", error);
    if (status == LMN_OK && it.at->kind != SOLID_OPERAND) {
        status = error_set(error, LMN_USAGE, "lmn_solid_set_shape: node %u is an operation", (unsigned)node);
        error_hint(error, "remove it and add the shape to its parent");
    }
    if (status == LMN_OK)
        status = solid_shape_make(&made, shape, "lmn_solid_set_shape", error);
    return status == LMN_OK ? solid_edit_set_mesh(scene, it.solid, it.node, &made, error) : status;
}

lmn_status lmn_solid_set_name(lmn_scene *scene, uint32_t solid, uint32_t node, const char *name, lmn_error *error)
{
    found      it;
    lmn_status status = find(&it, scene, solid, node, "lmn_solid_set_name", error);
    return status == LMN_OK ? solid_edit_set_name(scene, it.solid, it.node, name, error) : status;
}

lmn_status lmn_solid_remove(lmn_scene *scene, uint32_t solid, uint32_t node, lmn_error *error)
{
    found      it;
    lmn_status status = find(&it, scene, solid, node, "lmn_solid_remove", error);
    return status == LMN_OK ? solid_edit_remove(scene, it.solid, it.node, error) : status;
}

lmn_status lmn_solid_move(lmn_scene *scene, uint32_t solid, uint32_t node, uint32_t parent, uint32_t before,
                          lmn_error *error)
{
    found      it, above, next = {.node = NONE};
    lmn_status status = find(&it, scene, solid, node, "lmn_solid_move", error);
    if (status == LMN_OK)
        status = find_operation(&above, scene, solid, parent, "lmn_solid_move", error);
    if (status == LMN_OK && before != 0)
        status = find(&next, scene, solid, before, "lmn_solid_move", error);
    if (status != LMN_OK)
        return status;
    if (it.node == 0)
        return error_set(error, LMN_USAGE, "lmn_solid_move: the root cannot be moved below another node");
    if (next.node != NONE && next.at->parent != above.node) {
        error_set(error, LMN_USAGE, "lmn_solid_move: node %u is no operand of node %u", (unsigned)before,
                  (unsigned)parent);
        error_hint(error, "`before` is one of the new parent's operands, or 0 for the end");
        return LMN_USAGE;
    }
    return solid_edit_move(scene, it.solid, it.node, above.node, next.node, error);
}

/* --- reading back --------------------------------------------------------------------------------------- */

size_t lmn_scene_solid_count(const lmn_scene *scene)
{
    size_t count = 0;
    for (size_t i = 0; scene && i < scene->solid_count; i++)
        count += scene->solids[i].node_count > 0 && !scene->solids[i].ghost;
    return count;
}

uint32_t lmn_scene_solid_at(const lmn_scene *scene, size_t index)
{
    for (size_t i = 0; scene && i < scene->solid_count; i++)
        if (scene->solids[i].node_count > 0 && !scene->solids[i].ghost && index-- == 0)
            return (uint32_t)i + 1;
    return 0;
}

static uint32_t id_at(const solid *s, int32_t node)
{
    return node == NONE ? 0 : s->nodes[node].id;
}

static void put_bounds(lmn_solid_info *out, box3 b)
{
    out->is_empty = box3_is_empty(b);
    if (out->is_empty)
        return;
    memcpy(out->bounds_min, (double[]){(double)b.min.x, (double)b.min.y, (double)b.min.z}, sizeof out->bounds_min);
    memcpy(out->bounds_max, (double[]){(double)b.max.x, (double)b.max.y, (double)b.max.z}, sizeof out->bounds_max);
}

bool lmn_solid_is_shown(const lmn_scene *scene, uint32_t solid_id, uint32_t node_id)
{
    const solid *s = solid_of(scene, solid_id);
    int32_t      at = s ? node_of(s, node_id) : NONE;
    return at != NONE && !s->nodes[at].hidden;
}

bool lmn_solid_info_of(const lmn_scene *scene, uint32_t solid_id, uint32_t node_id, lmn_solid_info *out)
{
    const solid *s = solid_of(scene, solid_id);
    int32_t      at = s ? node_of(s, node_id) : NONE;
    if (at == NONE || !out)
        return false;
    const solid_node *n = &s->nodes[at];
    *out = (lmn_solid_info){.operation = (lmn_operation)n->kind,
                            .parent = id_at(s, n->parent),
                            .first_child = id_at(s, n->first_child),
                            .next_sibling = id_at(s, n->next_sibling),
                            .name = n->name,
                            .has_colour = n->has_colour};
    memcpy(out->matrix, n->matrix.m, sizeof out->matrix);
    if (n->has_colour)
        memcpy(out->colour,
               (float[]){colour_from_linear(n->colour.x), colour_from_linear(n->colour.y),
                         colour_from_linear(n->colour.z), n->colour.w},
               sizeof out->colour);
    for (int32_t c = n->first_child; c != NONE; c = s->nodes[c].next_sibling)
        out->child_count++;
    for (int32_t i = at; i != NONE; i = solid_next(s, at, i))
        out->triangles += s->nodes[i].triangles;
    put_bounds(out, n->box);
    for (size_t i = 0; i < scene->part_count && out->part == 0; i++)
        if (scene->nodes[scene->parts[i].node].solid == (int32_t)solid_id - 1)
            out->part = (uint32_t)i + 1;
    return true;
}
