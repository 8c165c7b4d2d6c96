/* Vectors of three doubles. */
#ifndef LIMNER_BASE_VECTOR3_H
#define LIMNER_BASE_VECTOR3_H

#include <math.h>
#include <stdbool.h>

static inline void vector3_set(double out[3], double x, double y, double z)
{
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

static inline void vector3_copy(double out[3], const double a[3])
{
    vector3_set(out, a[0], a[1], a[2]);
}

/* out = a + f·b; out may be a or b, here and below. */
static inline void vector3_add(double out[3], const double a[3], double f, const double b[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[k] + f * b[k];
}

static inline void vector3_mix(double out[3], const double a[3], const double b[3], double f)
{
    for (int k = 0; k < 3; k++)
        out[k] = a[k] + f * (b[k] - a[k]);
}

static inline double vector3_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vector3_cross(double out[3], const double a[3], const double b[3])
{
    vector3_set(out, a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}

static inline double vector3_length(const double a[3])
{
    return sqrt(vector3_dot(a, a));
}

static inline double vector3_distance(const double a[3], const double b[3])
{
    double d[3];
    vector3_add(d, a, -1, b);
    return vector3_length(d);
}

/* False, and unchanged, where there is no direction. */
static inline bool vector3_normalise(double a[3])
{
    double length = vector3_length(a);
    if (!(length > 0) || !isfinite(length))
        return false;
    for (int k = 0; k < 3; k++)
        a[k] /= length;
    return true;
}

/* The same where vectors are about 1 long: one shorter than 1e-12 is what rounding has left of parallel ones, and has
 * no direction. */
static inline bool vector3_normalise_sure(double a[3])
{
    return vector3_length(a) > 1e-12 && vector3_normalise(a);
}

#endif
