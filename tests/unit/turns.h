/* Rotations as matrices, rows first, written out: what quaternions of the library are held against. */
#ifndef TESTS_TURNS_H
#define TESTS_TURNS_H

#include <math.h>

typedef struct turn {
    double m[3][3];
} turn;

/* How angles in degrees about x, y and z turn columns, written out. */
static inline turn about(char axis, double degrees)
{
    double c = cos(degrees * acos(-1) / 180), s = sin(degrees * acos(-1) / 180);
    if (axis == 'X')
        return (turn){{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
    if (axis == 'Y')
        return (turn){{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
    return (turn){{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}

static inline turn times(turn a, turn b)
{
    turn out = {{{0}}};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            for (int n = 0; n < 3; n++)
                out.m[i][k] += a.m[i][n] * b.m[n][k];
    return out;
}

/* What a quaternion does to the axes. */
static inline turn of_quaternion(const float *q)
{
    double x = (double)q[0], y = (double)q[1], z = (double)q[2], w = (double)q[3];
    return (turn){{{w * w + x * x - y * y - z * z, 2 * (x * y - z * w), 2 * (x * z + y * w)},
                   {2 * (x * y + z * w), w * w - x * x + y * y - z * z, 2 * (y * z - x * w)},
                   {2 * (x * z - y * w), 2 * (y * z + x * w), w * w - x * x - y * y + z * z}}};
}

static inline double difference(turn a, turn b)
{
    double most = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            most = fmax(most, fabs(a.m[i][k] - b.m[i][k]));
    return most;
}

#endif
