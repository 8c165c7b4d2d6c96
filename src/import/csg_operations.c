/* Set operations, positions, colours, sizes and hulls of .csg files. */
#include <math.h>
#include <string.h>

#include "base/colour.h"
#include "base/error.h"
#include "base/memory.h"
#include "import/csg.h"

lmn_status csg_union(csg_reader *r, int32_t node, int32_t *shape)
{
    return csg_group(r, node, SOLID_UNION, shape);
}

lmn_status csg_difference(csg_reader *r, int32_t node, int32_t *shape)
{
    return csg_group(r, node, SOLID_DIFFERENCE, shape);
}

lmn_status csg_intersection(csg_reader *r, int32_t node, int32_t *shape)
{
    return csg_group(r, node, SOLID_INTERSECTION, shape);
}

/* --- positions --------------------------------------------------------------------------------------------- */

/* Numbers beyond this cannot place anything that is drawn. */
static const double LARGEST = 1e15;

static double determinant(const mat4 *a, int dimensions)
{
    const double *m = a->m;
    double        plane = m[0] * m[5] - m[4] * m[1];
    return dimensions == 2 ? plane
                           : plane * m[10] + (m[4] * m[9] - m[8] * m[5]) * m[2] + (m[8] * m[1] - m[0] * m[9]) * m[6];
}

/* Rows of a file are columns here; a fourth row other than 0 0 0 w is not affine. */
static const char *read_rows(const csg_tree *t, int32_t value, mat4 *out)
{
    if (t->values[value].kind != CSG_VECTOR)
        return "it has no matrix";
    int32_t row = value + 1;
    for (uint32_t i = 0; i < t->values[value].count && i < 4; i++, row = t->values[row].after) {
        double numbers[4] = {out->m[i], out->m[4 + i], out->m[8 + i], out->m[12 + i]};
        if (t->values[row].kind == CSG_VECTOR)
            csg_vector_numbers(t, row, numbers, 4);
        for (int k = 0; k < 4; k++)
            out->m[4 * k + (int)i] = numbers[k];
    }
    double w = out->m[15];
    if (out->m[3] != 0 || out->m[7] != 0 || out->m[11] != 0 || w == 0)
        return "its matrix is not affine";
    for (int i = 0; i < 16; i++) {
        out->m[i] /= i % 4 == 3 ? 1 : w;
        if (!(fabs(out->m[i]) <= LARGEST))
            return "its matrix has a number that is not finite or too large";
    }
    out->m[15] = 1;
    return NULL;
}

bool csg_read_matrix(csg_reader *r, int32_t node, int dimensions, mat4 *out)
{
    *out = mat4_identity();
    int32_t     value = csg_argument_value(&r->tree, node, "m", 0);
    const char *problem = value == NONE ? NULL : read_rows(&r->tree, value, out);
    if (!problem && determinant(out, dimensions) == 0)
        problem = "its matrix flattens what is below it";
    if (problem)
        csg_warn(r, node, WARNING_BAD_VALUE, "multmatrix() is left out: %s", problem);
    return !problem;
}

lmn_status csg_multmatrix(csg_reader *r, int32_t node, int32_t *shape)
{
    mat4 matrix;
    *shape = NONE;
    if (!csg_read_matrix(r, node, 3, &matrix))
        return LMN_OK;
    lmn_status status = csg_union(r, node, shape);
    if (status == LMN_OK && *shape >= 0)
        r->shapes[*shape].matrix = mat4_multiply(&matrix, &r->shapes[*shape].matrix);
    return status;
}

/* --- colours -------------------------------------------------------------------------------------------- */

static float unit(double value)
{
    return value > 0 ? value < 1 ? (float)value : 1.0f : 0.0f;
}

/* color() without a colour is written with negative numbers and colours nothing. */
bool csg_read_colour(const csg_reader *r, int32_t node, vec4 *out)
{
    double c[4] = {-1, -1, -1, 1};
    colour named;
    if (colour_parse(csg_string(&r->tree, node, "c", 0, ""), &named)) {
        c[0] = (double)named.r, c[1] = (double)named.g, c[2] = (double)named.b, c[3] = (double)named.a;
    } else {
        csg_numbers(&r->tree, node, "c", 0, c, 4, false);
    }
    c[3] = csg_number(&r->tree, node, "alpha", 1, c[3]);
    if (!(c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && c[3] >= 0))
        return false;
    *out = (vec4){colour_to_linear(unit(c[0])), colour_to_linear(unit(c[1])), colour_to_linear(unit(c[2])), unit(c[3])};
    return true;
}

lmn_status csg_color(csg_reader *r, int32_t node, int32_t *shape)
{
    lmn_status status = csg_union(r, node, shape);
    vec4       colour;
    if (status == LMN_OK && *shape >= 0 && csg_read_colour(r, node, &colour)) {
        r->shapes[*shape].has_colour = true;
        r->shapes[*shape].colour = colour;
    }
    return status;
}

/* --- sizes ---------------------------------------------------------------------------------------------- */

typedef struct extent {
    double low[3], high[3];
} extent;

static const extent EMPTY_EXTENT = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static extent operand_extent(const csg_reader *r, const csg_shape *s, const mat4 *position)
{
    const polyhedron *p = &r->meshes[s->mesh].polyhedron;
    extent            e = EMPTY_EXTENT;
    for (size_t i = 0; i < p->point_count; i++) {
        const double at[3] = {p->points[i].x, p->points[i].y, p->points[i].z};
        for (int k = 0; k < 3; k++) {
            double v =
                position->m[k] * at[0] + position->m[4 + k] * at[1] + position->m[8 + k] * at[2] + position->m[12 + k];
            e.low[k] = fmin(e.low[k], v);
            e.high[k] = fmax(e.high[k], v);
        }
    }
    return e;
}

/* What the shape can fill at most. */
static extent shape_extent(const csg_reader *r, int32_t shape, const mat4 *above)
{
    const csg_shape *s = &r->shapes[shape];
    mat4             position = mat4_multiply(above, &s->matrix);
    if (s->kind == SOLID_OPERAND)
        return operand_extent(r, s, &position);
    extent all = shape_extent(r, s->first_child, &position);
    for (int32_t c = r->shapes[s->first_child].next; c != NONE && s->kind != SOLID_DIFFERENCE; c = r->shapes[c].next) {
        extent e = shape_extent(r, c, &position);
        for (int k = 0; k < 3; k++) {
            all.low[k] = s->kind == SOLID_UNION ? fmin(all.low[k], e.low[k]) : fmax(all.low[k], e.low[k]);
            all.high[k] = s->kind == SOLID_UNION ? fmax(all.high[k], e.high[k]) : fmin(all.high[k], e.high[k]);
        }
    }
    return all;
}

void csg_resize_factors(const csg_reader *r, int32_t node, const double *size, int dimensions, double *factors)
{
    const csg_tree *t = &r->tree;
    double          wanted[3] = {0, 0, 0};
    int             largest = 0;
    bool            automatic[3] = {false, false, false};
    csg_numbers(t, node, "newsize", 0, wanted, (uint32_t)dimensions, false);
    int32_t flags = csg_argument_value(t, node, "auto", 1);
    int32_t element = flags + 1;
    for (int i = 0; i < 3 && flags != NONE; i++) {
        bool             vector = t->values[flags].kind == CSG_VECTOR;
        const csg_value *v = &t->values[vector ? element : flags];
        if (vector && (uint32_t)i >= t->values[flags].count)
            break;
        automatic[i] = (v->kind == CSG_BOOL && v->as.truth) || (v->kind == CSG_NUMBER && v->as.number != 0);
        element = vector ? v->after : element;
    }
    for (int i = 1; i < dimensions; i++)
        if (wanted[i] > wanted[largest])
            largest = i;
    double same = wanted[largest] > 0 && size[largest] > 0 ? wanted[largest] / size[largest] : 1;
    for (int i = 0; i < dimensions; i++)
        factors[i] = wanted[i] > 0 && size[i] > 0 ? wanted[i] / size[i] : automatic[i] && !(wanted[i] > 0) ? same : 1;
}

/* The file's numbers may be exact where the tree only tells what is at most filled; then the result is nearly as
 * large. */
lmn_status csg_resize(csg_reader *r, int32_t node, int32_t *shape)
{
    lmn_status status = csg_union(r, node, shape);
    if (status != LMN_OK || *shape < 0)
        return status;
    mat4   scale = mat4_identity();
    extent e = shape_extent(r, *shape, &scale);
    double size[3], factors[3];
    for (int k = 0; k < 3; k++)
        size[k] = e.high[k] - e.low[k];
    csg_resize_factors(r, node, size, 3, factors);
    for (int k = 0; k < 3; k++) {
        if (!(factors[k] > 0 && factors[k] <= LARGEST)) {
            csg_warn(r, node, WARNING_BAD_VALUE, "resize() is left out: its factors are not finite or too large");
            return LMN_OK;
        }
        scale.m[5 * k] = factors[k];
    }
    for (int32_t i = *shape; i != NONE && r->shapes[i].kind != SOLID_OPERAND; i = r->shapes[i].first_child)
        if (r->shapes[i].kind == SOLID_INTERSECTION || r->shapes[i].kind == SOLID_DIFFERENCE) {
            csg_warn(r, node, WARNING_APPROXIMATE, "resize() of a %s() takes its size from the operands",
                     csg_word(&r->tree, r->shapes[i].node));
            break;
        }
    r->shapes[*shape].matrix = mat4_multiply(&scale, &r->shapes[*shape].matrix);
    return LMN_OK;
}

/* --- hulls ---------------------------------------------------------------------------------------------- */

typedef struct hull_input {
    csg_reader *reader;
    int32_t     node;
    const char *why; /* openscad has not computed it */
    polyhedron *items;
    size_t      count, capacity;
} hull_input;

static lmn_status add_to_hull(hull_input *h, int32_t shape, const mat4 *above)
{
    csg_reader      *r = h->reader;
    const csg_shape *s = &r->shapes[shape];
    mat4             position = mat4_multiply(above, &s->matrix);
    if (s->kind == SOLID_OPERAND) {
        if (!mem_grow((void **)&h->items, &h->capacity, h->count + 1, sizeof *h->items))
            return error_memory(r->error);
        h->items[h->count] = (polyhedron){0};
        return polyhedron_transform(&h->items[h->count++], &r->meshes[s->mesh].polyhedron, &position, r->error);
    }
    if (s->kind != SOLID_UNION)
        csg_warn(r, h->node, WARNING_APPROXIMATE, "hull() takes the %s() in line %u as its first operand; %s",
                 csg_word(&r->tree, s->node), (unsigned)r->tree.nodes[s->node].line, h->why);
    lmn_status status = LMN_OK;
    for (int32_t c = s->first_child; c != NONE && status == LMN_OK;
         c = s->kind == SOLID_UNION ? r->shapes[c].next : NONE)
        status = add_to_hull(h, c, &position);
    return status;
}

/* Is something taken away or cut out below? */
static bool has_more_than_unions(const csg_reader *r, int32_t shape)
{
    const csg_shape *s = &r->shapes[shape];
    bool             out = s->kind != SOLID_OPERAND && s->kind != SOLID_UNION;
    for (int32_t c = s->first_child; c != NONE && s->kind != SOLID_OPERAND && !out; c = r->shapes[c].next)
        out = has_more_than_unions(r, c);
    return out;
}

lmn_status csg_hull(csg_reader *r, int32_t node, polyhedron *out)
{
    int32_t    shape;
    lmn_status status = csg_union(r, node, &shape);
    if (status != LMN_OK || shape < 0)
        return status;
    const mat4 identity = mat4_identity();
    hull_input h = {.reader = r, .node = node};
    if (has_more_than_unions(r, shape)) {
        status = csg_evaluate(r, "hull()", &identity, &shape, 1, out, &h.why);
        if (status != LMN_OK || !h.why)
            return status;
    }
    status = add_to_hull(&h, shape, &identity);
    if (status == LMN_OK)
        status = polyhedron_hull(out, h.items, h.count, r->error);
    for (size_t i = 0; i < h.count; i++)
        polyhedron_release(&h.items[i]);
    mem_free(h.items);
    return status;
}
