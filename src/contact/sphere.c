#include "contact/sphere.h"

#include <string.h>

#include "base/vector3.h"

enum { UNKNOWNS = 4 };

static void place_of(const primitive *p, uint32_t vertex, const double from[3], double out[3])
{
    const vec3 *v = &p->positions[vertex];
    vector3_set(out, (double)v->x - from[0], (double)v->y - from[1], (double)v->z - from[2]);
}

/* Gauss with the largest pivot of each column; false where the equations say too little. */
static bool solve(double rows[UNKNOWNS][UNKNOWNS + 1], double out[UNKNOWNS])
{
    for (int column = 0; column < UNKNOWNS; column++) {
        int pivot = column;
        for (int i = column + 1; i < UNKNOWNS; i++)
            pivot = fabs(rows[i][column]) > fabs(rows[pivot][column]) ? i : pivot;
        if (!(fabs(rows[pivot][column]) > 1e-12))
            return false;
        for (int k = 0; k <= UNKNOWNS && pivot != column; k++) {
            const double kept = rows[pivot][k];
            rows[pivot][k] = rows[column][k];
            rows[column][k] = kept;
        }
        for (int i = 0; i < UNKNOWNS; i++)
            for (int k = UNKNOWNS; i != column && k >= column; k--)
                rows[i][k] -= rows[i][column] / rows[column][column] * rows[column][k];
    }
    for (int i = 0; i < UNKNOWNS; i++)
        out[i] = rows[i][UNKNOWNS] / rows[i][i];
    return true;
}

/* The sphere that lies best in all vertices: |p|² = 2 c·p + (r² − |c|²) is linear. Lengths are in halves of the box. */
static bool fit(sphere *out, const primitive *p)
{
    double middle[3], rows[UNKNOWNS][UNKNOWNS + 1] = {{0}}, found[UNKNOWNS];
    box3_middle(p->bounds, middle);
    const double unit = box3_diagonal(p->bounds) / 2;
    if (!(unit > 0))
        return false;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        double at[UNKNOWNS];
        place_of(p, v, middle, at);
        for (int k = 0; k < 3; k++)
            at[k] /= unit;
        at[3] = 0.5;
        for (int i = 0; i < UNKNOWNS; i++) {
            for (int k = 0; k < UNKNOWNS; k++)
                rows[i][k] += 4 * at[i] * at[k] / p->vertex_count;
            rows[i][UNKNOWNS] += 2 * at[i] * vector3_dot(at, at) / p->vertex_count;
        }
    }
    if (!solve(rows, found))
        return false;
    vector3_add(out->centre, middle, unit, found);
    out->radius = unit * sqrt(fmax(found[3] + vector3_dot(found, found), 0));
    return out->radius > 0;
}

/* Do all vertices lie on it, their normals away from its middle? */
static bool lies_on(const primitive *p, const sphere *s)
{
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        double at[3];
        place_of(p, v, s->centre, at);
        if (fabs(vector3_length(at) - s->radius) > 1e-4 * s->radius)
            return false;
        if (p->normals) {
            const double normal[3] = {(double)p->normals[v].x, (double)p->normals[v].y, (double)p->normals[v].z};
            if (fabs(vector3_dot(at, normal)) < 0.99 * s->radius)
                return false;
        }
    }
    return true;
}

/* Twice the tangent's angle: the solid angle of a triangle seen from the middle (Van Oosterom and Strackee 1983). */
static double solid_angle(const double a[3], const double b[3], const double c[3], double r)
{
    double cross[3];
    vector3_cross(cross, b, c);
    return 2 * atan2(vector3_dot(a, cross), r * (r * r + vector3_dot(a, b) + vector3_dot(b, c) + vector3_dot(c, a)));
}

/* Do its triangles go once around the middle, none of them far below the sphere? */
static bool closes(const primitive *p, const sphere *s)
{
    double sum = 0;
    for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
        double c[3][3], middle[3] = {0, 0, 0};
        for (int k = 0; k < 3; k++) {
            place_of(p, p->indices[i + (uint32_t)k], s->centre, c[k]);
            vector3_add(middle, middle, 1.0 / 3, c[k]);
        }
        if (vector3_length(middle) < 0.85 * s->radius)
            return false;
        sum += solid_angle(c[0], c[1], c[2], s->radius);
    }
    return fabs(fabs(sum) - 12.566370614359172) < 1e-2;
}

/* The box of a sphere is nearly a cube: terrains and cities need no closer look. */
static bool has_even_box(const primitive *p)
{
    const double size[3] = {(double)p->bounds.max.x - (double)p->bounds.min.x,
                            (double)p->bounds.max.y - (double)p->bounds.min.y,
                            (double)p->bounds.max.z - (double)p->bounds.min.z};
    return fmin(fmin(size[0], size[1]), size[2]) > 0.7 * fmax(fmax(size[0], size[1]), size[2]);
}

bool sphere_of(sphere *out, const primitive *p)
{
    return p->vertex_count >= 20 && p->index_count >= 60 && has_even_box(p) && fit(out, p) && lies_on(p, out) &&
           closes(p, out);
}
