#include "shape.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

static const double pi = 3.14159265358979323846;

void shape_release(shape *s)
{
    for (size_t i = 0; i < s->count; i++) {
        free(s->parts[i].positions);
        free(s->parts[i].normals);
        free(s->parts[i].uvs);
        free(s->parts[i].indices);
        free(s->parts[i].texture);
        free(s->parts[i].normal_map);
    }
    free(s->parts);
    *s = (shape){0};
}

shape_part *shape_add(shape *s, const char *name, uint32_t vertices, uint32_t indices, bool normals, bool uvs)
{
    shape_part *grown = check_alloc(s->count + 1, sizeof *grown);
    if (s->count)
        memcpy(grown, s->parts, s->count * sizeof *grown);
    free(s->parts);
    s->parts = grown;
    shape_part *p = &s->parts[s->count++];
    snprintf(p->name, sizeof p->name, "%s", name);
    p->vertex_count = vertices;
    p->index_count = indices;
    p->positions = check_alloc(vertices, sizeof *p->positions);
    p->normals = normals ? check_alloc(vertices, sizeof *p->normals) : NULL;
    p->uvs = uvs ? check_alloc(vertices, sizeof *p->uvs) : NULL;
    p->indices = check_alloc(indices, sizeof *p->indices);
    for (int k = 0; k < 4; k++)
        p->colour[k] = 1;
    for (int k = 0; k < 16; k++)
        p->matrix[k] = k % 5 == 0;
    return p;
}

void shape_place(shape *s, dvec axis, double degrees, dvec translation)
{
    shape_part *p = &s->parts[s->count - 1];
    dvec        a = dvec_unit(axis);
    double      c = cos(degrees * pi / 180), n = sin(degrees * pi / 180), t = 1 - c;
    double      m[16] = {t * a.x * a.x + c,       t * a.x * a.y + n * a.z, t * a.x * a.z - n * a.y, 0,
                         t * a.x * a.y - n * a.z, t * a.y * a.y + c,       t * a.y * a.z + n * a.x, 0,
                         t * a.x * a.z + n * a.y, t * a.y * a.z - n * a.x, t * a.z * a.z + c,       0,
                         translation.x,           translation.y,           translation.z,           1};
    memcpy(p->matrix, m, sizeof m);
    p->has_matrix = true;
}

dvec shape_point(const shape_part *p, uint32_t vertex)
{
    dvec v = dvec_from(p->positions[vertex]);
    return p->has_matrix ? dmat_apply(p->matrix, v, 1, NULL) : v;
}

/* Placements are rotations, so that normals turn like vectors. */
dvec shape_normal(const shape_part *p, uint32_t vertex)
{
    dvec v = dvec_from(p->normals[vertex]);
    return p->has_matrix ? dmat_apply(p->matrix, v, 0, NULL) : v;
}

static void set3(float out[3], double x, double y, double z)
{
    out[0] = (float)x;
    out[1] = (float)y;
    out[2] = (float)z;
}

static uint32_t put_triangle(shape_part *p, uint32_t at, uint32_t a, uint32_t b, uint32_t c)
{
    p->indices[at] = a;
    p->indices[at + 1] = b;
    p->indices[at + 2] = c;
    return at + 3;
}

static uint32_t put_quad(shape_part *p, uint32_t at, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    return put_triangle(p, put_triangle(p, at, a, b, c), a, c, d);
}

void shape_box(shape *s, const char *name, dvec low, dvec high)
{
    static const uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    shape_part           *p = shape_add(s, name, 8, 36, false, false);
    for (uint32_t i = 0; i < 8; i++)
        set3(p->positions[i], i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    for (uint32_t i = 0, at = 0; i < 6; i++)
        at = put_quad(p, at, faces[i][0], faces[i][1], faces[i][2], faces[i][3]);
}

/* Vertices of a staircase are looked up by position, so that neighbouring columns share them and no edge ends inside
 * another. */
static uint32_t vertex_at(shape_part *p, double x, double y, double z)
{
    float v[3];
    set3(v, x, y, z);
    for (uint32_t i = 0; i < p->vertex_count; i++)
        if (memcmp(p->positions[i], v, sizeof v) == 0)
            return i;
    memcpy(p->positions[p->vertex_count], v, sizeof v);
    return p->vertex_count++;
}

/* One end cap of a column as a fan around its middle; `ring` runs anticlockwise seen from +z. */
static uint32_t put_cap(shape_part *p, uint32_t at, double (*ring)[2], int count, double z, bool front)
{
    double   x = (ring[0][0] + ring[1][0]) / 2, y = ring[count - 1][1] / 2;
    uint32_t middle = vertex_at(p, x, y, z);
    for (int i = 0; i < count; i++) {
        const double *a = ring[i], *b = ring[(i + 1) % count];
        uint32_t      va = vertex_at(p, a[0], a[1], z), vb = vertex_at(p, b[0], b[1], z);
        at = front ? put_triangle(p, at, middle, va, vb) : put_triangle(p, at, middle, vb, va);
    }
    return at;
}

static uint32_t put_wall(shape_part *p, uint32_t at, double x0, double y0, double x1, double y1, double depth)
{
    uint32_t a = vertex_at(p, x0, y0, depth), b = vertex_at(p, x1, y1, depth);
    return put_quad(p, at, a, vertex_at(p, x0, y0, 0), vertex_at(p, x1, y1, 0), b);
}

void shape_steps(shape *s, const char *name, const double *edges, const double *heights, int columns, double depth)
{
    uint32_t    capacity = (uint32_t)columns * 80;
    shape_part *p = shape_add(s, name, capacity, capacity, false, false);
    p->vertex_count = 0;
    uint32_t at = 0;
    for (int i = 0; i < columns; i++) {
        double before = i > 0 ? heights[i - 1] : 0, behind = i + 1 < columns ? heights[i + 1] : 0;
        double ring[6][2];
        int    n = 0;
        memcpy(ring[n++], (double[]){edges[i], 0}, sizeof *ring);
        memcpy(ring[n++], (double[]){edges[i + 1], 0}, sizeof *ring);
        if (behind > 0 && behind < heights[i])
            memcpy(ring[n++], (double[]){edges[i + 1], behind}, sizeof *ring);
        memcpy(ring[n++], (double[]){edges[i + 1], heights[i]}, sizeof *ring);
        memcpy(ring[n++], (double[]){edges[i], heights[i]}, sizeof *ring);
        if (before > 0 && before < heights[i])
            memcpy(ring[n++], (double[]){edges[i], before}, sizeof *ring);
        at = put_cap(p, at, ring, n, depth, true);
        at = put_cap(p, at, ring, n, 0, false);
        at = put_wall(p, at, edges[i + 1], heights[i], edges[i], heights[i], depth);
        at = put_wall(p, at, edges[i], 0, edges[i + 1], 0, depth);
        if (before < heights[i])
            at = put_wall(p, at, edges[i], heights[i], edges[i], before, depth);
        if (behind < heights[i])
            at = put_wall(p, at, edges[i + 1], behind, edges[i + 1], heights[i], depth);
    }
    p->index_count = at;
}

void shape_sphere(shape *s, const char *name, dvec centre, double radius, int stacks, int slices, bool normals)
{
    uint32_t    rings = (uint32_t)stacks - 1, n = (uint32_t)slices, south = rings * n + 1;
    shape_part *p = shape_add(s, name, south + 1, 6 * n * rings, normals, false);
    for (uint32_t i = 0; i <= south; i++) {
        double latitude = i == 0 ? 0 : i == south ? pi : pi * ((i - 1) / n + 1) / stacks;
        double longitude = i == 0 || i == south ? 0 : 2 * pi * ((i - 1) % n) / slices;
        dvec   d = {sin(latitude) * cos(longitude), cos(latitude), -sin(latitude) * sin(longitude)};
        if (i == south)
            d = dvec_of(0, -1, 0);
        set3(p->positions[i], centre.x + radius * d.x, centre.y + radius * d.y, centre.z + radius * d.z);
        if (normals)
            set3(p->normals[i], d.x, d.y, d.z);
    }
    uint32_t at = 0;
    for (uint32_t j = 0; j < n; j++) {
        uint32_t k = (j + 1) % n;
        at = put_triangle(p, at, 0, 1 + j, 1 + k);
        for (uint32_t i = 0; i + 1 < rings; i++)
            at = put_quad(p, at, 1 + i * n + j, 1 + (i + 1) * n + j, 1 + (i + 1) * n + k, 1 + i * n + k);
        at = put_triangle(p, at, south, 1 + (rings - 1) * n + k, 1 + (rings - 1) * n + j);
    }
}

void shape_torus(shape *s, const char *name, double major, double minor, int around, int across)
{
    uint32_t    u = (uint32_t)around, v = (uint32_t)across;
    shape_part *p = shape_add(s, name, u * v, 6 * u * v, true, false);
    for (uint32_t i = 0, at = 0; i < u; i++)
        for (uint32_t j = 0; j < v; j++) {
            double a = 2 * pi * i / around, b = 2 * pi * j / across;
            dvec   n = {cos(a) * cos(b), sin(b), -sin(a) * cos(b)};
            set3(p->positions[i * v + j], cos(a) * major + minor * n.x, minor * n.y, -sin(a) * major + minor * n.z);
            set3(p->normals[i * v + j], n.x, n.y, n.z);
            uint32_t i1 = (i + 1) % u, j1 = (j + 1) % v;
            at = put_quad(p, at, i * v + j, i1 * v + j, i1 * v + j1, i * v + j1);
        }
}

/* Smooth value noise from an integer hash, so that the hills are the same on every machine. */
static double lattice(int32_t x, int32_t z, uint32_t seed)
{
    uint32_t h = (uint32_t)x * 0x9E3779B1u ^ (uint32_t)z * 0x85EBCA77u ^ seed * 0xC2B2AE3Du;
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    return (h ^ (h >> 15)) / 4294967295.0;
}

static double hill(double x, double z, uint32_t seed)
{
    double x0 = floor(x), z0 = floor(z), u = x - x0, v = z - z0;
    u = u * u * u * (u * (6 * u - 15) + 10);
    v = v * v * v * (v * (6 * v - 15) + 10);
    int32_t i = (int32_t)x0, j = (int32_t)z0;
    double  a = lattice(i, j, seed), b = lattice(i + 1, j, seed), c = lattice(i, j + 1, seed),
           d = lattice(i + 1, j + 1, seed);
    return (a * (1 - u) + b * u) * (1 - v) + (c * (1 - u) + d * u) * v;
}

static double terrain_height(double x, double z, double height, uint32_t seed)
{
    return height * (hill(x * 1.5, z * 1.5, seed) + 0.3 * hill(x * 3.1, z * 3.1, seed + 1));
}

void shape_terrain(shape *s, const char *name, double half, double height, int cells, uint32_t seed)
{
    uint32_t    n = (uint32_t)cells + 1;
    shape_part *p = shape_add(s, name, n * n, 6 * (uint32_t)(cells * cells), true, false);
    for (uint32_t j = 0, at = 0; j < n; j++)
        for (uint32_t i = 0; i < n; i++) {
            double x = half * (2.0 * i / cells - 1), z = half * (2.0 * j / cells - 1), e = 1e-4;
            set3(p->positions[j * n + i], x, terrain_height(x, z, height, seed), z);
            dvec slope = {(terrain_height(x - e, z, height, seed) - terrain_height(x + e, z, height, seed)) / (2 * e),
                          1,
                          (terrain_height(x, z - e, height, seed) - terrain_height(x, z + e, height, seed)) / (2 * e)};
            slope = dvec_unit(slope);
            set3(p->normals[j * n + i], slope.x, slope.y, slope.z);
            if (i + 1 < n && j + 1 < n)
                at = put_quad(p, at, j * n + i, (j + 1) * n + i, (j + 1) * n + i + 1, j * n + i + 1);
        }
}

void shape_wedge(shape *s, const char *name, double degrees)
{
    shape_part *p = shape_add(s, name, 8, 12, true, false);
    double      half = degrees * pi / 360, x = cos(half), z = -sin(half);
    for (uint32_t side = 0; side < 2; side++) {
        double   sign = side ? 1 : -1;
        uint32_t v = 4 * side;
        set3(p->positions[v], 0, -0.5, 0);
        set3(p->positions[v + 1], sign * x, -0.5, z);
        set3(p->positions[v + 2], sign * x, 0.5, z);
        set3(p->positions[v + 3], 0, 0.5, 0);
        for (uint32_t k = 0; k < 4; k++)
            set3(p->normals[v + k], -sign * z, 0, x);
    }
    put_quad(p, put_quad(p, 0, 3, 2, 1, 0), 4, 5, 6, 7);
}

void shape_quad(shape *s, const char *name, double half, double z)
{
    static const double corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    shape_part         *p = shape_add(s, name, 4, 6, true, true);
    for (int i = 0; i < 4; i++) {
        set3(p->positions[i], half * corner[i][0], half * corner[i][1], z);
        set3(p->normals[i], 0, 0, 1);
        p->uvs[i][0] = (float)(0.5 + 0.5 * corner[i][0]);
        p->uvs[i][1] = (float)(0.5 - 0.5 * corner[i][1]);
    }
    put_quad(p, 0, 0, 1, 2, 3);
}

static dvec area_normal(const shape_part *p, uint32_t face)
{
    dvec a = dvec_from(p->positions[p->indices[3 * face]]), b = dvec_from(p->positions[p->indices[3 * face + 1]]);
    dvec c = dvec_from(p->positions[p->indices[3 * face + 2]]);
    return dvec_cross(dvec_sub(b, a), dvec_sub(c, a));
}

/* Every corner against every other: slow, and hard to get wrong. */
static dvec corner_normal(const shape_part *p, uint32_t corner, double limit)
{
    dvec         own = dvec_unit(area_normal(p, corner / 3)), sum = {0, 0, 0};
    const float *position = p->positions[p->indices[corner]];
    for (uint32_t k = 0; k < p->index_count; k++) {
        const float *other = p->positions[p->indices[k]];
        if (position[0] < other[0] || position[0] > other[0] || position[1] < other[1] || position[1] > other[1] ||
            position[2] < other[2] || position[2] > other[2])
            continue;
        dvec n = area_normal(p, k / 3);
        if (dvec_dot(own, dvec_unit(n)) >= limit)
            sum = dvec_add(sum, n);
    }
    return dvec_unit(sum);
}

void shape_make_normals(shape *s, double crease_degrees)
{
    for (size_t i = 0; i < s->count; i++) {
        shape_part *p = &s->parts[i];
        uint32_t    count = p->index_count;
        float(*positions)[3] = check_alloc(count, sizeof *positions),
        (*normals)[3] = check_alloc(count, sizeof *normals);
        for (uint32_t k = 0; k < count; k++) {
            dvec n = corner_normal(p, k, cos(crease_degrees * pi / 180));
            memcpy(positions[k], p->positions[p->indices[k]], sizeof *positions);
            set3(normals[k], n.x, n.y, n.z);
        }
        for (uint32_t k = 0; k < count; k++)
            p->indices[k] = k;
        free(p->positions);
        free(p->normals);
        free(p->uvs);
        p->uvs = NULL;
        p->positions = positions;
        p->normals = normals;
        p->vertex_count = count;
    }
}

void shape_join(shape *out, const char *name, const shape *s)
{
    uint32_t vertices = 0, indices = 0;
    for (size_t i = 0; i < s->count; i++) {
        vertices += s->parts[i].vertex_count;
        indices += s->parts[i].index_count;
    }
    shape_part *p = shape_add(out, name, vertices, indices, false, false);
    uint32_t    base = 0, at = 0;
    for (size_t i = 0; i < s->count; i++) {
        const shape_part *q = &s->parts[i];
        for (uint32_t v = 0; v < q->vertex_count; v++) {
            dvec point = shape_point(q, v);
            set3(p->positions[base + v], point.x, point.y, point.z);
        }
        for (uint32_t k = 0; k < q->index_count; k++)
            p->indices[at++] = base + q->indices[k];
        base += q->vertex_count;
    }
}
