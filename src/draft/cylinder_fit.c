#include "draft/cylinder_fit.h"

#include <math.h>
#include <string.h>

#include "base/vector3.h"

enum { ROUNDS = 6, UNKNOWNS = 5, JACOBI_ROUNDS = 12 };

static const double enough = 1e-9; /* of the radius: nothing comes nearer any more */

void cylinder_frame(cylinder_fit *c)
{
    int least = 0;
    for (int k = 1; k < 3; k++)
        least = fabs(c->axis[k]) < fabs(c->axis[least]) - 1e-3 ? k : least;
    double other[3] = {least == 0, least == 1, least == 2};
    vector3_cross(c->across[0], c->axis, other);
    vector3_normalise(c->across[0]);
    vector3_cross(c->across[1], c->axis, c->across[0]);
}

double cylinder_distance(const cylinder_fit *c, const double p[3], double *angle, double *along)
{
    double d[3];
    vector3_add(d, p, -1, c->centre);
    double x = vector3_dot(d, c->across[0]), y = vector3_dot(d, c->across[1]);
    if (angle)
        *angle = atan2(y, x);
    if (along)
        *along = vector3_dot(d, c->axis);
    return hypot(x, y);
}

/* Gauss with pivots; false where there is no answer. */
static bool solve(double m[UNKNOWNS][UNKNOWNS + 1], int count)
{
    for (int k = 0; k < count; k++) {
        int best = k;
        for (int i = k + 1; i < count; i++)
            best = fabs(m[i][k]) > fabs(m[best][k]) ? i : best;
        if (!(fabs(m[best][k]) > 1e-300))
            return false;
        for (int j = 0; j <= count; j++) {
            double keep = m[k][j];
            m[k][j] = m[best][j];
            m[best][j] = keep;
        }
        for (int i = 0; i < count; i++) {
            double factor = i == k ? 0 : m[i][k] / m[k][k];
            for (int j = k; j <= count && factor != 0; j++)
                m[i][j] -= factor * m[k][j];
        }
    }
    for (int k = 0; k < count; k++)
        m[k][count] /= m[k][k];
    return true;
}

bool cylinder_start(cylinder_fit *c, const double (*points)[3], size_t count)
{
    double m[UNKNOWNS][UNKNOWNS + 1] = {{0}}, middle[3] = {0};
    cylinder_frame(c);
    for (size_t i = 0; i < count; i++)
        vector3_add(middle, middle, 1.0 / (double)count, points[i]);
    for (size_t i = 0; i < count; i++) {
        double d[3];
        vector3_add(d, points[i], -1, middle);
        double row[4] = {vector3_dot(d, c->across[0]), vector3_dot(d, c->across[1]), 1, 0};
        row[3] = row[0] * row[0] + row[1] * row[1];
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 4; b++)
                m[a][b == 3 ? 3 : b] += row[a] * row[b];
    }
    if (!solve(m, 3))
        return false;
    double x = m[0][3] / 2, y = m[1][3] / 2, square = m[2][3] + x * x + y * y;
    if (!(square > 0) || !isfinite(square))
        return false;
    vector3_add(c->centre, middle, x, c->across[0]);
    vector3_add(c->centre, c->centre, y, c->across[1]);
    c->radius = sqrt(square);
    return true;
}

/* One step: the sums of the normal equations, in radii, so that all unknowns are of one size. */
static bool step(cylinder_fit *c, const double (*points)[3], size_t count, double *change)
{
    double m[UNKNOWNS][UNKNOWNS + 1] = {{0}}, middle = 0, size = c->radius;
    for (size_t i = 0; i < count; i++) {
        double d[3];
        vector3_add(d, points[i], -1, c->centre);
        middle += vector3_dot(d, c->axis) / (double)count;
    }
    vector3_add(c->centre, c->centre, middle, c->axis);
    for (size_t i = 0; i < count; i++) {
        double d[3];
        vector3_add(d, points[i], -1, c->centre);
        double x = vector3_dot(d, c->across[0]), y = vector3_dot(d, c->across[1]), away = sqrt(x * x + y * y);
        double t = vector3_dot(d, c->axis) / size;
        if (!(away > 0))
            return false;
        x /= away;
        y /= away;
        double row[UNKNOWNS + 1] = {x, y, 1, t * x, t * y, away / size - 1};
        for (int a = 0; a < UNKNOWNS; a++)
            for (int b = 0; b <= UNKNOWNS; b++)
                m[a][b] += row[a] * row[b];
    }
    for (int k = 0; k < UNKNOWNS; k++)
        m[k][k] += 1e-9 * (double)count; /* short ones say little of their axis: it stays as it is */
    if (!solve(m, UNKNOWNS))
        return false;
    *change = 0;
    for (int k = 0; k < UNKNOWNS; k++)
        *change = fmax(*change, fabs(m[k][UNKNOWNS]));
    for (int k = 0; k < 2; k++) {
        vector3_add(c->centre, c->centre, size * m[k][UNKNOWNS], c->across[k]);
        vector3_add(c->axis, c->axis, m[3 + k][UNKNOWNS], c->across[k]);
    }
    c->radius += size * m[2][UNKNOWNS];
    bool fine = vector3_normalise(c->axis) && c->radius > 0 && isfinite(c->radius);
    cylinder_frame(c);
    return fine;
}

bool cylinder_refine(cylinder_fit *c, const double (*points)[3], size_t count)
{
    double change = 1;
    for (int i = 0; i < ROUNDS && change > enough; i++)
        if (!step(c, points, count, &change))
            return false;
    return true;
}

/* Turns rows and columns p and q of a symmetric matrix so that the number between them becomes 0 (Jacobi). */
static void rotate(double m[3][3], double axes[3][3], int p, int q)
{
    if (m[p][q] == 0)
        return;
    double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
    double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1)), c = 1 / sqrt(t * t + 1), s = t * c;
    for (int k = 0; k < 3; k++) {
        double a = m[k][p], b = m[k][q];
        m[k][p] = c * a - s * b;
        m[k][q] = s * a + c * b;
    }
    for (int k = 0; k < 3; k++) {
        double a = m[p][k], b = m[q][k];
        m[p][k] = c * a - s * b;
        m[q][k] = s * a + c * b;
        a = axes[k][p];
        b = axes[k][q];
        axes[k][p] = c * a - s * b;
        axes[k][q] = s * a + c * b;
    }
}

void cylinder_axis_of_normals(double out[3], const double (*normals)[3], size_t count)
{
    double m[3][3] = {{0}}, axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (size_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                m[a][b] += normals[i][a] * normals[i][b];
    for (int i = 0; i < JACOBI_ROUNDS; i++)
        for (int p = 0; p < 2; p++)
            for (int q = p + 1; q < 3; q++)
                rotate(m, axes, p, q);
    int least = 0;
    for (int k = 1; k < 3; k++)
        least = m[k][k] < m[least][least] ? k : least;
    for (int k = 0; k < 3; k++)
        out[k] = axes[k][least];
}
