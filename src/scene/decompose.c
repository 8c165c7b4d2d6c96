#include "scene/decompose.h"

#include <math.h>
#include <string.h>

/* Shorter than this, against the matrix's longest column, an axis has no direction that could be told. */
static const double FLAT = 1e-9;
/* How far T·R·S may be from the matrix that it stands for; files hold single precision. */
static const double SHEAR = 1e-5;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static bool to_unit(double v[3], double least)
{
    double length = sqrt(dot(v, v));
    if (!(length > least && isfinite(length)))
        return false;
    for (int k = 0; k < 3; k++)
        v[k] /= length;
    return true;
}

/* Any direction across a unit one. */
static void across(const double v[3], double out[3])
{
    double near[3] = {0, 0, 0};
    near[fabs(v[0]) < 0.6 ? 0 : 1] = 1;
    cross(v, near, out);
    to_unit(out, 0);
}

/* Makes `axis` across `x`, which is unit. */
static bool square_up(double axis[3], const double x[3], double least)
{
    double along = dot(axis, x);
    for (int k = 0; k < 3; k++)
        axis[k] -= along * x[k];
    return to_unit(axis, least);
}

/* Right-handed unit axes near the columns; a column without length takes the direction that is left. */
static void find_axes(double columns[3][3], double least, double axes[3][3])
{
    double third[3];
    memcpy(axes[0], columns[0], sizeof axes[0]);
    memcpy(axes[1], columns[1], sizeof axes[1]);
    memcpy(third, columns[2], sizeof third);
    if (!to_unit(axes[0], least)) {
        /* Nothing holds the first axis: it follows from the others, as far as there are any. */
        double y[3], z[3];
        memcpy(y, columns[1], sizeof y);
        memcpy(z, columns[2], sizeof z);
        if (to_unit(y, least) && to_unit(z, least))
            cross(y, z, axes[0]);
        else if (sqrt(dot(columns[1], columns[1])) > least)
            across(y, axes[0]);
        else if (to_unit(z, least))
            across(z, axes[0]);
        if (!to_unit(axes[0], 1e-6))
            memcpy(axes[0], (double[3]){1, 0, 0}, sizeof axes[0]);
    }
    if (!square_up(axes[1], axes[0], least)) {
        if (square_up(third, axes[0], least))
            cross(third, axes[0], axes[1]);
        else
            across(axes[0], axes[1]);
    }
    cross(axes[0], axes[1], axes[2]);
}

/* The quaternion of right-handed unit axes, by its largest component. */
static void to_quaternion(double a[3][3], double r[4])
{
    const double squares[4] = {1 + a[0][0] - a[1][1] - a[2][2], 1 - a[0][0] + a[1][1] - a[2][2],
                               1 - a[0][0] - a[1][1] + a[2][2], 1 + a[0][0] + a[1][1] + a[2][2]};
    int          largest = 0;
    for (int k = 1; k < 4; k++)
        if (squares[k] > squares[largest])
            largest = k;
    /* Rows are axes: a[i][j] is the j-th coordinate of the i-th axis. */
    const double products[4][4] = {
        {squares[0], a[0][1] + a[1][0], a[2][0] + a[0][2], a[1][2] - a[2][1]},
        {a[0][1] + a[1][0], squares[1], a[1][2] + a[2][1], a[2][0] - a[0][2]},
        {a[2][0] + a[0][2], a[1][2] + a[2][1], squares[2], a[0][1] - a[1][0]},
        {a[1][2] - a[2][1], a[2][0] - a[0][2], a[0][1] - a[1][0], squares[3]},
    };
    double length = 0;
    for (int k = 0; k < 4; k++)
        length += products[largest][k] * products[largest][k];
    length = sqrt(length);
    for (int k = 0; k < 4; k++)
        r[k] = products[largest][k] / length;
}

bool mat4_decompose(const mat4 *m, double t[3], double r[4], double s[3])
{
    double columns[3][3], axes[3][3], longest = 0;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            columns[i][k] = isfinite(m->m[4 * i + k]) ? m->m[4 * i + k] : 0;
        longest = fmax(longest, sqrt(dot(columns[i], columns[i])));
        t[i] = isfinite(m->m[12 + i]) ? m->m[12 + i] : 0;
    }
    find_axes(columns, FLAT * longest, axes);
    to_quaternion(axes, r);
    double lost = 0;
    for (int i = 0; i < 3; i++) {
        s[i] = dot(columns[i], axes[i]);
        for (int k = 0; k < 3; k++)
            lost = fmax(lost, fabs(columns[i][k] - s[i] * axes[i][k]));
    }
    return lost <= SHEAR * longest;
}
