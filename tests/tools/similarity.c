/* How alike the same drawing is at several sizes: `similarity SMALL.png LARGE.png …`. Each large picture is reduced to
 * the small one's size, by the mean of its encoded values, and compared with it by structural similarity over windows
 * of 7 × 7 pixels; those that are flat in both are not counted. Prints a line for each. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture.h"

enum { WINDOW = 7 };

typedef struct grey {
    int     width, height;
    double *values; /* encoded, 0 … 255, over white */
} grey;

static bool grey_read(grey *out, const char *path)
{
    uint8_t *rgba = picture_read_rgba(path, &out->width, &out->height);
    size_t   count = rgba ? (size_t)out->width * (size_t)out->height : 0;
    out->values = count ? malloc(count * sizeof *out->values) : NULL;
    for (size_t i = 0; i < count && out->values; i++) {
        const uint8_t *p = &rgba[4 * i];
        double         luma = 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2], alpha = p[3] / 255.0;
        out->values[i] = luma * alpha + 255 * (1 - alpha);
    }
    free(rgba);
    if (!out->values)
        fprintf(stderr, "%s: cannot be read\n", path);
    return out->values != NULL;
}

/* The mean of the pixels of `g` that lie over one of a picture `times` smaller. */
static double reduced_at(const grey *g, int x, int y, int times)
{
    double sum = 0;
    for (int v = 0; v < times; v++)
        for (int u = 0; u < times; u++)
            sum += g->values[(size_t)(y * times + v) * (size_t)g->width + (size_t)(x * times + u)];
    return sum / (times * times);
}

/* Of one window; NAN where both are flat. */
static double window_similarity(const grey *small, const double *other, int x, int y)
{
    const double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255, count = WINDOW * WINDOW;
    double       a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (int v = 0; v < WINDOW; v++)
        for (int u = 0; u < WINDOW; u++) {
            size_t i = (size_t)(y + v) * (size_t)small->width + (size_t)(x + u);
            double p = small->values[i], q = other[i];
            a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
        }
    a /= count, b /= count;
    double va = aa / count - a * a, vb = bb / count - b * b, cov = ab / count - a * b;
    if (va < 1 && vb < 1)
        return NAN;
    return (2 * a * b + c1) * (2 * cov + c2) / ((a * a + b * b + c1) * (va + vb + c2));
}

static bool compare(const grey *small, const char *path)
{
    grey large = {0};
    if (!grey_read(&large, path))
        return false;
    int    times = large.width / small->width, windows = 0;
    bool   fits = times >= 1 && large.width == times * small->width && large.height == times * small->height;
    double sum = 0, *other = malloc((size_t)small->width * (size_t)small->height * sizeof *other);
    for (int y = 0; y < small->height && fits && other; y++)
        for (int x = 0; x < small->width; x++)
            other[(size_t)y * (size_t)small->width + (size_t)x] = reduced_at(&large, x, y, times);
    for (int y = 0; y + WINDOW <= small->height && fits && other; y++)
        for (int x = 0; x + WINDOW <= small->width; x++) {
            double s = window_similarity(small, other, x, y);
            sum += isnan(s) ? 0 : s;
            windows += !isnan(s);
        }
    if (fits)
        printf("%.4f %s (%d windows)\n", windows ? sum / windows : 1, path, windows);
    else
        fprintf(stderr, "%s: not a whole multiple of the first picture's size\n", path);
    free(other);
    free(large.values);
    return fits;
}

int main(int argc, char **argv)
{
    grey small = {0};
    bool good = argc > 2 && grey_read(&small, argv[1]);
    if (argc <= 2)
        fprintf(stderr, "usage: similarity SMALL.png LARGE.png …\n");
    for (int i = 2; i < argc && good; i++)
        good = compare(&small, argv[i]);
    free(small.values);
    return !good;
}
