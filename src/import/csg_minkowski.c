/* Sums of solids (minkowski()) without computing a surface: convex pieces add up to convex pieces, and a concave
 * one plus a convex one is the concave one moved by a point of the other together with the sum along each of its
 * triangles. */
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "import/csg.h"

enum { OPERANDS_MAX = 2000 };

typedef struct piece_list {
    polyhedron *items;
    size_t      count, capacity;
} piece_list;

static void release_pieces(piece_list *l)
{
    for (size_t i = 0; i < l->count; i++)
        polyhedron_release(&l->items[i]);
    mem_free(l->items);
    *l = (piece_list){0};
}

/* Takes over what the polyhedron holds. */
static lmn_status add_piece(csg_reader *r, piece_list *l, polyhedron *p)
{
    if (!mem_grow((void **)&l->items, &l->capacity, l->count + 1, sizeof *l->items)) {
        polyhedron_release(p);
        return error_memory(r->error);
    }
    polyhedron_check_convex(p);
    l->items[l->count++] = *p;
    *p = (polyhedron){0};
    return LMN_OK;
}

/* *possible becomes false when something is taken away or cut out: then there are no pieces. */
static lmn_status gather_pieces(csg_reader *r, int32_t shape, const mat4 *above, piece_list *out, bool *possible)
{
    const csg_shape *s = &r->shapes[shape];
    mat4             position = mat4_multiply(above, &s->matrix);
    lmn_status       status = LMN_OK;
    if (s->kind == SOLID_OPERAND) {
        polyhedron p = {0};
        status = polyhedron_transform(&p, &r->meshes[s->mesh].polyhedron, &position, r->error);
        return status == LMN_OK ? add_piece(r, out, &p) : status;
    }
    *possible = *possible && s->kind == SOLID_UNION;
    for (int32_t c = s->first_child; c != NONE && status == LMN_OK && *possible; c = r->shapes[c].next)
        status = gather_pieces(r, c, &position, out, possible);
    return status;
}

static lmn_status moved_copy(csg_reader *r, const polyhedron *p, point3 by, piece_list *out)
{
    polyhedron copy = {0};
    mat4       m = mat4_identity();
    m.m[12] = by.x;
    m.m[13] = by.y;
    m.m[14] = by.z;
    lmn_status status = polyhedron_transform(&copy, p, &m, r->error);
    return status == LMN_OK ? add_piece(r, out, &copy) : status;
}

/* The hull of the convex one at the three corners. */
static lmn_status sum_with_triangle(csg_reader *r, const polyhedron *concave, size_t triangle, const polyhedron *convex,
                                    piece_list *out)
{
    polyhedron at_corners[3] = {{0}}, sum = {0};
    lmn_status status = LMN_OK;
    for (int i = 0; i < 3 && status == LMN_OK; i++) {
        point3 corner = concave->points[concave->triangles[3 * triangle + (size_t)i]];
        mat4   m = mat4_identity();
        m.m[12] = corner.x;
        m.m[13] = corner.y;
        m.m[14] = corner.z;
        status = polyhedron_transform(&at_corners[i], convex, &m, r->error);
    }
    if (status == LMN_OK)
        status = polyhedron_hull(&sum, at_corners, 3, r->error);
    for (int i = 0; i < 3; i++)
        polyhedron_release(&at_corners[i]);
    if (status != LMN_OK)
        polyhedron_release(&sum);
    return status == LMN_OK ? add_piece(r, out, &sum) : status;
}

static lmn_status sum_of_two(csg_reader *r, const polyhedron *a, const polyhedron *b, piece_list *out)
{
    if (a->convex && b->convex) {
        polyhedron sum = {0};
        lmn_status status = polyhedron_minkowski(&sum, a, b, r->error);
        if (status != LMN_OK)
            polyhedron_release(&sum);
        return status == LMN_OK ? add_piece(r, out, &sum) : status;
    }
    const polyhedron *concave = a->convex ? b : a, *convex = a->convex ? a : b;
    lmn_status        status = moved_copy(r, concave, convex->points[0], out);
    for (size_t i = 0; i < concave->triangle_count && status == LMN_OK; i++)
        status = sum_with_triangle(r, concave, i, convex, out);
    return status;
}

/* How many operands the sum takes; more than OPERANDS_MAX when it cannot be made. */
static size_t operands_of_sum(const piece_list *a, const piece_list *b)
{
    size_t count = 0;
    for (size_t i = 0; i < a->count; i++)
        for (size_t k = 0; k < b->count && count <= OPERANDS_MAX; k++) {
            const polyhedron *p = &a->items[i], *q = &b->items[k];
            if (p->convex && q->convex)
                count++;
            else if (p->convex || q->convex)
                count += 1 + (p->convex ? q : p)->triangle_count;
            else
                count = OPERANDS_MAX + 1;
        }
    return count;
}

/* Replaces *sum by its sum with the pieces; *possible as above. */
static lmn_status add_up(csg_reader *r, piece_list *sum, const piece_list *pieces, bool *possible)
{
    *possible = operands_of_sum(sum, pieces) <= OPERANDS_MAX;
    piece_list made = {0};
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < sum->count && *possible && status == LMN_OK; i++)
        for (size_t k = 0; k < pieces->count && status == LMN_OK; k++) {
            status = import_progress(r->job, 0.5, "evaluating", r->error);
            if (status == LMN_OK)
                status = sum_of_two(r, &sum->items[i], &pieces->items[k], &made);
        }
    if (status != LMN_OK || !*possible) {
        release_pieces(&made);
        return status;
    }
    release_pieces(sum);
    *sum = made;
    return LMN_OK;
}

static lmn_status shape_of_pieces(csg_reader *r, int32_t node, piece_list *sum, int32_t *shape)
{
    lmn_status status = csg_append_shape(r, SOLID_UNION, node, shape);
    for (size_t i = 0; i < sum->count && status == LMN_OK; i++) {
        int32_t operand, mesh;
        if (sum->items[i].triangle_count == 0)
            continue;
        status = csg_append_mesh(r, &sum->items[i], &mesh);
        if (status == LMN_OK)
            status = csg_append_shape(r, SOLID_OPERAND, node, &operand);
        if (status != LMN_OK)
            return status;
        r->shapes[operand].mesh = mesh;
        csg_append_child(r, *shape, operand);
    }
    int32_t first = r->shapes[*shape].first_child;
    if (status == LMN_OK && first == r->shapes[*shape].last_child)
        *shape = first;
    return status;
}

/* Empty operands do not count. *several: there is more than the first, which is the shape until the sum is known. */
static lmn_status add_children(csg_reader *r, int32_t node, piece_list *sum, int32_t *shape, bool *several,
                               bool *possible)
{
    const mat4 identity = mat4_identity();
    for (int32_t c = csg_child(r, node, NONE); c != NONE; c = csg_child(r, node, c)) {
        piece_list pieces = {0};
        int32_t    made;
        lmn_status status = csg_shape_of(r, c, &made);
        if (status == LMN_OK && made < 0)
            continue;
        if (status == LMN_OK && *shape == NONE) {
            *shape = made;
            status = gather_pieces(r, made, &identity, sum, possible);
        } else if (status == LMN_OK) {
            *several = true;
            if (*possible)
                status = gather_pieces(r, made, &identity, &pieces, possible);
            if (status == LMN_OK && *possible)
                status = add_up(r, sum, &pieces, possible);
        }
        release_pieces(&pieces);
        if (status != LMN_OK || (*several && !*possible))
            return status;
    }
    return LMN_OK;
}

/* All operands at once, by openscad. *made stays NONE where it cannot be asked; *why says why. */
static lmn_status sum_by_openscad(csg_reader *r, int32_t node, int32_t *made, const char **why)
{
    const mat4 identity = mat4_identity();
    int32_t   *shapes = NULL, mesh;
    size_t     count = 0, capacity = 0;
    polyhedron sum = {0};
    lmn_status status = LMN_OK;
    for (int32_t c = csg_child(r, node, NONE); c != NONE && status == LMN_OK; c = csg_child(r, node, c)) {
        int32_t own;
        status = csg_shape_of(r, c, &own);
        if (status == LMN_OK && own < 0)
            continue;
        if (status == LMN_OK && !mem_grow((void **)&shapes, &capacity, count + 1, sizeof *shapes))
            status = error_memory(r->error);
        if (status == LMN_OK)
            shapes[count++] = own;
    }
    if (status == LMN_OK)
        status = csg_evaluate(r, "minkowski()", &identity, shapes, count, &sum, why);
    mem_free(shapes);
    if (status != LMN_OK || *why || sum.triangle_count == 0) {
        polyhedron_release(&sum);
        return status;
    }
    status = csg_append_mesh(r, &sum, &mesh);
    if (status == LMN_OK)
        status = csg_append_shape(r, SOLID_OPERAND, node, made);
    if (status == LMN_OK)
        r->shapes[*made].mesh = mesh;
    return status;
}

/* Where pieces are of no use. */
static lmn_status sum_of_concave(csg_reader *r, int32_t node, int32_t *shape)
{
    const char *why = NULL;
    int32_t     made = NONE;
    lmn_status  status = sum_by_openscad(r, node, &made, &why);
    if (status == LMN_OK && !why)
        *shape = made;
    else if (status == LMN_OK)
        csg_warn(r, node, WARNING_APPROXIMATE,
                 "minkowski() draws its first operand alone: two operands are concave, one is not a union, or it takes "
                 "more than %d pieces; %s",
                 OPERANDS_MAX, why);
    return status;
}

lmn_status csg_minkowski(csg_reader *r, int32_t node, int32_t *shape)
{
    piece_list sum = {0};
    bool       possible = true, several = false;
    *shape = NONE;
    lmn_status status = add_children(r, node, &sum, shape, &several, &possible);
    if (status == LMN_OK && several && possible)
        status = shape_of_pieces(r, node, &sum, shape);
    else if (status == LMN_OK && several)
        status = sum_of_concave(r, node, shape);
    release_pieces(&sum);
    return csg_tolerate(r, node, status);
}
