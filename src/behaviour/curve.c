/* Curves through space (or any other values): cubic Bézier pieces, and Catmull and Rom's (1974), uniform. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "behaviour/map.h"

size_t curve_pieces(const behaviour_map *m)
{
    if (m->curve == CURVE_BEZIER)
        return (m->value_count - 1) / 3;
    return m->closed ? m->value_count : m->value_count - 1;
}

/* Point i of a Catmull-Rom curve; beyond its ends the points go on straight, unless it is closed. */
static double through(const behaviour_map *m, ptrdiff_t i, size_t k)
{
    ptrdiff_t     count = (ptrdiff_t)m->value_count;
    size_t        n = m->components;
    const double *v = m->values;
    if (m->closed)
        return v[(size_t)((i + count) % count) * n + k];
    if (i < 0)
        return 2 * v[k] - v[n + k];
    if (i >= count)
        return 2 * v[(size_t)(count - 1) * n + k] - v[(size_t)(count - 2) * n + k];
    return v[(size_t)i * n + k];
}

void curve_at(const behaviour_map *m, double parameter, double *out, double *derivative)
{
    size_t pieces = curve_pieces(m);
    double at = fmin(fmax(parameter, 0), 1) * (double)pieces;
    size_t piece = at >= (double)pieces ? pieces - 1 : (size_t)at;
    double t = at - (double)piece, s = 1 - t;
    for (size_t k = 0; k < m->components; k++) {
        double p[4];
        if (m->curve == CURVE_BEZIER) {
            for (size_t i = 0; i < 4; i++)
                p[i] = m->values[(3 * piece + i) * m->components + k];
        } else {
            double a = through(m, (ptrdiff_t)piece - 1, k), b = through(m, (ptrdiff_t)piece, k),
                   c = through(m, (ptrdiff_t)piece + 1, k), d = through(m, (ptrdiff_t)piece + 2, k);
            p[0] = b, p[1] = b + (c - a) / 6, p[2] = c - (d - b) / 6, p[3] = c;
        }
        if (out)
            out[k] = s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3];
        if (derivative)
            derivative[k] =
                3 * (double)pieces * (s * s * (p[1] - p[0]) + 2 * s * t * (p[2] - p[1]) + t * t * (p[3] - p[2]));
    }
}

static double speed_at(const behaviour_map *m, double parameter, double *derivative)
{
    double square = 0;
    curve_at(m, parameter, NULL, derivative);
    for (size_t k = 0; k < m->components; k++)
        square += derivative[k] * derivative[k];
    return sqrt(square);
}

/* Steps a piece: Gauss's rule of two points on each is exact to about 1e-9 of a smooth piece's length. */
enum { STEPS_A_PIECE = 64, CURVE_COMPONENTS_MAX = 4 };

static double length_between(const behaviour_map *m, double from, double to)
{
    const double apart = 0.28867513459481287; /* 1/(2√3) */
    double       derivative[CURVE_COMPONENTS_MAX], middle = (from + to) / 2, step = to - from;
    return step / 2 * (speed_at(m, middle - apart * step, derivative) + speed_at(m, middle + apart * step, derivative));
}

bool curve_measure(curve_table *out, const behaviour_map *m)
{
    size_t count = curve_pieces(m) * STEPS_A_PIECE;
    out->lengths = mem_calloc(count + 1, sizeof *out->lengths);
    out->count = count;
    for (size_t i = 0; out->lengths && i < count; i++)
        out->lengths[i + 1] =
            out->lengths[i] + length_between(m, (double)i / (double)count, (double)(i + 1) / (double)count);
    return out->lengths;
}

double curve_parameter(const curve_table *table, const behaviour_map *m, double share)
{
    double wanted = fmin(fmax(share, 0), 1) * table->lengths[table->count];
    size_t low = 0, high = table->count;
    if (!(table->lengths[table->count] > 0))
        return share;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        *(table->lengths[middle] <= wanted ? &low : &high) = middle;
    }
    double span = table->lengths[low + 1] - table->lengths[low], step = 1 / (double)table->count;
    double left = wanted - table->lengths[low], begin = (double)low * step;
    double at = begin + step * (span > 0 ? fmin(left / span, 1) : 0);
    for (int i = 0; i < 4 && span > 0; i++) { /* Newton's steps, within the one of the table */
        double derivative[CURVE_COMPONENTS_MAX], speed = speed_at(m, at, derivative);
        if (!(speed > 1e-9 * span / step))
            break;
        at = fmin(fmax(at - (length_between(m, begin, at) - left) / speed, begin), begin + step);
    }
    return at;
}
