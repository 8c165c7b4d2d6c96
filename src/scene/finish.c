/* The check that every imported scene passes before anything else sees it. */
#include <math.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "scene/clean.h"
#include "scene/parts.h"
#include "scene/scene.h"
#include "scene/solid.h"

typedef struct check {
    lmn_scene   *scene;
    const char  *file;
    lmn_error   *error;
    clean_counts counts;
} check;

static lmn_status over_limit(const check *c, const char *what, size_t limit)
{
    lmn_status status = error_in_file(c->error, LMN_LIMIT, c->file, 0, "more than %zu %s", limit, what);
    error_hint(c->error, "split or simplify the model");
    return status;
}

static lmn_status check_limits(const check *c)
{
    const lmn_scene *s = c->scene;
    uint64_t         vertices = 0, triangles = 0, lines = 0, instances = 0;
    for (size_t i = 0; i < s->mesh_count; i++)
        for (size_t k = 0; k < s->meshes[i].primitive_count; k++) {
            vertices += s->meshes[i].primitives[k].vertex_count;
            triangles += s->meshes[i].primitives[k].index_count / 3;
            lines += s->meshes[i].primitives[k].line_count;
        }
    for (size_t i = 0; i < s->node_count; i++)
        instances += s->nodes[i].instance_count;
    if (s->node_count > LIMIT_NODES)
        return over_limit(c, "nodes", LIMIT_NODES);
    if (vertices > LIMIT_VERTICES)
        return over_limit(c, "vertices", LIMIT_VERTICES);
    if (triangles > LIMIT_TRIANGLES)
        return over_limit(c, "triangles", LIMIT_TRIANGLES);
    if (lines > LIMIT_LINES)
        return over_limit(c, "lines", LIMIT_LINES);
    if (instances > LIMIT_INSTANCES)
        return over_limit(c, "instances", LIMIT_INSTANCES);
    return LMN_OK;
}

static bool in_range(int32_t index, size_t count)
{
    return index == NONE || (index >= 0 && (size_t)index < count);
}

static bool target_is_there(const lmn_scene *s, const animation_channel *c)
{
    const size_t counts[] = {
        [ANIMATED_NODE] = s->node_count, [ANIMATED_CAMERA] = s->camera_count, [ANIMATED_LIGHT] = s->light_count};
    return c->target != NONE && in_range(c->target, counts[animation_thing_of(c->path)]);
}

static lmn_status broken(const check *c, const char *what, size_t index, const char *refers)
{
    return error_in_file(c->error, LMN_FORMAT, c->file, 0, "%s %zu refers to a %s that does not exist", what, index,
                         refers);
}

/* Walks each root's tree; `state` counts visits, so that a second one shows a cycle or a shared child. */
static lmn_status walk_tree(const check *c, int32_t root, unsigned char *state, size_t *visited)
{
    const lmn_scene *s = c->scene;
    int              depth = 1;
    for (int32_t n = root; n != NONE;) {
        if (state[n]++)
            return error_in_file(c->error, LMN_FORMAT, c->file, 0, "node %d is its own ancestor or has two parents", n);
        ++*visited;
        if (depth > LIMIT_NODE_DEPTH)
            return error_in_file(c->error, LMN_LIMIT, c->file, 0, "the node tree is deeper than %d", LIMIT_NODE_DEPTH);
        int32_t child = s->nodes[n].first_child;
        if (child != NONE) {
            if (s->nodes[child].parent != n)
                return broken(c, "node", (size_t)n, "child");
            n = child;
            depth++;
            continue;
        }
        while (n != root && s->nodes[n].next_sibling == NONE) {
            n = s->nodes[n].parent;
            depth--;
        }
        int32_t parent = s->nodes[n].parent;
        n = n == root ? NONE : s->nodes[n].next_sibling;
        if (n != NONE && s->nodes[n].parent != parent)
            return broken(c, "node", (size_t)n, "parent");
    }
    return LMN_OK;
}

static lmn_status check_tree(const check *c)
{
    const lmn_scene *s = c->scene;
    for (size_t i = 0; i < s->node_count; i++) {
        const node *n = &s->nodes[i];
        if (!in_range(n->parent, s->node_count) || !in_range(n->first_child, s->node_count) ||
            !in_range(n->next_sibling, s->node_count))
            return broken(c, "node", i, "node");
    }
    unsigned char *state = mem_calloc(s->node_count, 1);
    if (!state)
        return error_memory(c->error);
    size_t     visited = 0;
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < s->node_count && status == LMN_OK; i++)
        if (s->nodes[i].parent == NONE)
            status = walk_tree(c, (int32_t)i, state, &visited);
    mem_free(state);
    if (status == LMN_OK && visited < s->node_count)
        status = error_in_file(c->error, LMN_FORMAT, c->file, 0, "the node tree has a cycle: %zu nodes have no root",
                               s->node_count - visited);
    return status;
}

static lmn_status check_nodes(const check *c)
{
    const lmn_scene *s = c->scene;
    for (size_t i = 0; i < s->node_count; i++) {
        const node *n = &s->nodes[i];
        if (!in_range(n->mesh, s->mesh_count))
            return broken(c, "node", i, "mesh");
        if (!in_range(n->solid, s->solid_count))
            return broken(c, "node", i, "solid");
        if (!in_range(n->skin, s->skin_count))
            return broken(c, "node", i, "skin");
        if (!in_range(n->camera, s->camera_count))
            return broken(c, "node", i, "camera");
        if (!in_range(n->light, s->light_count))
            return broken(c, "node", i, "light");
    }
    for (size_t i = 0; i < s->skin_count; i++)
        for (size_t k = 0; k < s->skins[i].joint_count; k++)
            if (s->skins[i].joints[k] == NONE || !in_range(s->skins[i].joints[k], s->node_count))
                return broken(c, "skin", i, "node");
    for (size_t i = 0; i < s->animation_count; i++)
        for (size_t k = 0; k < s->animations[i].channel_count; k++)
            if (!target_is_there(s, &s->animations[i].channels[k]))
                return broken(c, "animation", i, "target");
    for (size_t i = 0; i < s->solid_count; i++)
        for (size_t k = 0; k < s->solids[i].node_count; k++)
            if (!in_range(s->solids[i].nodes[k].mesh, s->mesh_count))
                return broken(c, "solid", i, "mesh");
    for (size_t i = 0; i < s->material_count; i++)
        if (!in_range(s->materials[i].base_texture.image, s->image_count) ||
            !in_range(s->materials[i].normal_texture.image, s->image_count))
            return broken(c, "material", i, "texture");
    return LMN_OK;
}

static lmn_status check_primitive(const check *c, size_t mesh_index, const primitive *p)
{
    if (!p->positions || (!p->indices && !p->lines) || (!p->indices && p->index_count) || p->index_count % 3 != 0 ||
        (p->lines && p->index_count))
        return error_in_file(c->error, LMN_INTERNAL, c->file, 0, "mesh %zu came without triangles or lines",
                             mesh_index);
    if (!in_range(p->material, c->scene->material_count))
        return broken(c, "mesh", mesh_index, "material");
    for (uint32_t i = 0; i < p->index_count; i++)
        if (p->indices[i] >= p->vertex_count)
            return error_in_file(c->error, LMN_FORMAT, c->file, 0,
                                 "mesh %zu: index %u of triangle %u is out of range, there are %u vertices", mesh_index,
                                 (unsigned)p->indices[i], (unsigned)(i / 3), (unsigned)p->vertex_count);
    for (uint32_t i = 0; i < 2 * p->line_count; i++)
        if (p->lines[i] >= p->vertex_count)
            return error_in_file(c->error, LMN_FORMAT, c->file, 0,
                                 "mesh %zu: index %u of line %u is out of range, there are %u vertices", mesh_index,
                                 (unsigned)p->lines[i], (unsigned)(i / 2), (unsigned)p->vertex_count);
    return LMN_OK;
}

/* Highest joint number that a mesh uses, −1 when it is not skinned. */
static int32_t highest_joint(const mesh *m)
{
    int32_t highest = -1;
    for (size_t i = 0; i < m->primitive_count; i++) {
        const primitive *p = &m->primitives[i];
        for (size_t k = 0; p->joints && k < (size_t)p->vertex_count * p->influences; k++)
            if (p->joints[k] > highest)
                highest = p->joints[k];
    }
    return highest;
}

static lmn_status check_joints(const check *c)
{
    const lmn_scene *s = c->scene;
    if (s->skin_count == 0)
        return LMN_OK;
    int32_t *highest = mem_alloc(s->mesh_count * sizeof *highest);
    if (!highest)
        return error_memory(c->error);
    for (size_t i = 0; i < s->mesh_count; i++)
        highest[i] = highest_joint(&s->meshes[i]);
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < s->node_count && status == LMN_OK; i++) {
        const node *n = &s->nodes[i];
        if (n->mesh != NONE && n->skin != NONE && highest[n->mesh] >= (int64_t)s->skins[n->skin].joint_count)
            status = error_in_file(c->error, LMN_FORMAT, c->file, 0, "mesh %d uses joint %d, but skin %d has only %zu",
                                   n->mesh, highest[n->mesh], n->skin, s->skins[n->skin].joint_count);
    }
    mem_free(highest);
    return status;
}

static bool all_finite(const double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return false;
    return true;
}

static void repair_transforms(check *c)
{
    for (size_t i = 0; i < c->scene->node_count; i++) {
        node             *n = &c->scene->nodes[i];
        const node_place *at = node_place_of(n);
        bool              good = !n->place || (all_finite(at->matrix.m, 16) && all_finite(at->translation, 3) &&
                                  all_finite(at->rotation, 4) && all_finite(at->scale, 3));
        for (size_t k = 0; k < n->instance_count; k++)
            if (!all_finite(n->instances[k].m, 16)) {
                n->instances[k] = mat4_identity();
                good = false;
            }
        if (good)
            continue;
        warnings_add(&c->scene->warnings, WARNING_BAD_VALUE, "a node's transform is not finite and was left out");
        if (n->place && !all_finite(at->matrix.m, 16))
            n->place->matrix = mat4_identity();
        n->has_matrix = n->place != NULL;
    }
}

/* Meshes that solids are made of: they must stay closed. NULL when memory is gone. */
static bool *find_operand_meshes(const lmn_scene *s)
{
    bool *found = mem_calloc(s->mesh_count, sizeof *found);
    for (size_t i = 0; found && i < s->solid_count; i++)
        for (size_t k = 0; k < s->solids[i].node_count; k++)
            if (s->solids[i].nodes[k].mesh != NONE)
                found[s->solids[i].nodes[k].mesh] = true;
    return found;
}

/* Others look at the first primitive for what a part is like. The mesh is as it was when memory is gone. */
static bool put_lines_last(mesh *m)
{
    size_t lines = 0, surfaces = 0;
    for (size_t i = 0; i < m->primitive_count; i++)
        lines += m->primitives[i].line_count > 0;
    if (lines == 0 || lines == m->primitive_count)
        return true;
    primitive *sorted = mem_alloc(m->primitive_count * sizeof *sorted);
    lines = m->primitive_count - lines;
    for (size_t i = 0; sorted && i < m->primitive_count; i++)
        sorted[m->primitives[i].line_count > 0 ? lines++ : surfaces++] = m->primitives[i];
    if (!sorted)
        return false;
    mem_free(m->primitives);
    m->primitives = sorted;
    return true;
}

static lmn_status clean_meshes(check *c, const bool *operands)
{
    for (size_t i = 0; i < c->scene->mesh_count; i++) {
        mesh  *m = &c->scene->meshes[i];
        size_t kept = 0;
        for (size_t k = 0; k < m->primitive_count; k++) {
            primitive *p = &m->primitives[k];
            lmn_status status = check_primitive(c, i, p);
            if (status != LMN_OK) {
                /* Those between `kept` and k were moved or released: close the gap so that nothing is freed twice. */
                memmove(&m->primitives[kept], p, (m->primitive_count - k) * sizeof *p);
                m->primitive_count = kept + (m->primitive_count - k);
                return status;
            }
            if (!primitive_clean(p, operands[i], &c->counts)) {
                memmove(&m->primitives[kept], p, (m->primitive_count - k) * sizeof *p);
                m->primitive_count = kept + (m->primitive_count - k);
                return error_memory(c->error);
            }
            if (p->index_count == 0 && p->line_count == 0) {
                primitive_release(p);
                continue;
            }
            if (kept != k)
                m->primitives[kept] = *p;
            kept++;
        }
        m->primitive_count = kept;
        if (!put_lines_last(m))
            return error_memory(c->error);
    }
    return LMN_OK;
}

static void tell(const check *c)
{
    const clean_counts *n = &c->counts;
    warnings           *w = &c->scene->warnings;
    if (n->degenerate)
        warnings_add(w, WARNING_BAD_GEOMETRY, "%llu triangles without area were left out",
                     (unsigned long long)n->degenerate);
    if (n->not_finite)
        warnings_add(w, WARNING_BAD_GEOMETRY, "%llu triangles with vertices that are not finite were left out",
                     (unsigned long long)n->not_finite);
    if (n->lines_short)
        warnings_add(w, WARNING_BAD_GEOMETRY, "%llu lines without length were left out",
                     (unsigned long long)n->lines_short);
    if (n->lines_not_finite)
        warnings_add(w, WARNING_BAD_GEOMETRY, "%llu lines with vertices that are not finite were left out",
                     (unsigned long long)n->lines_not_finite);
    if (n->normals)
        warnings_add(w, WARNING_BAD_VALUE, "%llu normals without direction were replaced by those of the triangles",
                     (unsigned long long)n->normals);
    if (n->values)
        warnings_add(w, WARNING_BAD_VALUE, "%llu texture coordinates, colours or weights that are not finite became 0",
                     (unsigned long long)n->values);
    if (n->unheld)
        warnings_add(w, WARNING_BAD_VALUE, "%llu vertices that no joint has a weight for follow their first one",
                     (unsigned long long)n->unheld);
}

static lmn_status nothing_to_draw(const check *c)
{
    const clean_counts *n = &c->counts;
    lmn_status          status;
    if (n->triangles + n->lines == 0)
        status = error_in_file(c->error, LMN_FORMAT, c->file, 0, "nothing to draw: the file has no triangles or lines");
    else if (n->triangles == 0 && n->lines == n->lines_short + n->lines_not_finite)
        status = error_in_file(c->error, LMN_FORMAT, c->file, 0,
                               "nothing to draw: none of the %llu lines has a length (%llu have vertices that are not "
                               "finite)",
                               (unsigned long long)n->lines, (unsigned long long)n->lines_not_finite);
    else if (n->triangles && n->triangles == n->degenerate + n->not_finite)
        status = error_in_file(c->error, LMN_FORMAT, c->file, 0,
                               "nothing to draw: none of the %llu triangles has an area (%llu have vertices that are "
                               "not finite)",
                               (unsigned long long)n->triangles, (unsigned long long)n->not_finite);
    else
        status = error_in_file(c->error, LMN_FORMAT, c->file, 0,
                               "nothing to draw: no node of the scene uses the file's meshes");
    error_hint(c->error, "points alone are not drawn; export the model with its surfaces or lines");
    return status;
}

/* Single-precision sums of squares overflow beyond this. */
static const float FARTHEST = 1e18f;

static bool is_far(box3 b)
{
    float reach[6] = {b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z};
    bool  far = false;
    for (int k = 0; k < 6; k++)
        far = far || !(fabsf(reach[k]) <= FARTHEST);
    return far && !box3_is_empty(b);
}

/* Transforms may be finite and still put a part where no camera can look. */
static lmn_status check_positions(const check *c, const part *parts, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!is_far(parts[i].bounds))
            continue;
        lmn_status status = error_in_file(c->error, LMN_FORMAT, c->file, 0,
                                          "part '%.100s' lies farther than 1e18 from the origin", parts[i].name);
        error_hint(c->error, "check the transforms above it");
        return status;
    }
    return LMN_OK;
}

/* A ghost that lies there is nobody's mistake, a cutter may be as long as it likes; it cannot be shown. Before the
 * list is the scene's. */
static void leave_out_far_ghosts(lmn_scene *s, part_list *l)
{
    size_t kept = l->part_count;
    for (size_t i = l->part_count; i < l->part_count + l->ghost_count; i++) {
        part *p = &l->parts[i];
        if (!is_far(p->bounds)) {
            l->parts[kept++] = *p;
            continue;
        }
        s->nodes[p->node].solid = NONE;
        mem_free(p->name);
        mem_free(p->path);
    }
    l->ghost_count = kept - l->part_count;
}

lmn_status scene_finish(lmn_scene *s, const char *file, lmn_error *error)
{
    check      c = {.scene = s, .file = file, .error = error};
    lmn_status status = check_limits(&c);
    if (status == LMN_OK)
        status = check_tree(&c);
    if (status == LMN_OK)
        status = check_nodes(&c);
    if (status == LMN_OK)
        status = check_joints(&c);
    if (status != LMN_OK)
        return status;
    repair_transforms(&c);
    if (!animations_clean(s))
        return error_memory(error);
    bool *operands = find_operand_meshes(s);
    status = operands ? clean_meshes(&c, operands) : error_memory(error);
    mem_free(operands);
    if (status != LMN_OK)
        return status;
    tell(&c);
    for (size_t i = 0; i < s->solid_count; i++) {
        if (!solid_measure(s, &s->solids[i]))
            return error_memory(error);
        s->solids[i].revision = scene_next_revision();
    }
    part_list list;
    if (!parts_list(s, NULL, 0, NULL, &list))
        return error_memory(error);
    leave_out_far_ghosts(s, &list);
    parts_release(s->parts, s->part_count + s->ghost_count);
    s->parts = list.parts;
    s->part_count = list.part_count;
    s->ghost_count = list.ghost_count;
    status = check_positions(&c, s->parts, s->part_count);
    if (status != LMN_OK)
        return status;
    s->revision = scene_next_revision();
    if (s->part_count > 0)
        return LMN_OK;
    if (!s->may_be_empty)
        return nothing_to_draw(&c);
    warnings_add(&s->warnings, WARNING_BAD_GEOMETRY, "nothing to draw: the file has no triangles or lines");
    return LMN_OK;
}
