/* Solids that one mesh stands for: the plain ones and what is extruded. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "import/csg.h"

facets csg_facets(const csg_reader *r, int32_t node)
{
    return (facets){csg_number(&r->tree, node, "$fn", NONE, 0), csg_number(&r->tree, node, "$fa", NONE, 12),
                    csg_number(&r->tree, node, "$fs", NONE, 2)};
}

lmn_status csg_cube(csg_reader *r, int32_t node, polyhedron *out)
{
    double size[3] = {1, 1, 1};
    csg_numbers(&r->tree, node, "size", 0, size, 3, true);
    return construct_cube(out, size, csg_bool(&r->tree, node, "center", 1, false), r->error);
}

lmn_status csg_sphere(csg_reader *r, int32_t node, polyhedron *out)
{
    double radius = csg_number(&r->tree, node, "r", 0, 1);
    return construct_sphere(out, csg_number(&r->tree, node, "d", NONE, 2 * radius) / 2, csg_facets(r, node), r->error);
}

lmn_status csg_cylinder(csg_reader *r, int32_t node, polyhedron *out)
{
    const csg_tree *t = &r->tree;
    double          both = csg_number(t, node, "d", NONE, 2 * csg_number(t, node, "r", NONE, 1)) / 2;
    double          r1 = csg_number(t, node, "d1", NONE, 2 * csg_number(t, node, "r1", 1, both)) / 2;
    double          r2 = csg_number(t, node, "d2", NONE, 2 * csg_number(t, node, "r2", 2, both)) / 2;
    return construct_cylinder(out, csg_number(t, node, "h", 0, 1), r1, r2, csg_bool(t, node, "center", 3, false),
                              csg_facets(r, node), r->error);
}

/* --- polyhedron ----------------------------------------------------------------------------------------- */

void csg_paths_release(csg_paths *p)
{
    mem_free(p->corners);
    mem_free(p->sizes);
    *p = (csg_paths){0};
}

lmn_status csg_read_paths(csg_reader *r, int32_t value, size_t point_count, csg_paths *out)
{
    const csg_tree  *t = &r->tree;
    const csg_value *list = &t->values[value];
    *out = (csg_paths){0};
    if (list->kind != CSG_VECTOR)
        return error_set(r->error, LMN_FORMAT, "a list of indices is expected");
    out->corners = mem_alloc((size_t)(list->after - value) * sizeof *out->corners);
    out->sizes = mem_alloc((size_t)list->count * sizeof *out->sizes);
    if (!out->corners || !out->sizes)
        return error_memory(r->error);
    for (int32_t path = value + 1; path < list->after; path = t->values[path].after) {
        if (t->values[path].kind != CSG_VECTOR)
            return error_set(r->error, LMN_FORMAT, "a list of lists of indices is expected");
        for (int32_t i = path + 1; i < t->values[path].after; i = t->values[i].after) {
            double index = t->values[i].kind == CSG_NUMBER ? t->values[i].as.number : -1;
            if (!(index >= 0 && index < (double)point_count))
                return error_set(r->error, LMN_FORMAT, "an index is %g, there are %zu points", index, point_count);
            out->corners[out->corner_count++] = (uint32_t)index;
        }
        out->sizes[out->count++] = t->values[path].count;
    }
    return LMN_OK;
}

static lmn_status read_points(csg_reader *r, int32_t value, point3 **out, size_t *count)
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
        double at[3] = {0, 0, 0};
        if (t->values[p].kind == CSG_VECTOR)
            csg_vector_numbers(t, p, at, 3);
        (*out)[(*count)++] = (point3){at[0], at[1], at[2]};
    }
    return LMN_OK;
}

lmn_status csg_polyhedron(csg_reader *r, int32_t node, polyhedron *out)
{
    point3   *points;
    size_t    count;
    csg_paths faces = {0};
    bool      flawed = false;
    int32_t   list = csg_argument_value(&r->tree, node, "faces", 1);
    if (list == NONE)
        list = csg_argument_value(&r->tree, node, "triangles", NONE);
    lmn_status status = read_points(r, csg_argument_value(&r->tree, node, "points", 0), &points, &count);
    if (status == LMN_OK)
        status =
            list == NONE ? error_set(r->error, LMN_FORMAT, "it has no faces") : csg_read_paths(r, list, count, &faces);
    if (status == LMN_OK)
        status = construct_polyhedron(out, points, count, faces.corners, faces.sizes, faces.count, &flawed, r->error);
    if (status == LMN_OK && flawed)
        csg_warn(r, node, WARNING_BAD_GEOMETRY, "polyhedron() is not closed or not consistently wound");
    mem_free(points);
    csg_paths_release(&faces);
    return status;
}

/* --- extrusions ----------------------------------------------------------------------------------------- */

/* Old files name a drawing instead of having children. */
static lmn_status profile(csg_reader *r, int32_t node, region *out)
{
    bool from_file = *csg_string(&r->tree, node, "file", NONE, "") != '\0';
    return from_file ? csg_import_region(r, node, out) : csg_children_region(r, node, out);
}

lmn_status csg_linear_extrude(csg_reader *r, int32_t node, polyhedron *out)
{
    const csg_tree  *t = &r->tree;
    linear_extrusion how = {.height = csg_number(t, node, "height", 0, 100),
                            .twist = csg_number(t, node, "twist", NONE, 0),
                            .scale = {1, 1},
                            .centre = csg_bool(t, node, "center", NONE, false),
                            .facets = csg_facets(r, node)};
    csg_numbers(t, node, "scale", NONE, how.scale, 2, true);
    double slices = csg_number(t, node, "slices", NONE, 0);
    how.has_slices = slices >= 1;
    how.slices = !how.has_slices ? 0 : slices < 1e6 ? (int)slices : 1000000;
    region     r2 = {0};
    lmn_status status = profile(r, node, &r2);
    if (status == LMN_OK && r2.count > 0)
        status = construct_linear_extrude(out, &r2, &how, r->error);
    region_release(&r2);
    return status;
}

static lmn_status turn(csg_reader *r, polyhedron *p, double degrees)
{
    double angle = degrees * 0.017453292519943295;
    double c = fabs(fmod(degrees, 180)) == 90 ? 0 : cos(angle), s = fmod(degrees, 180) == 0 ? 0 : sin(angle);
    mat4   m = mat4_identity();
    m.m[0] = m.m[5] = c;
    m.m[1] = s;
    m.m[4] = -s;
    polyhedron turned = {0};
    lmn_status status = polyhedron_transform(&turned, p, &m, r->error);
    if (status == LMN_OK) {
        polyhedron_release(p);
        *p = turned;
    }
    return status;
}

/* `start` came with OpenSCAD 2024; before, full turns began at 180° and others at 0°, as construct_rotate_extrude
 * does. */
lmn_status csg_rotate_extrude(csg_reader *r, int32_t node, polyhedron *out)
{
    double     angle = csg_number(&r->tree, node, "angle", NONE, 360);
    bool       full = angle <= -360 || angle >= 360;
    double     usual = full ? 180 : 0, start = csg_number(&r->tree, node, "start", NONE, usual);
    region     r2 = {0};
    lmn_status status = profile(r, node, &r2);
    if (status == LMN_OK && r2.count > 0 && angle != 0)
        status = construct_rotate_extrude(out, &r2, full ? 360 : angle, csg_facets(r, node), r->error);
    region_release(&r2);
    if (status == LMN_OK && start != usual && out->point_count > 0)
        status = turn(r, out, start - usual);
    return status;
}

lmn_status csg_plate_mesh(csg_reader *r, int32_t node, polyhedron *out)
{
    const linear_extrusion how = {.height = 1, .scale = {1, 1}, .centre = true};
    region                 r2 = {0};
    lmn_status             status = csg_region_of(r, node, &r2, &r->absent);
    if (status == LMN_OK && r2.count > 0)
        status = construct_linear_extrude(out, &r2, &how, r->error);
    region_release(&r2);
    return status;
}
