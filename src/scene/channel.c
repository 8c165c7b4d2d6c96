#include "scene/channel.h"

#include <math.h>

/* The last key that is not after the time; 0 before all. */
static size_t key_before(const animation_channel *c, double seconds)
{
    size_t low = 0, high = c->key_count;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if ((double)c->times[middle] <= seconds)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void quaternion_normalise(double q[4])
{
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int k = 0; k < 4; k++)
        q[k] = length > 0 ? q[k] / length : k == 3;
}

void quaternion_slerp(const double from[4], const double to[4], double t, double out[4])
{
    double cosine = from[0] * to[0] + from[1] * to[1] + from[2] * to[2] + from[3] * to[3], sign = cosine < 0 ? -1 : 1;
    double angle = acos(fmin(cosine * sign, 1)), whole = sin(angle), a = 1 - t, b = t;
    if (whole > 1e-6) {
        a = sin((1 - t) * angle) / whole;
        b = sin(t * angle) / whole;
    }
    for (int k = 0; k < 4; k++)
        out[k] = a * from[k] + sign * b * to[k];
}

/* Where a key's value is: of cubic ones the middle of three. */
static const float *value_of(const animation_channel *c, size_t key)
{
    return c->interpolation == INTERPOLATION_CUBIC ? &c->values[(3 * key + 1) * c->components]
                                                   : &c->values[key * c->components];
}

static void hold(const animation_channel *c, size_t key, double *out)
{
    const float *value = value_of(c, key);
    for (size_t k = 0; k < c->components; k++)
        out[k] = (double)value[k];
}

/* Tangents are per second. */
static void cubic(const animation_channel *c, size_t key, double t, double span, double *out)
{
    const float *from = value_of(c, key), *to = value_of(c, key + 1), *leaving = from + c->components,
                *arriving = to - c->components;
    double square = t * t, cube = square * t;
    for (size_t k = 0; k < c->components; k++)
        out[k] = (2 * cube - 3 * square + 1) * (double)from[k] + span * (cube - 2 * square + t) * (double)leaving[k] +
                 (3 * square - 2 * cube) * (double)to[k] + span * (cube - square) * (double)arriving[k];
}

static void linear(const animation_channel *c, size_t key, double t, double *out)
{
    const float *from = value_of(c, key), *to = value_of(c, key + 1);
    if (c->path == PATH_ROTATION) {
        double a[4], b[4];
        for (int k = 0; k < 4; k++) {
            a[k] = (double)from[k];
            b[k] = (double)to[k];
        }
        quaternion_normalise(a);
        quaternion_normalise(b);
        quaternion_slerp(a, b, t, out);
        return;
    }
    for (size_t k = 0; k < c->components; k++)
        out[k] = (double)from[k] + t * ((double)to[k] - (double)from[k]);
}

void animation_channel_at(const animation_channel *c, double seconds, double *out)
{
    size_t key = key_before(c, seconds);
    bool   outside = seconds <= (double)c->times[key] || key + 1 >= c->key_count;
    if (outside || c->interpolation == INTERPOLATION_STEP) {
        hold(c, key, out);
    } else {
        double span = (double)c->times[key + 1] - (double)c->times[key],
               t = span > 0 ? (seconds - (double)c->times[key]) / span : 0;
        if (c->interpolation == INTERPOLATION_CUBIC)
            cubic(c, key, t, span, out);
        else
            linear(c, key, t, out);
    }
    if (c->path == PATH_ROTATION)
        quaternion_normalise(out);
}
