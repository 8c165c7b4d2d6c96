#include "stroke/curve.h"

void curve_refine(double *out, const double *points, size_t count, size_t width, bool closed)
{
    for (size_t i = 0; i < count; i++) {
        size_t next = i + 1 < count ? i + 1 : closed ? 0 : i;
        size_t before = i > 0 ? i - 1 : closed ? count - 1 : i;
        size_t after = next + 1 < count ? next + 1 : closed ? 0 : next;
        bool   has_middle = closed || i + 1 < count;
        for (size_t k = 0; k < width; k++) {
            double p = points[i * width + k];
            out[2 * i * width + k] = p;
            if (has_middle)
                out[(2 * i + 1) * width + k] = 9.0 / 16 * (p + points[next * width + k]) -
                                               1.0 / 16 * (points[before * width + k] + points[after * width + k]);
        }
    }
}
