/* Matrices and boxes. */
#include <math.h>

#include "base/memory.h"
#include "scene/scene.h"

mat4 mat4_identity(void)
{
    mat4 m = {{0}};
    m.m[0] = m.m[5] = m.m[10] = m.m[15] = 1;
    return m;
}

mat4 mat4_multiply(const mat4 *a, const mat4 *b)
{
    mat4 out;
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++) {
            double sum = 0;
            for (int k = 0; k < 4; k++)
                sum += a->m[k * 4 + row] * b->m[column * 4 + k];
            out.m[column * 4 + row] = sum;
        }
    return out;
}

double mat4_cofactors(const mat4 *matrix, double out[9])
{
    const double *m = matrix->m;
    const double  cofactors[9] = {m[5] * m[10] - m[6] * m[9], m[6] * m[8] - m[4] * m[10], m[4] * m[9] - m[5] * m[8],
                                  m[9] * m[2] - m[10] * m[1], m[10] * m[0] - m[8] * m[2], m[8] * m[1] - m[9] * m[0],
                                  m[1] * m[6] - m[2] * m[5],  m[2] * m[4] - m[0] * m[6],  m[0] * m[5] - m[1] * m[4]};
    for (int i = 0; i < 9; i++)
        out[i] = cofactors[i];
    return m[0] * out[0] + m[1] * out[1] + m[2] * out[2];
}

bool mat4_is_flat(const mat4 *m)
{
    const double SLIGHT = 1e-12;
    double       c[9], lengths = 1;
    for (int column = 0; column < 3; column++) {
        const double *v = &m->m[4 * column];
        lengths *= sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    }
    return !(fabs(mat4_cofactors(m, c)) > SLIGHT * lengths);
}

mat4 mat4_inverse(const mat4 *m)
{
    double cofactors[9], determinant = mat4_cofactors(m, cofactors);
    mat4   out = mat4_identity();
    if (determinant == 0 || !isfinite(determinant))
        return out;
    for (int row = 0; row < 3; row++) {
        double moved = 0;
        for (int k = 0; k < 3; k++) {
            out.m[4 * k + row] = cofactors[3 * row + k] / determinant;
            moved += out.m[4 * k + row] * m->m[12 + k];
        }
        out.m[12 + row] = -moved;
    }
    return out;
}

vec3 mat4_transform_point(const mat4 *m, vec3 p)
{
    const double *e = m->m;
    double        x = p.x, y = p.y, z = p.z;
    return (vec3){(float)(e[0] * x + e[4] * y + e[8] * z + e[12]), (float)(e[1] * x + e[5] * y + e[9] * z + e[13]),
                  (float)(e[2] * x + e[6] * y + e[10] * z + e[14])};
}

mat4 mat4_from_trs(const double t[3], const double r[4], const double s[3])
{
    double x = r[0], y = r[1], z = r[2], w = r[3];
    double length = sqrt(x * x + y * y + z * z + w * w);
    /* A file may hold a quaternion that is only nearly unit; a zero one means no rotation. */
    if (length > 0) {
        x /= length;
        y /= length;
        z /= length;
        w /= length;
    } else {
        w = 1;
    }
    mat4 m = mat4_identity();
    m.m[0] = (1 - 2 * (y * y + z * z)) * s[0];
    m.m[1] = 2 * (x * y + z * w) * s[0];
    m.m[2] = 2 * (x * z - y * w) * s[0];
    m.m[4] = 2 * (x * y - z * w) * s[1];
    m.m[5] = (1 - 2 * (x * x + z * z)) * s[1];
    m.m[6] = 2 * (y * z + x * w) * s[1];
    m.m[8] = 2 * (x * z + y * w) * s[2];
    m.m[9] = 2 * (y * z - x * w) * s[2];
    m.m[10] = (1 - 2 * (x * x + y * y)) * s[2];
    m.m[12] = t[0];
    m.m[13] = t[1];
    m.m[14] = t[2];
    return m;
}

static const node_place nowhere = {
    .matrix = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}, .rotation = {0, 0, 0, 1}, .scale = {1, 1, 1}};

const node_place *node_place_of(const node *n)
{
    return n->place ? n->place : &nowhere;
}

node_place *node_own_place(node *n)
{
    if (!n->place)
        n->place = mem_copy(&nowhere, sizeof nowhere);
    return n->place;
}

bool node_set_matrix(node *n, const mat4 *matrix)
{
    if (!node_own_place(n))
        return false;
    n->has_matrix = true;
    n->place->matrix = *matrix;
    return true;
}

mat4 node_local_matrix(const node *n)
{
    const node_place *at = node_place_of(n);
    return n->has_matrix ? at->matrix : mat4_from_trs(at->translation, at->rotation, at->scale);
}

box3 box3_empty(void)
{
    return (box3){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

bool box3_is_empty(box3 b)
{
    return !(b.min.x <= b.max.x && b.min.y <= b.max.y && b.min.z <= b.max.z);
}

static float smaller(float a, float b)
{
    return a < b ? a : b;
}

static float larger(float a, float b)
{
    return a > b ? a : b;
}

bool box3_overlap(box3 a, box3 b)
{
    return a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y && a.min.z < b.max.z &&
           b.min.z < a.max.z;
}

box3 box3_intersection(box3 a, box3 b)
{
    if (!box3_overlap(a, b))
        return box3_empty();
    return (box3){{fmaxf(a.min.x, b.min.x), fmaxf(a.min.y, b.min.y), fmaxf(a.min.z, b.min.z)},
                  {fminf(a.max.x, b.max.x), fminf(a.max.y, b.max.y), fminf(a.max.z, b.max.z)}};
}

void box3_middle(box3 b, double out[3])
{
    out[0] = ((double)b.min.x + (double)b.max.x) / 2;
    out[1] = ((double)b.min.y + (double)b.max.y) / 2;
    out[2] = ((double)b.min.z + (double)b.max.z) / 2;
}

double box3_diagonal(box3 b)
{
    double x = (double)b.max.x - (double)b.min.x, y = (double)b.max.y - (double)b.min.y,
           z = (double)b.max.z - (double)b.min.z;
    return sqrt(x * x + y * y + z * z);
}

box3 box3_union(box3 a, box3 b)
{
    return (box3){{smaller(a.min.x, b.min.x), smaller(a.min.y, b.min.y), smaller(a.min.z, b.min.z)},
                  {larger(a.max.x, b.max.x), larger(a.max.y, b.max.y), larger(a.max.z, b.max.z)}};
}

box3 box3_with_point(box3 b, vec3 p)
{
    return box3_union(b, (box3){p, p});
}

box3 box3_transform(box3 b, const mat4 *m)
{
    box3 out = box3_empty();
    if (box3_is_empty(b))
        return out;
    for (int i = 0; i < 8; i++) {
        vec3 corner = {i & 1 ? b.max.x : b.min.x, i & 2 ? b.max.y : b.min.y, i & 4 ? b.max.z : b.min.z};
        out = box3_with_point(out, mat4_transform_point(m, corner));
    }
    return out;
}
