/* Figures in the plane of .csg files, computed as regions. */
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "import/csg.h"

/* Figures below a node, one region a child that counts. */
typedef struct region_list {
    region *items;
    size_t  count, capacity;
} region_list;

static void release_list(region_list *l)
{
    for (size_t i = 0; i < l->count; i++)
        region_release(&l->items[i]);
    mem_free(l->items);
    *l = (region_list){0};
}

/* As in space: what has another dimension counts as nothing, what cannot be read does not count. */
static lmn_status gather(csg_reader *r, int32_t node, region_list *out)
{
    *out = (region_list){0};
    for (int32_t c = csg_child(r, node, NONE); c != NONE; c = csg_child(r, node, c)) {
        bool absent = false;
        if (!mem_grow((void **)&out->items, &out->capacity, out->count + 1, sizeof *out->items))
            return error_memory(r->error);
        region *made = &out->items[out->count];
        *made = (region){0};
        lmn_status status = LMN_OK;
        if (r->tree.nodes[c].dimension == 3)
            csg_warn(r, c, WARNING_IGNORED, "%s() is 3D among 2D objects of %s() and left out", csg_word(&r->tree, c),
                     csg_word(&r->tree, node));
        else
            status = csg_region_of(r, c, made, &absent);
        if (status != LMN_OK)
            return status;
        if (absent)
            region_release(made);
        else
            out->count++;
    }
    return LMN_OK;
}

static lmn_status combine(csg_reader *r, int32_t node, region_operation operation, region *out)
{
    region_list list;
    lmn_status  status = gather(r, node, &list);
    if (status == LMN_OK && list.count == 1) {
        *out = list.items[0];
        list.count = 0;
    } else if (status == LMN_OK && list.count > 1) {
        status = region_combine(out, list.items, list.count, operation, r->error);
    }
    release_list(&list);
    return status;
}

lmn_status csg_children_region(csg_reader *r, int32_t node, region *out)
{
    return combine(r, node, REGION_UNION, out);
}

lmn_status csg_region_union(csg_reader *r, int32_t node, region *out)
{
    return combine(r, node, REGION_UNION, out);
}

lmn_status csg_region_difference(csg_reader *r, int32_t node, region *out)
{
    return combine(r, node, REGION_DIFFERENCE, out);
}

lmn_status csg_region_intersection(csg_reader *r, int32_t node, region *out)
{
    return combine(r, node, REGION_INTERSECTION, out);
}

lmn_status csg_region_of(csg_reader *r, int32_t node, region *out, bool *absent)
{
    const csg_meaning *m = csg_meaning_of(r, node);
    *out = (region){0};
    *absent = !m;
    if (!m || r->tree.nodes[node].dimension != 2)
        return LMN_OK;
    bool above = r->absent;
    r->absent = false;
    lmn_status status = csg_all_finite(&r->tree, node) ? m->region(r, node, out)
                                                       : error_set(r->error, LMN_FORMAT, "a number is not finite");
    *absent = r->absent;
    r->absent = above;
    if (status != LMN_OK)
        region_release(out);
    return csg_tolerate(r, node, status);
}

/* --- plain figures -------------------------------------------------------------------------------------- */

lmn_status csg_square(csg_reader *r, int32_t node, region *out)
{
    double size[2] = {1, 1};
    csg_numbers(&r->tree, node, "size", 0, size, 2, true);
    return construct_square(out, size, csg_bool(&r->tree, node, "center", 1, false), r->error);
}

lmn_status csg_circle(csg_reader *r, int32_t node, region *out)
{
    double radius = csg_number(&r->tree, node, "r", 0, 1);
    return construct_circle(out, csg_number(&r->tree, node, "d", NONE, 2 * radius) / 2, csg_facets(r, node), r->error);
}

static lmn_status read_points(csg_reader *r, int32_t value, point2 **out, size_t *count)
{
    const csg_tree *t = &r->tree;
    *out = NULL;
    *count = 0;
    if (value == NONE || t->values[value].kind != CSG_VECTOR)
        return error_set(r->error, LMN_FORMAT, "it has no points");
    *out = mem_alloc((size_t)t->values[value].count * sizeof **out);
    if (!*out)
        return error_memory(r->error);
    for (int32_t p = value + 1; p < t->values[value].after; p = t->values[p].after) {
        double at[2] = {0, 0};
        if (t->values[p].kind == CSG_VECTOR)
            csg_vector_numbers(t, p, at, 2);
        (*out)[(*count)++] = (point2){at[0], at[1]};
    }
    return LMN_OK;
}

/* Without paths, all points in their order. */
static lmn_status one_path(csg_reader *r, size_t count, csg_paths *out)
{
    out->corners = mem_alloc(count * sizeof *out->corners);
    out->sizes = mem_alloc(sizeof *out->sizes);
    if (!out->corners || !out->sizes)
        return error_memory(r->error);
    for (size_t i = 0; i < count; i++)
        out->corners[i] = (uint32_t)i;
    out->sizes[0] = (uint32_t)count;
    out->count = 1;
    return LMN_OK;
}

/* One path may stand without a list around it. */
static lmn_status one_bare_path(csg_reader *r, int32_t value, size_t point_count, csg_paths *out)
{
    const csg_tree *t = &r->tree;
    lmn_status      status = one_path(r, t->values[value].count, out);
    for (uint32_t i = 0; i < t->values[value].count && status == LMN_OK; i++) {
        const csg_value *v = &t->values[value + 1 + (int32_t)i];
        if (v->kind != CSG_NUMBER || !(v->as.number >= 0 && v->as.number < (double)point_count))
            return error_set(r->error, LMN_FORMAT, "an index of its path is out of range, there are %zu points",
                             point_count);
        out->corners[i] = (uint32_t)v->as.number;
    }
    return status;
}

lmn_status csg_polygon(csg_reader *r, int32_t node, region *out)
{
    const csg_tree *t = &r->tree;
    point2         *points;
    size_t          count;
    csg_paths       paths = {0};
    int32_t         list = csg_argument_value(t, node, "paths", 1);
    lmn_status      status = read_points(r, csg_argument_value(t, node, "points", 0), &points, &count);
    bool            bare = list != NONE && t->values[list].kind == CSG_VECTOR && t->values[list].count > 0 &&
                t->values[list + 1].kind == CSG_NUMBER;
    if (status == LMN_OK)
        status = list == NONE ? one_path(r, count, &paths)
                 : bare       ? one_bare_path(r, list, count, &paths)
                              : csg_read_paths(r, list, count, &paths);
    if (status == LMN_OK)
        status = construct_polygon(out, points, count, paths.corners, paths.sizes, paths.count, r->error);
    mem_free(points);
    csg_paths_release(&paths);
    return status;
}

/* "default" is how newer versions write that nothing was said. */
static const char *word_or_null(const csg_reader *r, int32_t node, const char *name)
{
    const char *word = csg_string(&r->tree, node, name, NONE, NULL);
    return word && strcmp(word, "default") != 0 && *word ? word : NULL;
}

lmn_status csg_text(csg_reader *r, int32_t node, region *out)
{
    const csg_tree *t = &r->tree;
    bool            missing = false;
    text_style      style = {.font = csg_string(t, node, "font", 2, NULL),
                             .size = csg_number(t, node, "size", 1, 10),
                             .spacing = csg_number(t, node, "spacing", NONE, 1),
                             .direction = word_or_null(r, node, "direction"),
                             .language = word_or_null(r, node, "language"),
                             .script = word_or_null(r, node, "script"),
                             .halign = word_or_null(r, node, "halign"),
                             .valign = word_or_null(r, node, "valign")};
    lmn_status      status =
        construct_text(out, csg_string(t, node, "text", 0, ""), &style, csg_facets(r, node), &missing, r->error);
    if (status == LMN_OK && missing)
        csg_warn(r, node, WARNING_MISSING_FILE, "text(): another font stands in for \"%.80s\"",
                 style.font ? style.font : "");
    return status;
}

/* --- changed figures ------------------------------------------------------------------------------------ */

lmn_status csg_offset(csg_reader *r, int32_t node, region *out)
{
    const csg_tree *t = &r->tree;
    bool   delta = csg_argument_value(t, node, "delta", NONE) != NONE && csg_argument_value(t, node, "r", NONE) == NONE;
    double distance = delta ? csg_number(t, node, "delta", NONE, 1) : csg_number(t, node, "r", 0, 1);
    region below = {0};
    lmn_status status = csg_children_region(r, node, &below);
    if (status == LMN_OK && below.count > 0)
        status = region_offset(out, &below, distance, !delta, csg_bool(t, node, "chamfer", NONE, false),
                               csg_facets(r, node), r->error);
    region_release(&below);
    return status;
}

static lmn_status placed(csg_reader *r, int32_t node, const double m[6], region *out)
{
    region     below = {0};
    lmn_status status = csg_children_region(r, node, &below);
    if (status == LMN_OK && below.count > 0)
        status = region_transform(out, &below, m, r->error);
    region_release(&below);
    return status;
}

lmn_status csg_region_multmatrix(csg_reader *r, int32_t node, region *out)
{
    mat4 m;
    if (!csg_read_matrix(r, node, 2, &m))
        return LMN_OK;
    return placed(r, node, (const double[6]){m.m[0], m.m[1], m.m[4], m.m[5], m.m[12], m.m[13]}, out);
}

lmn_status csg_region_resize(csg_reader *r, int32_t node, region *out)
{
    region     below = {0};
    double     low[2], high[2], factors[3];
    lmn_status status = csg_children_region(r, node, &below);
    if (status == LMN_OK && region_bounds(&below, low, high)) {
        csg_resize_factors(r, node, (const double[2]){high[0] - low[0], high[1] - low[1]}, 2, factors);
        status = region_transform(out, &below, (const double[6]){factors[0], 0, 0, factors[1], 0, 0}, r->error);
    }
    region_release(&below);
    return status;
}

lmn_status csg_region_hull(csg_reader *r, int32_t node, region *out)
{
    region_list list;
    lmn_status  status = gather(r, node, &list);
    if (status == LMN_OK && list.count > 0)
        status = region_hull(out, list.items, list.count, r->error);
    release_list(&list);
    return status;
}

/* Empty figures do not count. */
lmn_status csg_region_minkowski(csg_reader *r, int32_t node, region *out)
{
    region_list list;
    lmn_status  status = gather(r, node, &list);
    for (size_t i = 0; i < list.count && status == LMN_OK; i++) {
        region sum = {0};
        if (list.items[i].count == 0)
            continue;
        if (out->count > 0) {
            status = region_minkowski(&sum, out, &list.items[i], r->error);
        } else {
            sum = list.items[i];
            list.items[i] = (region){0};
        }
        region_release(out);
        *out = sum;
    }
    release_list(&list);
    return status;
}
