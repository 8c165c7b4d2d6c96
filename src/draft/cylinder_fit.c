#include "draft/cylinder_fit.h"

#include <math.h>
#include <string.h>

#include "base/vector3.h"
#include "draft/eigenvectors.h"

enum { ROUNDS = 6, UNKNOWNS = 6, JACOBI_ROUNDS = 12 };

static const double slope_least = 5e-3, slope_most = 5; /* flatter and steeper ones are cylinders and planes */
static const double tip = 1e-3;                         /* of the radius: what is nearer to the axis is a cone's tip */
static const double enough = 1e-9;                      /* of the radius: nothing comes nearer any more */

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

static void add_row(double m[UNKNOWNS][UNKNOWNS + 1], int unknowns, const double row[UNKNOWNS], double off)
{
    for (int a = 0; a < unknowns; a++) {
        for (int b = 0; b < unknowns; b++)
            m[a][b] += row[a] * row[b];
        m[a][unknowns] += row[a] * off;
    }
}

/* One step: the sums of the normal equations, in radii, so that all unknowns are of one size. */
static bool step(cylinder_fit *c, const double (*points)[3], size_t count, double *change)
{
    const int unknowns = c->slope == 0 ? UNKNOWNS - 1 : UNKNOWNS;
    double    m[UNKNOWNS][UNKNOWNS + 1] = {{0}}, middle = 0, size;
    for (size_t i = 0; i < count; i++) {
        double d[3];
        vector3_add(d, points[i], -1, c->centre);
        middle += vector3_dot(d, c->axis) / (double)count;
    }
    vector3_add(c->centre, c->centre, middle, c->axis);
    c->radius = size = cylinder_radius(c, middle);
    if (!(size > 0))
        return false;
    for (size_t i = 0; i < count; i++) {
        double d[3];
        vector3_add(d, points[i], -1, c->centre);
        double x = vector3_dot(d, c->across[0]), y = vector3_dot(d, c->across[1]), away = sqrt(x * x + y * y);
        double t = vector3_dot(d, c->axis) / size;
        double off = (away / size - 1) - c->slope * t, lean = t + c->slope * away / size;
        if (!(away > 0) && c->slope == 0)
            return false;
        if (c->slope != 0 && !(away > tip * size)) {
            /* The tip has no direction; it lies on the axis. */
            add_row(m, unknowns, (const double[UNKNOWNS]){0, 0, 1, 0, 0, t}, off);
            add_row(m, unknowns, (const double[UNKNOWNS]){1, 0, 0, t, 0, 0}, x / size);
            add_row(m, unknowns, (const double[UNKNOWNS]){0, 1, 0, 0, t, 0}, y / size);
            continue;
        }
        x /= away;
        y /= away;
        add_row(m, unknowns, (const double[UNKNOWNS]){x, y, 1, lean * x, lean * y, t}, off);
    }
    for (int k = 0; k < unknowns; k++)
        m[k][k] += 1e-9 * (double)count; /* short ones say little of their axis: it stays as it is */
    if (!solve(m, unknowns))
        return false;
    *change = 0;
    for (int k = 0; k < unknowns; k++)
        *change = fmax(*change, fabs(m[k][unknowns]));
    for (int k = 0; k < 2; k++) {
        vector3_add(c->centre, c->centre, size * m[k][unknowns], c->across[k]);
        vector3_add(c->axis, c->axis, m[3 + k][unknowns], c->across[k]);
    }
    c->radius += size * m[2][unknowns];
    if (unknowns == UNKNOWNS) {
        c->slope += m[5][unknowns];
        if (!(fabs(c->slope) > slope_least && fabs(c->slope) < slope_most))
            return false;
    }
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

void cylinder_axis_of_normals(double out[3], const double (*normals)[3], size_t count)
{
    double m[3][3] = {{0}}, axes[3][3];
    for (size_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                m[a][b] += normals[i][a] * normals[i][b];
    eigenvectors_find(&axes[0][0], &m[0][0], 3, JACOBI_ROUNDS);
    int least = 0;
    for (int k = 1; k < 3; k++)
        least = m[k][k] < m[least][least] ? k : least;
    for (int k = 0; k < 3; k++)
        out[k] = axes[k][least];
}

/* Radius and slope of the corners: faces are chords, and lean less. */
static bool line_of_radii(cylinder_fit *c, const double (*points)[3], size_t count)
{
    double sums[2][3] = {{0}};
    for (size_t i = 0; i < count; i++) {
        double t, away = cylinder_distance(c, points[i], NULL, &t), row[3] = {1, t, away};
        for (int a = 0; a < 2; a++)
            for (int b = 0; b < 3; b++)
                sums[a][b] += row[a] * row[b];
    }
    double divisor = sums[0][0] * sums[1][1] - sums[0][1] * sums[1][0];
    if (!(divisor > 0))
        return false;
    c->radius = (sums[0][2] * sums[1][1] - sums[0][1] * sums[1][2]) / divisor;
    c->slope = (sums[0][0] * sums[1][2] - sums[1][0] * sums[0][2]) / divisor;
    return c->radius > 0 && fabs(c->slope) > slope_least && fabs(c->slope) < slope_most;
}

/* Its normals have one angle to the axis, so that their tips lie in a plane across it. Along the axis the radius is a
 * line, whose slope that angle is; so x² + y² − slope² t² is a sum of what x, y and t have a part in. */
bool cone_start(cylinder_fit *c, const double (*normals)[3], size_t normal_count, const double (*points)[3],
                size_t count)
{
    double mean[3] = {0}, middle[3] = {0}, tips[64][3], m[UNKNOWNS][UNKNOWNS + 1] = {{0}}, lean;
    if (normal_count < 3 || normal_count > sizeof tips / sizeof *tips)
        return false;
    for (size_t i = 0; i < normal_count; i++)
        vector3_add(mean, mean, 1.0 / (double)normal_count, normals[i]);
    for (size_t i = 0; i < normal_count; i++)
        vector3_add(tips[i], normals[i], -1, mean);
    cylinder_axis_of_normals(c->axis, (const double(*)[3])tips, normal_count);
    cylinder_frame(c);
    lean = vector3_dot(mean, c->axis);
    for (size_t i = 0; i < normal_count; i++)
        if (fabs(vector3_dot(tips[i], c->axis)) > 0.02)
            return false;
    for (size_t i = 0; i < count; i++)
        vector3_add(middle, middle, 1.0 / (double)count, points[i]);
    double slope = fabs(lean) < 1 ? -lean / sqrt(1 - lean * lean) : slope_most;
    for (size_t i = 0; i < count; i++) {
        double d[3];
        vector3_add(d, points[i], -1, middle);
        double t = vector3_dot(d, c->axis), row[4] = {vector3_dot(d, c->across[0]), vector3_dot(d, c->across[1]), t, 1};
        double sum = row[0] * row[0] + row[1] * row[1] - slope * slope * t * t;
        for (int a = 0; a < 4; a++) {
            for (int b = 0; b < 4; b++)
                m[a][b] += row[a] * row[b];
            m[a][4] += row[a] * sum;
        }
    }
    if (!solve(m, 4))
        return false;
    double x = m[0][4] / 2, y = m[1][4] / 2, square = m[3][4] + x * x + y * y;
    vector3_add(c->centre, middle, x, c->across[0]);
    vector3_add(c->centre, c->centre, y, c->across[1]);
    if (!(square > 0) || !isfinite(square))
        return false;
    c->radius = sqrt(square);
    return line_of_radii(c, points, count);
}
