/* Solids cut by the plane z = 0 and their shadows on it (projection()). A cut of a tree is the tree of the cuts; a
 * shadow is that only for unions. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "import/csg.h"

/* How many cuts stand for the shadow of a difference or intersection. */
enum { CUTS = 64 };

static lmn_status cut_operand(csg_reader *r, const csg_shape *s, const mat4 *position, region *out)
{
    polyhedron p = {0};
    lmn_status status = polyhedron_transform(&p, &r->meshes[s->mesh].polyhedron, position, r->error);
    if (status == LMN_OK)
        status = polyhedron_slice(out, &p, r->error);
    polyhedron_release(&p);
    return status;
}

static region_operation operation_of(solid_kind kind)
{
    return kind == SOLID_UNION ? REGION_UNION : kind == SOLID_INTERSECTION ? REGION_INTERSECTION : REGION_DIFFERENCE;
}

/* Applies one function to all children and puts the regions together. */
typedef lmn_status (*project_fn)(csg_reader *r, int32_t node, int32_t shape, const mat4 *above, region *out);

static lmn_status combine_children(csg_reader *r, int32_t node, int32_t shape, const mat4 *position, project_fn fn,
                                   region *out)
{
    region    *items = NULL;
    size_t     count = 0, capacity = 0;
    lmn_status status = LMN_OK;
    for (int32_t c = r->shapes[shape].first_child; c != NONE && status == LMN_OK; c = r->shapes[c].next) {
        if (!mem_grow((void **)&items, &capacity, count + 1, sizeof *items)) {
            status = error_memory(r->error);
            break;
        }
        items[count] = (region){0};
        status = fn(r, node, c, position, &items[count++]);
    }
    if (status == LMN_OK)
        status = region_combine(out, items, count, operation_of(r->shapes[shape].kind), r->error);
    for (size_t i = 0; i < count; i++)
        region_release(&items[i]);
    mem_free(items);
    return status;
}

static lmn_status cut(csg_reader *r, int32_t node, int32_t shape, const mat4 *above, region *out)
{
    const csg_shape *s = &r->shapes[shape];
    mat4             position = mat4_multiply(above, &s->matrix);
    return s->kind == SOLID_OPERAND ? cut_operand(r, s, &position, out)
                                    : combine_children(r, node, shape, &position, cut, out);
}

/* How far the shape reaches along z at most. */
static void reach(const csg_reader *r, int32_t shape, const mat4 *above, double *low, double *high)
{
    const csg_shape *s = &r->shapes[shape];
    mat4             position = mat4_multiply(above, &s->matrix);
    if (s->kind == SOLID_OPERAND) {
        const polyhedron *p = &r->meshes[s->mesh].polyhedron;
        for (size_t i = 0; i < p->point_count; i++) {
            double z = position.m[2] * p->points[i].x + position.m[6] * p->points[i].y +
                       position.m[10] * p->points[i].z + position.m[14];
            *low = fmin(*low, z);
            *high = fmax(*high, z);
        }
        return;
    }
    for (int32_t c = s->first_child; c != NONE; c = s->kind == SOLID_DIFFERENCE ? NONE : r->shapes[c].next) {
        double l = INFINITY, h = -INFINITY;
        reach(r, c, &position, &l, &h);
        bool first = c == s->first_child, inside = s->kind == SOLID_INTERSECTION && !first;
        *low = inside ? fmax(*low, l) : fmin(*low, l);
        *high = inside ? fmin(*high, h) : fmax(*high, h);
    }
}

typedef struct heights {
    double *items;
    size_t  count, capacity;
} heights;

static lmn_status gather_heights(csg_reader *r, int32_t shape, const mat4 *above, heights *out)
{
    const csg_shape *s = &r->shapes[shape];
    mat4             position = mat4_multiply(above, &s->matrix);
    lmn_status       status = LMN_OK;
    for (int32_t c = s->first_child; c != NONE && status == LMN_OK; c = r->shapes[c].next)
        status = gather_heights(r, c, &position, out);
    if (s->kind != SOLID_OPERAND)
        return status;
    const polyhedron *p = &r->meshes[s->mesh].polyhedron;
    if (!mem_grow((void **)&out->items, &out->capacity, out->count + p->point_count, sizeof *out->items))
        return error_memory(r->error);
    for (size_t i = 0; i < p->point_count; i++)
        out->items[out->count++] = position.m[2] * p->points[i].x + position.m[6] * p->points[i].y +
                                   position.m[10] * p->points[i].z + position.m[14];
    return LMN_OK;
}

static int compare_heights(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Each within reach once; of too many, every n-th. */
static void thin_out(heights *h, double low, double high)
{
    double apart = (high - low) * 1e-6;
    size_t kept = 0, most = CUTS / 2;
    qsort(h->items, h->count, sizeof *h->items, compare_heights);
    for (size_t i = 0; i < h->count; i++)
        if (h->items[i] > low && h->items[i] < high && (kept == 0 || h->items[i] > h->items[kept - 1] + apart))
            h->items[kept++] = h->items[i];
    h->count = kept < most ? kept : most;
    for (size_t i = 0; i < h->count; i++)
        h->items[i] = h->items[i * kept / h->count];
}

/* Cuts at many heights, united: through the corners, where the outline of what is round is widest, and between. */
static lmn_status shadow_by_cuts(csg_reader *r, int32_t node, int32_t shape, const mat4 *above, const char *why,
                                 region *out)
{
    region  cuts[CUTS] = {{0}};
    heights h = {0};
    double  low = INFINITY, high = -INFINITY;
    reach(r, shape, above, &low, &high);
    csg_warn(r, node, WARNING_APPROXIMATE, "projection() of the %s() in line %u is put together from %d cuts; %s",
             csg_word(&r->tree, r->shapes[shape].node), (unsigned)r->tree.nodes[r->shapes[shape].node].line, CUTS, why);
    lmn_status status = low < high ? gather_heights(r, shape, above, &h) : LMN_OK;
    if (status == LMN_OK && low < high)
        thin_out(&h, low, high);
    for (size_t i = 0; i < CUTS && low < high && status == LMN_OK; i++) {
        double between = ((double)(i - h.count) + 0.5) / (double)(CUTS - h.count), margin = (high - low) * 1e-9;
        mat4   down = mat4_identity();
        down.m[14] = -(i < h.count ? h.items[i] + margin : low + (high - low) * between);
        mat4 position = mat4_multiply(&down, above);
        status = import_progress(r->job, 0.5, "evaluating", r->error);
        if (status == LMN_OK)
            status = cut(r, node, shape, &position, &cuts[i]);
    }
    if (status == LMN_OK)
        status = region_combine(out, cuts, CUTS, REGION_UNION, r->error);
    for (int i = 0; i < CUTS; i++)
        region_release(&cuts[i]);
    mem_free(h.items);
    return status;
}

/* Of what is not a union: as a plate by openscad, which is cut through its middle; else put together from cuts. */
static lmn_status shadow_of_tree(csg_reader *r, int32_t node, int32_t shape, const mat4 *above, region *out)
{
    polyhedron  plate = {0};
    const char *why = NULL;
    lmn_status  status =
        csg_evaluate(r, "linear_extrude(height=2,center=true)projection(cut=false)", above, &shape, 1, &plate, &why);
    if (status == LMN_OK && !why && plate.triangle_count > 0)
        status = polyhedron_slice(out, &plate, r->error);
    else if (status == LMN_OK && why)
        status = shadow_by_cuts(r, node, shape, above, why, out);
    polyhedron_release(&plate);
    return status;
}

static lmn_status shadow(csg_reader *r, int32_t node, int32_t shape, const mat4 *above, region *out)
{
    const csg_shape *s = &r->shapes[shape];
    mat4             position = mat4_multiply(above, &s->matrix);
    if (s->kind == SOLID_UNION)
        return combine_children(r, node, shape, &position, shadow, out);
    if (s->kind != SOLID_OPERAND)
        return shadow_of_tree(r, node, shape, above, out);
    polyhedron p = {0};
    lmn_status status = polyhedron_transform(&p, &r->meshes[s->mesh].polyhedron, &position, r->error);
    if (status == LMN_OK)
        status = polyhedron_shadow(out, &p, r->error);
    polyhedron_release(&p);
    return status;
}

/* Meshes that close only within their rounding leave hairlines in a shadow: contours that are thin against all of
 * it go. */
static void drop_hairlines(region *r)
{
    double low[2], high[2];
    size_t kept = 0;
    if (!region_bounds(r, low, high))
        return;
    double thin = 2e-6 * fmax(high[0] - low[0], high[1] - low[1]);
    for (size_t i = 0; i < r->count; i++) {
        const contour *c = &r->contours[i];
        double         twice = 0, around = 0;
        for (size_t k = 0; k < c->count; k++) {
            point2 a = c->points[k], b = c->points[(k + 1) % c->count], o = c->points[0];
            twice += (a.x - o.x) * (b.y - o.y) - (b.x - o.x) * (a.y - o.y);
            around += hypot(b.x - a.x, b.y - a.y);
        }
        if (fabs(twice) > thin * around)
            r->contours[kept++] = *c;
        else
            mem_free(r->contours[i].points);
    }
    r->count = kept;
}

/* Its children are solids, whatever the dimension of what is around. */
lmn_status csg_projection(csg_reader *r, int32_t node, region *out)
{
    const mat4 identity = mat4_identity();
    size_t     shapes = r->shape_count;
    int32_t    shape;
    lmn_status status = csg_union(r, node, &shape);
    if (status == LMN_OK && shape >= 0)
        status = (csg_bool(&r->tree, node, "cut", 0, false) ? cut : shadow)(r, node, shape, &identity, out);
    if (status == LMN_OK)
        drop_hairlines(out);
    r->shape_count = shapes;
    return status;
}
