/* Cubes, spheres, cylinders, polyhedra from faces, fields of heights. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "construct/construct_private.h"

lmn_status construct_cube(polyhedron *out, const double size[3], bool centre, lmn_error *error)
{
    *out = (polyhedron){0};
    lmn_status status = check_numbers("cube", size, 3, error);
    if (status != LMN_OK || !(size[0] > 0 && size[1] > 0 && size[2] > 0))
        return status;
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = centre ? -size[k] / 2 : 0;
        high[k] = centre ? size[k] / 2 : size[k];
    }
    solid_builder b = {0};
    for (int i = 0; i < 8; i++)
        builder_point(&b, i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]);
    static const uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
    for (int i = 0; i < 6; i++)
        builder_quad(&b, faces[i][0], faces[i][1], faces[i][2], faces[i][3]);
    status = builder_finish(&b, out, error);
    out->convex = true;
    return status;
}

/* Points of a circle around the z axis, from the x axis on. */
static void add_ring(solid_builder *b, double radius, double z, int count)
{
    for (int i = 0; i < count; i++) {
        double angle = 360.0 * i / count;
        builder_point(b, radius * cosine_of_degrees(angle), radius * sine_of_degrees(angle), z);
    }
}

/* The band between a ring of points and the next one above it. */
static void add_band(solid_builder *b, uint32_t below, uint32_t above, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t next = (i + 1) % count;
        builder_quad(b, below + i, below + next, above + next, above + i);
    }
}

/* A disc from a ring of points; seen from above, or from below. */
static void add_disc(solid_builder *b, uint32_t first, uint32_t count, bool up)
{
    for (uint32_t i = 1; i + 1 < count; i++)
        builder_triangle(b, first, first + (up ? i : i + 1), first + (up ? i + 1 : i));
}

/* Rings stand half a step off the poles, so that there is a small disc at each. */
lmn_status construct_sphere(polyhedron *out, double radius, facets f, lmn_error *error)
{
    *out = (polyhedron){0};
    int        facets = facets_of_circle(radius, f), rings = (facets + 1) / 2;
    lmn_status status = check_numbers("sphere", &radius, 1, error);
    if (status == LMN_OK)
        status = check_point_count("sphere", (double)facets * rings, error);
    if (status != LMN_OK || !(radius > 0))
        return status;
    solid_builder b = {0};
    for (int i = rings - 1; i >= 0; i--) {
        double polar = 180 * (i + 0.5) / rings;
        add_ring(&b, radius * sine_of_degrees(polar), radius * cosine_of_degrees(polar), facets);
    }
    add_disc(&b, 0, (uint32_t)facets, false);
    for (int i = 0; i + 1 < rings; i++)
        add_band(&b, (uint32_t)(i * facets), (uint32_t)((i + 1) * facets), (uint32_t)facets);
    add_disc(&b, (uint32_t)((rings - 1) * facets), (uint32_t)facets, true);
    status = builder_finish(&b, out, error);
    out->convex = true;
    return status;
}

lmn_status construct_cylinder(polyhedron *out, double height, double r1, double r2, bool centre, facets f,
                              lmn_error *error)
{
    *out = (polyhedron){0};
    int        facets = facets_of_circle(fmax(r1, r2), f);
    lmn_status status = check_numbers("cylinder", (double[]){height, r1, r2}, 3, error);
    if (status == LMN_OK)
        status = check_point_count("cylinder", 2.0 * facets, error);
    if (status != LMN_OK || !(height > 0 && r1 >= 0 && r2 >= 0 && fmax(r1, r2) > 0))
        return status;
    double        z1 = centre ? -height / 2 : 0, z2 = centre ? height / 2 : height;
    uint32_t      count = (uint32_t)facets;
    solid_builder b = {0};
    /* The ring of an apex is one position, and welding leaves one triangle of each quad. */
    add_ring(&b, r1, z1, facets);
    add_ring(&b, r2, z2, facets);
    if (r1 > 0)
        add_disc(&b, 0, count, false);
    add_band(&b, 0, count, count);
    if (r2 > 0)
        add_disc(&b, count, count, true);
    status = builder_finish(&b, out, error);
    out->convex = true;
    return status;
}

/* --- polyhedra from faces ------------------------------------------------------------------------------- */

/* Twice the area times the normal (Newell), of corners from last to first: faces come clockwise. */
static void face_normal(const point3 *points, const uint32_t *corners, uint32_t size, double normal[3])
{
    normal[0] = normal[1] = normal[2] = 0;
    for (uint32_t i = 0; i < size; i++) {
        const point3 *a = &points[corners[(i + 1) % size]], *b = &points[corners[i]], *o = &points[corners[0]];
        normal[0] += (a->y - b->y) * (a->z + b->z - 2 * o->z);
        normal[1] += (a->z - b->z) * (a->x + b->x - 2 * o->x);
        normal[2] += (a->x - b->x) * (a->y + b->y - 2 * o->y);
    }
}

/* The face's corners without neighbours at the same position, last to first. Returns how many. */
static uint32_t face_corners(const point3 *points, const uint32_t *corners, uint32_t size, uint32_t *out)
{
    uint32_t kept = 0;
    for (uint32_t i = size; i-- > 0;) {
        const point3 *p = &points[corners[i]], *last = kept ? &points[out[kept - 1]] : NULL;
        if (!last || p->x != last->x || p->y != last->y || p->z != last->z)
            out[kept++] = corners[i];
    }
    const point3 *first = &points[out[0]], *last = &points[out[kept - 1]];
    while (kept > 1 && first->x == last->x && first->y == last->y && first->z == last->z)
        last = &points[out[--kept - 1]];
    return kept;
}

/* Fills a face, looking along the largest part of its normal. What crosses itself there becomes a fan: its edges
 * stay. */
static lmn_status fill_face(solid_builder *b, const point3 *points, const uint32_t *face, uint32_t size,
                            const double normal[3], lmn_error *error)
{
    int axis = fabs(normal[0]) > fabs(normal[1]) ? 0 : 1;
    axis = fabs(normal[2]) >= fabs(normal[axis]) ? 2 : axis;
    bool    mirrored = normal[axis] < 0;
    contour outline = {mem_calloc(size, sizeof(point2)), size};
    if (!outline.points)
        return error_memory(error);
    for (uint32_t i = 0; i < size; i++) {
        const double p[3] = {points[face[i]].x, points[face[i]].y, points[face[i]].z};
        double       x = p[(axis + 1) % 3], y = p[(axis + 2) % 3];
        outline.points[i] = (point2){mirrored ? -x : x, y};
    }
    uint32_t  *corners = NULL;
    size_t     count = 0;
    bool       exact = false;
    lmn_status status = contours_triangulate(&outline, 1, &corners, &count, &exact, error);
    for (size_t i = 0; status == LMN_OK && exact && i < count; i += 3)
        builder_triangle(b, face[corners[i]], face[corners[i + 1]], face[corners[i + 2]]);
    for (uint32_t i = 1; status == LMN_OK && !exact && i + 1 < size; i++)
        builder_triangle(b, face[0], face[i], face[i + 1]);
    mem_free(corners);
    mem_free(outline.points);
    return status;
}

static lmn_status add_face(solid_builder *b, const point3 *points, const uint32_t *corners, uint32_t size,
                           lmn_error *error)
{
    if (size < 3)
        return LMN_OK;
    uint32_t *face = mem_calloc(size, sizeof *face);
    if (!face)
        return error_memory(error);
    lmn_status status = LMN_OK;
    size = face_corners(points, corners, size, face);
    if (size == 3) {
        builder_triangle(b, face[0], face[1], face[2]);
    } else if (size > 3) {
        double normal[3];
        face_normal(points, face, size, normal);
        for (int k = 0; k < 3; k++)
            normal[k] = -normal[k]; /* the corners have been turned round */
        status = fill_face(b, points, face, size, normal, error);
    }
    mem_free(face);
    return status;
}

static lmn_status check_polyhedron(const point3 *points, size_t point_count, const uint32_t *corners,
                                   const uint32_t *face_sizes, size_t face_count, lmn_error *error)
{
    size_t total = 0;
    for (size_t i = 0; i < face_count; i++)
        total += face_sizes[i];
    lmn_status status = check_point_count("polyhedron", (double)point_count + (double)total, error);
    for (size_t i = 0; status == LMN_OK && i < point_count; i++)
        status = check_numbers("polyhedron", &points[i].x, 3, error);
    for (size_t i = 0; status == LMN_OK && i < total; i++)
        if (corners[i] >= point_count)
            return error_set(error, LMN_FORMAT, "polyhedron: a face has point %u, but there are only %zu", corners[i],
                             point_count);
    return status;
}

lmn_status construct_polyhedron(polyhedron *out, const point3 *points, size_t point_count, const uint32_t *corners,
                                const uint32_t *face_sizes, size_t face_count, bool *flawed, lmn_error *error)
{
    *out = (polyhedron){0};
    *flawed = false;
    lmn_status status = check_polyhedron(points, point_count, corners, face_sizes, face_count, error);
    if (status != LMN_OK)
        return status;
    solid_builder b = {0};
    for (size_t i = 0; i < point_count; i++)
        builder_point(&b, points[i].x, points[i].y, points[i].z);
    for (size_t i = 0; status == LMN_OK && i < face_count; corners += face_sizes[i++])
        status = add_face(&b, points, corners, face_sizes[i], error);
    if (status != LMN_OK) {
        builder_release(&b);
        return status;
    }
    status = builder_finish(&b, out, error);
    if (status != LMN_OK)
        return status;
    bool failed;
    *flawed = !polyhedron_is_closed(out, &failed);
    if (failed) {
        polyhedron_release(out);
        return error_memory(error);
    }
    polyhedron_check_convex(out);
    return LMN_OK;
}
