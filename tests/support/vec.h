/* Three-vectors and 4x4 matrices in double precision for the references. Matrices are column-major and act on
 * columns. */
#ifndef TRUTH_VEC_H
#define TRUTH_VEC_H

#include <math.h>

typedef struct dvec {
    double x, y, z;
} dvec;

static inline dvec dvec_of(double x, double y, double z)
{
    return (dvec){x, y, z};
}

static inline dvec dvec_from(const float v[3])
{
    return (dvec){(double)v[0], (double)v[1], (double)v[2]};
}

static inline dvec dvec_add(dvec a, dvec b)
{
    return (dvec){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline dvec dvec_sub(dvec a, dvec b)
{
    return (dvec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline dvec dvec_scale(dvec a, double s)
{
    return (dvec){a.x * s, a.y * s, a.z * s};
}

static inline double dvec_dot(dvec a, dvec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline dvec dvec_cross(dvec a, dvec b)
{
    return (dvec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double dvec_length(dvec a)
{
    return sqrt(dvec_dot(a, a));
}

static inline dvec dvec_unit(dvec a)
{
    double length = dvec_length(a);
    return length > 0 ? dvec_scale(a, 1 / length) : a;
}

static inline dvec dvec_mix(dvec a, dvec b, double t)
{
    return dvec_add(dvec_scale(a, 1 - t), dvec_scale(b, t));
}

/* m · (v, w); the fourth component goes to *out_w when that is not NULL. */
static inline dvec dmat_apply(const double m[16], dvec v, double w, double *out_w)
{
    dvec r = {m[0] * v.x + m[4] * v.y + m[8] * v.z + m[12] * w, m[1] * v.x + m[5] * v.y + m[9] * v.z + m[13] * w,
              m[2] * v.x + m[6] * v.y + m[10] * v.z + m[14] * w};
    if (out_w)
        *out_w = m[3] * v.x + m[7] * v.y + m[11] * v.z + m[15] * w;
    return r;
}

#endif
