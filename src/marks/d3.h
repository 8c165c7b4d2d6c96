/* Vectors of doubles, for what is worked out on surfaces whose vertices are floats. */
#ifndef LIMNER_MARKS_D3_H
#define LIMNER_MARKS_D3_H

#include "scene/scene.h"

typedef struct d3 {
    double x, y, z;
} d3;

static inline d3 of(vec3 v)
{
    return (d3){(double)v.x, (double)v.y, (double)v.z};
}

static inline d3 minus(d3 a, d3 b)
{
    return (d3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline double dot(d3 a, d3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline d3 cross(d3 a, d3 b)
{
    return (d3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

#endif
