#include "outline_truth.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

#define OUTLINE_STEP 0.02
#define ANY_STEP     0.0012
enum { LINKED = 3 }; /* pixels of the depth map: gaps that close together are one */

typedef struct field {
    const float *depth;
    int          width, height;
    double       range;
} field;

static double at(const field *f, int x, int y)
{
    bool inside = x >= 0 && y >= 0 && x < f->width && y < f->height;
    return inside ? (double)f->depth[(size_t)y * (size_t)f->width + (size_t)x] : INFINITY;
}

/* Does what is at a pixel end there, before something farther behind? */
static bool is_step(const field *f, int x, int y, int dx, int dy, double least, double ratio)
{
    double here = at(f, x, y), next = at(f, x + dx, y + dy);
    if (!isfinite(here) || !(next - here > least * f->range))
        return false;
    if (!isfinite(next))
        return true;
    double before = here - at(f, x - dx, y - dy), after = at(f, x + 2 * dx, y + 2 * dy) - next;
    double slope = fmax(isfinite(before) ? fabs(before) : 0, isfinite(after) ? fabs(after) : 0);
    return next - here > ratio * slope;
}

static bool has_step(const field *f, int x, int y, double least, double ratio)
{
    return is_step(f, x, y, 1, 0, least, ratio) || is_step(f, x, y, -1, 0, least, ratio) ||
           is_step(f, x, y, 0, 1, least, ratio) || is_step(f, x, y, 0, -1, least, ratio);
}

static double find_range(const field *f)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < (size_t)f->width * (size_t)f->height; i++)
        if (isfinite(f->depth[i])) {
            low = fmin(low, (double)f->depth[i]);
            high = fmax(high, (double)f->depth[i]);
        }
    return high - low;
}

static double darkness(const uint8_t *p)
{
    return 1 - (p[0] + p[1] + p[2]) / 765.0;
}

/* Is there ink near a position of the drawing? */
static bool is_inked(const uint8_t *picture, int width, int height, double x, double y)
{
    for (int v = (int)floor(y - 2); v <= (int)floor(y + 2); v++)
        for (int u = (int)floor(x - 2); u <= (int)floor(x + 2); u++)
            if (u >= 0 && v >= 0 && u < width && v < height && hypot(u + 0.5 - x, v + 0.5 - y) <= 1.5 &&
                darkness(picture + 4 * ((size_t)v * (size_t)width + (size_t)u)) > 0.25)
                return true;
    return false;
}

/* How long what hangs together with a bare pixel is. Empties it. */
static double measure_gap(const field *f, uint8_t *bare, size_t start, size_t *stack)
{
    size_t count = 0;
    int    low[2] = {f->width, f->height}, high[2] = {0, 0};
    stack[count++] = start;
    bare[start] = 0;
    while (count > 0) {
        size_t i = stack[--count];
        int    x = (int)(i % (size_t)f->width), y = (int)(i / (size_t)f->width);
        low[0] = x < low[0] ? x : low[0];
        low[1] = y < low[1] ? y : low[1];
        high[0] = x > high[0] ? x : high[0];
        high[1] = y > high[1] ? y : high[1];
        for (int v = y - LINKED; v <= y + LINKED; v++)
            for (int u = x - LINKED; u <= x + LINKED; u++) {
                size_t k = (size_t)v * (size_t)f->width + (size_t)u;
                if (u < 0 || v < 0 || u >= f->width || v >= f->height || !bare[k])
                    continue;
                bare[k] = 0;
                stack[count++] = k;
            }
    }
    return hypot(high[0] - low[0] + 1, high[1] - low[1] + 1);
}

static void measure_outlines(outline_score *out, const field *f, const uint8_t *picture, int width, int height,
                             int finer)
{
    size_t   count = (size_t)f->width * (size_t)f->height;
    uint8_t *bare = check_alloc(count, 1);
    size_t  *stack = check_alloc(count, sizeof *stack);
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++) {
            if (!has_step(f, x, y, OUTLINE_STEP, 3))
                continue;
            bool inked = is_inked(picture, width, height, (x + 0.5) / finer, (y + 0.5) / finer);
            out->length += 1.0 / finer;
            out->covered += inked ? 1.0 / finer : 0;
            bare[(size_t)y * (size_t)f->width + (size_t)x] = !inked;
        }
    for (size_t i = 0; i < count; i++) {
        double gap = bare[i] ? measure_gap(f, bare, i, stack) / finer : 0;
        if (gap > out->longest_gap) {
            out->longest_gap = gap;
            out->gap_at[0] = (double)(i % (size_t)f->width) / finer;
            out->gap_at[1] = (double)(i / (size_t)f->width) / finer;
        }
    }
    free(bare);
    free(stack);
}

/* Pixels of the drawing near any step of depth. */
static uint8_t *mark_steps(const field *f, int width, int height, int finer)
{
    uint8_t *near = check_alloc((size_t)width * (size_t)height, 1);
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++) {
            if (!has_step(f, x, y, ANY_STEP, 2))
                continue;
            for (int v = y / finer - 4; v <= y / finer + 4; v++)
                for (int u = x / finer - 4; u <= x / finer + 4; u++)
                    if (u >= 0 && v >= 0 && u < width && v < height)
                        near[(size_t)v * (size_t)width + (size_t)u] = 1;
        }
    return near;
}

void outline_measure(outline_score *out, const uint8_t *picture, int width, int height, const float *depth, int finer)
{
    field f = {depth, width * finer, height * finer, 0};
    memset(out, 0, sizeof *out);
    f.range = find_range(&f);
    measure_outlines(out, &f, picture, width, height, finer);
    uint8_t *near = mark_steps(&f, width, height, finer);
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
        if (darkness(picture + 4 * i) > 0.5) {
            out->ink++;
            out->stray += !near[i];
            if (!near[i]) {
                out->stray_at[0] = (double)(i % (size_t)width);
                out->stray_at[1] = (double)(i / (size_t)width);
            }
        }
    free(near);
}
