/* Surfaces whose directions are known, for the tests of fields and patches. */
#ifndef TESTS_FIELD_SHAPES_H
#define TESTS_FIELD_SHAPES_H

#include "import_support.h"

#include <math.h>
#include <time.h>

typedef struct place3 {
    double x, y, z;
} place3;

static const double field_pi = 3.14159265358979323846;

/* 0 … 1, the same for the same number. */
static inline double hashed(uint32_t n)
{
    n = (n ^ n >> 16) * 0x7FEB352Du;
    n = (n ^ n >> 15) * 0x846CA68Bu;
    return (n ^ n >> 16) / 4294967296.0;
}

static inline primitive empty_primitive(uint32_t vertices, uint32_t indices)
{
    primitive p = {.vertex_count = vertices, .index_count = indices, .material = NONE};
    p.positions = mem_calloc(vertices, sizeof *p.positions);
    p.indices = mem_calloc(indices, sizeof *p.indices);
    return p;
}

/* u and v in 0 … 1; a surface with closed directions joins itself there. */
typedef place3 (*surface_fn)(double u, double v);

static inline primitive grid_surface(surface_fn at, uint32_t nu, uint32_t nv, bool closed_u, bool closed_v,
                                     double jitter)
{
    uint32_t  columns = closed_u ? nu : nu + 1, rows = closed_v ? nv : nv + 1, k = 0;
    primitive p = empty_primitive(columns * rows, nu * nv * 6);
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < columns; i++) {
            uint32_t n = j * columns + i;
            bool     inner_u = closed_u || (i > 0 && i < nu), inner_v = closed_v || (j > 0 && j < nv);
            place3   q = at((i + (inner_u ? jitter * (hashed(2 * n) - 0.5) : 0)) / nu,
                            (j + (inner_v ? jitter * (hashed(2 * n + 1) - 0.5) : 0)) / nv);
            p.positions[n] = (vec3){(float)q.x, (float)q.y, (float)q.z};
        }
    for (uint32_t j = 0; j < nv; j++)
        for (uint32_t i = 0; i < nu; i++) {
            uint32_t i1 = (i + 1) % columns, j1 = (j + 1) % rows;
            uint32_t c[4] = {j * columns + i, j * columns + i1, j1 * columns + i1, j1 * columns + i};
            bool     other = jitter > 0 && hashed(j * nu + i + 77777) < 0.5;
            uint32_t order[6] = {0, 1, 2, 0, 2, 3}, turned[6] = {0, 1, 3, 1, 2, 3};
            for (int m = 0; m < 6; m++)
                p.indices[k++] = c[other ? turned[m] : order[m]];
        }
    return p;
}

static inline place3 torus_at(double u, double v)
{
    double a = 2 * field_pi * u, b = 2 * field_pi * v, r = 3 + cos(b);
    return (place3){r * cos(a), r * sin(a), sin(b)};
}

static inline place3 cylinder_at(double u, double v)
{
    double a = 2 * field_pi * u;
    return (place3){cos(a), sin(a), 5 * v};
}

/* z = x² − y² / 2 */
static inline place3 saddle_at(double u, double v)
{
    double x = 2 * u - 1, y = 2 * v - 1;
    return (place3){x, y, x * x - y * y / 2};
}

static inline place3 plane_at(double u, double v)
{
    return (place3){3 * u, 0.25, v};
}

/* A sphere from a cube's six grids, each vertex moved along the sphere by up to half of jitter cells, stretched.
 * Welded. */
static inline primitive ball(uint32_t cells, double jitter, place3 stretch)
{
    uint32_t  side = cells + 1, k = 0;
    primitive p = empty_primitive(6 * side * side, 36 * cells * cells);
    for (uint32_t f = 0; f < 6; f++)
        for (uint32_t j = 0; j < side; j++)
            for (uint32_t i = 0; i < side; i++) {
                bool     inner = i > 0 && j > 0 && i < cells && j < cells;
                uint32_t n = (f * side + j) * side + i;
                double   a = tan((2.0 * (i + (inner ? jitter * (hashed(2 * n) - 0.5) : 0)) / cells - 1) * field_pi / 4);
                double   b =
                    tan((2.0 * (j + (inner ? jitter * (hashed(2 * n + 1) - 0.5) : 0)) / cells - 1) * field_pi / 4);
                double c[3], s = f < 3 ? 1 : -1, l = sqrt(a * a + b * b + 1);
                c[f % 3] = s;
                c[(f + 1) % 3] = s * a;
                c[(f + 2) % 3] = b;
                /* Exactly the same numbers from both faces of an edge. */
                for (int m = 0; m < 3; m++)
                    c[m] = rint(c[m] / l * 1e7) / 1e7;
                p.positions[n] =
                    (vec3){(float)(c[0] * stretch.x), (float)(c[1] * stretch.y), (float)(c[2] * stretch.z)};
                if (i < cells && j < cells) {
                    const uint32_t q[6] = {n, n + 1, n + side + 1, n, n + side + 1, n + side};
                    for (int m = 0; m < 6; m++)
                        p.indices[k++] = q[m];
                }
            }
    mesh_weld_positions(&p, NULL);
    return p;
}

static inline primitive shared_cube(void)
{
    static const vec3     positions[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                          {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    static const uint32_t triangles[36] = {0, 3, 2, 0, 2, 1, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                           1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
    primitive             p = empty_primitive(8, 36);
    memcpy(p.positions, positions, sizeof positions);
    memcpy(p.indices, triangles, sizeof triangles);
    return p;
}

/* Turns about (1, 2, 3). */
static inline place3 turned_by(place3 p, double angle)
{
    const double k[3] = {1 / sqrt(14), 2 / sqrt(14), 3 / sqrt(14)}, c = cos(angle), s = sin(angle);
    double       d = (k[0] * p.x + k[1] * p.y + k[2] * p.z) * (1 - c);
    return (place3){p.x * c + (k[1] * p.z - k[2] * p.y) * s + k[0] * d,
                    p.y * c + (k[2] * p.x - k[0] * p.z) * s + k[1] * d,
                    p.z * c + (k[0] * p.y - k[1] * p.x) * s + k[2] * d};
}

static inline place3 turned(place3 p)
{
    return turned_by(p, 1);
}

static inline place3 turned_back(place3 p)
{
    return turned_by(p, -1);
}

static inline void turn_primitive(primitive *p)
{
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        place3 q = turned((place3){p->positions[v].x, p->positions[v].y, p->positions[v].z});
        p->positions[v] = (vec3){(float)q.x, (float)q.y, (float)q.z};
    }
}

static inline void scale_primitive(primitive *p, double scale, double shift)
{
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        vec3 q = p->positions[v];
        p->positions[v] =
            (vec3){(float)(q.x * scale + shift), (float)(q.y * scale + shift), (float)(q.z * scale - shift)};
    }
}

/* All triangles of a model in the data as one primitive; false (after saying so) without it. */
static inline bool model_primitive(const char *name, primitive *out)
{
    const char *folder = data_folder();
    char        path[2048];
    if (!folder)
        return false;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    lmn_scene *s = load_or_fail(path);
    uint32_t   vertices = 0, indices = 0;
    for (size_t m = 0; m < s->mesh_count; m++)
        for (size_t k = 0; k < s->meshes[m].primitive_count; k++) {
            vertices += s->meshes[m].primitives[k].vertex_count;
            indices += s->meshes[m].primitives[k].index_count;
        }
    *out = empty_primitive(vertices, indices);
    vertices = indices = 0;
    for (size_t m = 0; m < s->mesh_count; m++)
        for (size_t k = 0; k < s->meshes[m].primitive_count; k++) {
            const primitive *p = &s->meshes[m].primitives[k];
            memcpy(out->positions + vertices, p->positions, p->vertex_count * sizeof *p->positions);
            for (uint32_t i = 0; i < p->index_count; i++)
                out->indices[indices++] = p->indices[i] + vertices;
            vertices += p->vertex_count;
        }
    lmn_scene_destroy(&s);
    return true;
}

static inline double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
