/* Polyhedra from polyhedra, questions about them, and their way into a scene. */
#include <math.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "construct/construct_private.h"
#include "scene/mesh.h"

void polyhedron_release(polyhedron *p)
{
    mem_free(p->points);
    mem_free(p->triangles);
    *p = (polyhedron){0};
}

bool polyhedron_bounds(const polyhedron *p, point3 *low, point3 *high)
{
    if (p->point_count == 0)
        return false;
    *low = *high = p->points[0];
    for (size_t i = 1; i < p->point_count; i++) {
        const point3 *q = &p->points[i];
        *low = (point3){fmin(low->x, q->x), fmin(low->y, q->y), fmin(low->z, q->z)};
        *high = (point3){fmax(high->x, q->x), fmax(high->y, q->y), fmax(high->z, q->z)};
    }
    return true;
}

/* Determinant of the upper left 3×3. */
static double mirrors(const double *m)
{
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
           m[8] * (m[1] * m[6] - m[2] * m[5]);
}

lmn_status polyhedron_transform(polyhedron *out, const polyhedron *p, const mat4 *m, lmn_error *error)
{
    *out = (polyhedron){0};
    const double *e = m->m;
    lmn_status    status = check_numbers("multmatrix", e, 16, error);
    if (status != LMN_OK || p->triangle_count == 0)
        return status;
    /* OpenSCAD divides by the last row. */
    double     w = e[15] != 0 ? e[15] : 1;
    polyhedron moved = *p;
    moved.points = mem_calloc(p->point_count, sizeof *moved.points);
    moved.triangles = mem_copy(p->triangles, p->triangle_count * 3 * sizeof *moved.triangles);
    if (!moved.points || !moved.triangles) {
        polyhedron_release(&moved);
        return error_memory(error);
    }
    for (size_t i = 0; i < p->point_count; i++) {
        point3 q = p->points[i];
        moved.points[i] = (point3){(e[0] * q.x + e[4] * q.y + e[8] * q.z + e[12]) / w + 0.0,
                                   (e[1] * q.x + e[5] * q.y + e[9] * q.z + e[13]) / w + 0.0,
                                   (e[2] * q.x + e[6] * q.y + e[10] * q.z + e[14]) / w + 0.0};
    }
    if (mirrors(e) < 0)
        polyhedron_turn_round(&moved);
    *out = moved;
    return LMN_OK;
}

/* Beyond this many comparisons of a point with a plane (a second) it is not worth knowing: nothing is wrong without
 * it. */
#define CONVEX_TESTS_MAX 5e8

/* Is every point on or behind the plane of this triangle? Slivers have no plane worth asking. */
static bool all_behind(const polyhedron *p, const uint32_t *t, double extent)
{
    const point3 *a = &p->points[t[0]], *b = &p->points[t[1]], *c = &p->points[t[2]];
    double        u[3] = {b->x - a->x, b->y - a->y, b->z - a->z}, v[3] = {c->x - a->x, c->y - a->y, c->z - a->z};
    double        n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    double        length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (length <= 1e-12 * extent * extent)
        return true;
    for (size_t i = 0; i < p->point_count; i++) {
        const point3 *q = &p->points[i];
        if (n[0] * (q->x - a->x) + n[1] * (q->y - a->y) + n[2] * (q->z - a->z) > 1e-9 * extent * length)
            return false;
    }
    return true;
}

bool polyhedron_check_convex(polyhedron *p)
{
    point3 low, high;
    p->convex = false;
    if (!polyhedron_bounds(p, &low, &high) || (double)p->triangle_count * (double)p->point_count > CONVEX_TESTS_MAX)
        return false;
    double extent = fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z));
    for (size_t i = 0; i < p->triangle_count; i++)
        if (!all_behind(p, &p->triangles[i * 3], extent))
            return false;
    p->convex = true;
    return true;
}

/* --- into a scene --------------------------------------------------------------------------------------- */

/* In single precision points may meet; triangles that become edges are left out, and what is closed stays so. */
static bool make_primitive(primitive *out, const polyhedron *p)
{
    *out = (primitive){
        .vertex_count = (uint32_t)p->point_count, .index_count = (uint32_t)p->triangle_count * 3, .material = NONE};
    out->positions = mem_calloc(p->point_count, sizeof *out->positions);
    out->indices = mem_copy(p->triangles, p->triangle_count * 3 * sizeof *out->indices);
    if (!out->positions || !out->indices)
        return false;
    for (size_t i = 0; i < p->point_count; i++)
        out->positions[i] = (vec3){(float)p->points[i].x, (float)p->points[i].y, (float)p->points[i].z};
    if (p->point_count > 0 && mesh_weld_positions(out, NULL) != LMN_OK)
        return false;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < out->index_count; i += 3) {
        uint32_t t[3] = {out->indices[i], out->indices[i + 1], out->indices[i + 2]};
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
            continue;
        memcpy(&out->indices[kept], t, sizeof t);
        kept += 3;
    }
    out->index_count = kept;
    return true;
}

bool polyhedron_into_mesh(mesh *out, const polyhedron *p)
{
    primitive made;
    *out = (mesh){.name = NULL};
    if (make_primitive(&made, p) && mesh_set_primitives(out, &made, 1))
        return true;
    primitive_release(&made);
    return false;
}

int32_t polyhedron_into_scene(lmn_scene *scene, const polyhedron *p)
{
    mesh  made;
    mesh *m = polyhedron_into_mesh(&made, p) ? scene_append_mesh(scene) : NULL;
    if (!m) {
        mesh_release(&made);
        return NONE;
    }
    *m = made;
    return (int32_t)scene->mesh_count - 1;
}
