/* What the words of .csg files mean, and how shapes and leaves are kept. */
#include "import/csg.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"

/* As with OpenSCAD, `roof` and what later versions add is not here and left out. */
static const csg_meaning meanings[] = {
    {"", 0, .shape = csg_union, .region = csg_region_union, .groups = true},
    {"group", 0, .shape = csg_union, .region = csg_region_union, .groups = true},
    {"union", 0, .shape = csg_union, .region = csg_region_union, .groups = true},
    {"render", 0, .shape = csg_union, .region = csg_region_union, .groups = true},
    {"multmatrix", 0, .shape = csg_multmatrix, .region = csg_region_multmatrix, .groups = true},
    {"color", 0, .shape = csg_color, .region = csg_region_union, .groups = true},
    {"difference", 0, .shape = csg_difference, .region = csg_region_difference},
    {"intersection", 0, .shape = csg_intersection, .region = csg_region_intersection},
    {"resize", 0, .shape = csg_resize, .region = csg_region_resize},
    {"minkowski", 0, .shape = csg_minkowski, .region = csg_region_minkowski},
    {"hull", 0, .mesh = csg_hull, .region = csg_region_hull},
    {"cube", 3, .mesh = csg_cube},
    {"sphere", 3, .mesh = csg_sphere},
    {"cylinder", 3, .mesh = csg_cylinder},
    {"polyhedron", 3, .mesh = csg_polyhedron},
    {"linear_extrude", 3, .mesh = csg_linear_extrude},
    {"rotate_extrude", 3, .mesh = csg_rotate_extrude},
    {"surface", 3, .mesh = csg_surface},
    {"square", 2, .region = csg_square},
    {"circle", 2, .region = csg_circle},
    {"polygon", 2, .region = csg_polygon},
    {"text", 2, .region = csg_text},
    {"offset", 2, .region = csg_offset},
    {"projection", 2, .region = csg_projection},
    {"import", -1, .mesh = csg_import_mesh, .region = csg_import_region},
};

const csg_meaning *csg_meaning_of(const csg_reader *r, int32_t node)
{
    const char *word = csg_word(&r->tree, node);
    for (size_t i = 0; i < sizeof meanings / sizeof *meanings; i++)
        if (strcmp(meanings[i].word, word) == 0)
            return &meanings[i];
    return NULL;
}

void csg_warn(csg_reader *r, int32_t node, warning_code code, const char *format, ...)
{
    char    message[384];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    warnings_add(&r->job->scene->warnings, code, "%s, line %u%s: %s", r->job->path, (unsigned)r->tree.nodes[node].line,
                 r->evaluated ? " as evaluated" : "", message);
}

lmn_status csg_tolerate(csg_reader *r, int32_t node, lmn_status status)
{
    if (status == LMN_FORMAT || status == LMN_UNSUPPORTED) {
        csg_warn(r, node, WARNING_BAD_VALUE, "%s() is left out: %s", csg_word(&r->tree, node), r->error->message);
        memset(r->error, 0, sizeof *r->error);
        return LMN_OK;
    }
    if (status == LMN_LIMIT && r->error->line == 0)
        r->error->line = (int)r->tree.nodes[node].line;
    return status;
}

/* --- children and dimensions ---------------------------------------------------------------------------- */

int32_t csg_child(const csg_reader *r, int32_t parent, int32_t previous)
{
    const csg_tree *t = &r->tree;
    int32_t         child = previous == NONE ? csg_first_child(t, parent) : csg_next_child(t, parent, previous);
    while (child != NONE && (t->nodes[child].modifiers & (CSG_BACKGROUND | CSG_DISABLED)))
        child = csg_next_child(t, parent, child);
    return child;
}

static uint8_t dimension_of(const csg_reader *r, int32_t node)
{
    const csg_meaning *m = csg_meaning_of(r, node);
    if (!m || m->dimension != 0)
        return (uint8_t)(!m ? 0 : m->dimension > 0 ? m->dimension : csg_file_dimension(r, node));
    for (int32_t c = csg_child(r, node, NONE); c != NONE; c = csg_child(r, node, c))
        if (r->tree.nodes[c].dimension != 0)
            return r->tree.nodes[c].dimension;
    return 0;
}

void csg_set_dimensions(csg_reader *r)
{
    csg_tree *t = &r->tree;
    for (size_t i = t->node_count; i-- > 0;)
        t->nodes[i].dimension = dimension_of(r, (int32_t)i);
    for (int32_t i = 0; i < (int32_t)t->node_count;) {
        const csg_node *n = &t->nodes[i];
        bool            background = n->modifiers & CSG_BACKGROUND, unknown = !csg_meaning_of(r, i);
        if (background)
            csg_warn(r, i, WARNING_BACKGROUND, "%s() is background (%%) and left out", csg_word(t, i));
        else if (unknown)
            csg_warn(r, i, WARNING_IGNORED, "%.60s() is not known and left out", csg_word(t, i));
        else if (csg_meaning_of(r, i)->dimension < 0 && n->dimension == 0)
            csg_warn(r, i, WARNING_MISSING_FILE, "%s() is left out: the ending of \"%.200s\" is none that is read",
                     csg_word(t, i), csg_string(t, i, "file", 0, ""));
        i = background || unknown || (n->modifiers & CSG_DISABLED) ? n->after : i + 1;
    }
}

/* --- shapes --------------------------------------------------------------------------------------------- */

lmn_status csg_append_shape(csg_reader *r, solid_kind kind, int32_t node, int32_t *shape)
{
    if (r->shape_count >= INT32_MAX - 1 ||
        !mem_grow((void **)&r->shapes, &r->shape_capacity, r->shape_count + 1, sizeof *r->shapes))
        return error_memory(r->error);
    *shape = (int32_t)r->shape_count++;
    r->shapes[*shape] = (csg_shape){.kind = kind,
                                    .first_child = NONE,
                                    .last_child = NONE,
                                    .next = NONE,
                                    .node = node,
                                    .mesh = NONE,
                                    .matrix = mat4_identity()};
    return LMN_OK;
}

void csg_append_child(csg_reader *r, int32_t parent, int32_t child)
{
    csg_shape *p = &r->shapes[parent];
    if (p->last_child == NONE)
        p->first_child = child;
    else
        r->shapes[p->last_child].next = child;
    p->last_child = child;
}

/* As OpenSCAD: what has another dimension than the first counts as nothing. */
static lmn_status shape_of_child(csg_reader *r, int32_t parent, int32_t child, bool plates, int32_t *shape)
{
    int wanted = plates ? 2 : 3, found = r->tree.nodes[child].dimension;
    *shape = NONE;
    if (found != 0 && found != wanted) {
        csg_warn(r, child, WARNING_IGNORED, "%s() is %dD among %dD objects of %s%s and left out",
                 csg_word(&r->tree, child), found, wanted, parent == 0 ? "the file" : csg_word(&r->tree, parent),
                 parent == 0 ? "" : "()");
        return LMN_OK;
    }
    return plates ? csg_plate_of(r, child, shape) : csg_shape_of(r, child, shape);
}

/* An intersection with nothing is nothing, and so is nothing less something. One alone needs no operation. */
static lmn_status group(csg_reader *r, int32_t node, solid_kind kind, bool plates, int32_t *shape)
{
    int32_t first = NONE, last = NONE;
    *shape = NONE;
    for (int32_t c = csg_child(r, node, NONE); c != NONE; c = csg_child(r, node, c)) {
        int32_t    made;
        lmn_status status = shape_of_child(r, node, c, plates, &made);
        if (status != LMN_OK)
            return status;
        if (made < 0) {
            if ((kind == SOLID_INTERSECTION && made == NONE) || (kind == SOLID_DIFFERENCE && first == NONE))
                return LMN_OK;
            continue;
        }
        if (first == NONE)
            first = made;
        else
            r->shapes[last].next = made;
        last = made;
    }
    *shape = first;
    if (first == last)
        return LMN_OK;
    lmn_status status = csg_append_shape(r, kind, node, shape);
    if (status != LMN_OK)
        return status;
    r->shapes[*shape].first_child = first;
    r->shapes[*shape].last_child = last;
    return LMN_OK;
}

lmn_status csg_group(csg_reader *r, int32_t node, solid_kind kind, int32_t *shape)
{
    return group(r, node, kind, false, shape);
}

/* --- leaves --------------------------------------------------------------------------------------------- */

/* Beyond this the sums of the drawing lose all digits; nobody means it. */
static const double FARTHEST = 1e15;

static bool within_reach(const polyhedron *p)
{
    for (size_t i = 0; i < p->point_count; i++)
        if (!(fabs(p->points[i].x) <= FARTHEST && fabs(p->points[i].y) <= FARTHEST && fabs(p->points[i].z) <= FARTHEST))
            return false;
    return true;
}

lmn_status csg_append_mesh(csg_reader *r, polyhedron *p, int32_t *mesh)
{
    if (!mem_grow((void **)&r->meshes, &r->mesh_capacity, r->mesh_count + 1, sizeof *r->meshes)) {
        polyhedron_release(p);
        return error_memory(r->error);
    }
    *mesh = (int32_t)r->mesh_count++;
    r->meshes[*mesh] = (csg_mesh){.polyhedron = *p, .scene_mesh = NONE, .node = NONE};
    *p = (polyhedron){0};
    return LMN_OK;
}

static size_t slot_of(const csg_reader *r, int32_t node, bool plate)
{
    size_t slot = (size_t)(r->tree.nodes[node].hash + plate) & (r->slot_count - 1);
    for (; r->slots[slot] != NONE; slot = (slot + 1) & (r->slot_count - 1)) {
        const csg_mesh *m = &r->meshes[r->slots[slot]];
        if (m->plate == plate && csg_equal(&r->tree, m->node, node))
            break;
    }
    return slot;
}

/* Doubles the table before it is half full. */
static lmn_status grow_slots(csg_reader *r)
{
    if (r->slot_count > 2 * r->mesh_count)
        return LMN_OK;
    size_t count = r->slot_count ? 2 * r->slot_count : 64;
    while (count <= 2 * r->mesh_count)
        count *= 2;
    int32_t *slots = mem_alloc(count * sizeof *slots);
    if (!slots)
        return error_memory(r->error);
    memset(slots, 0xFF, count * sizeof *slots);
    mem_free(r->slots);
    r->slots = slots;
    r->slot_count = count;
    for (size_t i = 0; i < r->mesh_count; i++)
        if (r->meshes[i].node != NONE)
            r->slots[slot_of(r, r->meshes[i].node, r->meshes[i].plate)] = (int32_t)i;
    return LMN_OK;
}

static lmn_status make_leaf(csg_reader *r, int32_t node, bool plate, polyhedron *out)
{
    const csg_meaning *m = csg_meaning_of(r, node);
    lmn_status         status =
        import_progress(r->job, 0.2 + 0.6 * (double)node / (double)r->tree.node_count, "evaluating", r->error);
    if (status != LMN_OK)
        return status;
    if (!csg_all_finite(&r->tree, node))
        status = error_set(r->error, LMN_FORMAT, "a number is not finite");
    else
        status = plate ? csg_plate_mesh(r, node, out) : m->mesh(r, node, out);
    if (status == LMN_OK && !within_reach(out))
        status = error_set(r->error, LMN_FORMAT, "it reaches farther than 1e15 from its origin");
    if (status != LMN_OK)
        polyhedron_release(out);
    return csg_tolerate(r, node, status);
}

/* Finds the mesh of a leaf, or makes it. What is made below it for a moment is forgotten again. */
static lmn_status leaf_mesh(csg_reader *r, int32_t node, bool plate, int32_t *mesh)
{
    lmn_status status = grow_slots(r);
    if (status != LMN_OK)
        return status;
    *mesh = r->slots[slot_of(r, node, plate)];
    if (*mesh != NONE)
        return LMN_OK;
    polyhedron made = {0};
    size_t     shapes = r->shape_count;
    bool       above = r->absent;
    r->absent = false;
    status = make_leaf(r, node, plate, &made);
    bool absent = r->absent;
    r->absent = above;
    r->shape_count = shapes;
    if (status == LMN_OK)
        status = csg_append_mesh(r, &made, mesh);
    if (status == LMN_OK)
        status = grow_slots(r); /* leaves below may have filled it */
    if (status != LMN_OK)
        return status;
    r->meshes[*mesh].node = node;
    r->meshes[*mesh].plate = plate;
    r->meshes[*mesh].absent = absent;
    r->slots[slot_of(r, node, plate)] = *mesh;
    return LMN_OK;
}

static lmn_status leaf(csg_reader *r, int32_t node, bool plate, int32_t *shape)
{
    int32_t mesh;
    *shape = NONE;
    lmn_status status = leaf_mesh(r, node, plate, &mesh);
    if (status != LMN_OK)
        return status;
    if (r->meshes[mesh].absent || r->meshes[mesh].polyhedron.triangle_count == 0) {
        *shape = r->meshes[mesh].absent ? CSG_ABSENT : NONE;
        return LMN_OK;
    }
    status = csg_append_shape(r, SOLID_OPERAND, node, shape);
    if (status == LMN_OK)
        r->shapes[*shape].mesh = mesh;
    return status;
}

lmn_status csg_shape_of(csg_reader *r, int32_t node, int32_t *shape)
{
    const csg_meaning *m = csg_meaning_of(r, node);
    *shape = m ? NONE : CSG_ABSENT;
    if (!m || r->tree.nodes[node].dimension != 3)
        return LMN_OK;
    return m->shape ? m->shape(r, node, shape) : leaf(r, node, false, shape);
}

/* --- plates --------------------------------------------------------------------------------------------- */

/* A difference or intersection is one figure: it has the first colour that stands in it. */
static void take_colour(csg_reader *r, int32_t node, int32_t shape)
{
    const csg_meaning *m = csg_meaning_of(r, node);
    if (m->shape != csg_difference && m->shape != csg_intersection)
        return;
    for (int32_t i = node; i < r->tree.nodes[node].after && !r->shapes[shape].has_colour; i++)
        if (strcmp(csg_word(&r->tree, i), "color") == 0)
            r->shapes[shape].has_colour = csg_read_colour(r, i, &r->shapes[shape].colour);
}

/* Groups stay, so that their figures keep colours and positions; OpenSCAD's preview moves them in space too. */
lmn_status csg_plate_of(csg_reader *r, int32_t node, int32_t *shape)
{
    const csg_meaning *m = csg_meaning_of(r, node);
    *shape = m ? NONE : CSG_ABSENT;
    if (!m || r->tree.nodes[node].dimension != 2)
        return LMN_OK;
    if (!m->groups) {
        lmn_status status = leaf(r, node, true, shape);
        if (status == LMN_OK && *shape >= 0)
            take_colour(r, node, *shape);
        return status;
    }
    mat4 matrix = mat4_identity();
    if (m->shape == csg_multmatrix && !csg_read_matrix(r, node, 2, &matrix))
        return LMN_OK;
    lmn_status status = group(r, node, SOLID_UNION, true, shape);
    if (status != LMN_OK || *shape < 0)
        return status;
    csg_shape *s = &r->shapes[*shape];
    s->matrix = mat4_multiply(&matrix, &s->matrix);
    vec4 colour;
    if (m->shape == csg_color && csg_read_colour(r, node, &colour)) {
        s->has_colour = true;
        s->colour = colour;
    }
    return LMN_OK;
}
