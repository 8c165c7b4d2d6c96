/* A grid of the segments of visible strokes: what crosses what, and where strokes meet, is looked up in it. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/ribbon_private.h"

enum { CELLS_MOST = 1024 };
static const float cell_least = 16; /* on paper */

static bool is_finite_point(const stroke_point *p)
{
    return isfinite(p->x) && isfinite(p->y) && isfinite(p->depth) && isfinite(p->arc);
}

/* First column, first row, last column, last row. */
bool segment_grid_box(const segment_grid *g, const stroke_point *a, const stroke_point *b, float margin, int out[4])
{
    if (!is_finite_point(a) || !is_finite_point(b))
        return false;
    float low[2] = {fminf(a->x, b->x) - margin - g->left, fminf(a->y, b->y) - margin - g->top};
    float high[2] = {fmaxf(a->x, b->x) + margin - g->left, fmaxf(a->y, b->y) + margin - g->top};
    int   most[2] = {g->columns - 1, g->rows - 1};
    for (int k = 0; k < 2; k++) {
        out[k] = (int)fminf(fmaxf(floorf(low[k] / g->cell), 0), (float)most[k]);
        out[2 + k] = (int)fminf(fmaxf(floorf(high[k] / g->cell), 0), (float)most[k]);
    }
    return true;
}

bool segment_grid_meets(const segment_grid *g, const stroke_point *a, const stroke_point *b, float margin, int column,
                        int row)
{
    float x = g->left + ((float)column + 0.5f) * g->cell, y = g->top + ((float)row + 0.5f) * g->cell;
    float dx = b->x - a->x, dy = b->y - a->y, length = hypotf(dx, dy);
    return fabsf(dx * (y - a->y) - dy * (x - a->x)) <= length * (g->cell * 0.7072f + margin);
}

/* Every cell that each visible segment meets: counts them, or stores them where `next` says. */
static void each_visible(segment_grid *g, const ribbon_job *job, uint32_t *counts, uint32_t *next)
{
    const stroke_set *set = job->strokes;
    for (size_t i = 0; i < set->stroke_count; i++) {
        const stroke *s = &set->strokes[i];
        if (s->hidden_by > 0 || !job->drawn[i])
            continue;
        for (uint32_t k = s->first; k + 1 < s->first + s->count; k++) {
            const stroke_point *a = &set->points[k], *b = a + 1;
            int                 cells[4];
            if (!segment_grid_box(g, a, b, 0, cells))
                continue;
            for (int row = cells[1]; row <= cells[3]; row++)
                for (int column = cells[0]; column <= cells[2]; column++) {
                    size_t cell = (size_t)row * (size_t)g->columns + (size_t)column;
                    if (!segment_grid_meets(g, a, b, 1.5f, column, row))
                        continue;
                    if (next)
                        g->items[next[cell]++] = (ribbon_segment){(uint32_t)i, k};
                    else
                        counts[cell + 1]++;
                }
        }
    }
}

static bool lay_out(segment_grid *g, const ribbon_job *job)
{
    const stroke_set *set = job->strokes;
    float             low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < set->point_count; i++) {
        const stroke_point *p = &set->points[i];
        const float         position[3] = {p->x, p->y, p->depth};
        for (int k = 0; k < 3 && is_finite_point(p); k++) {
            low[k] = fminf(low[k], position[k]);
            high[k] = fmaxf(high[k], position[k]);
        }
    }
    if (!(high[0] >= low[0]))
        return false;
    g->depth_range = high[2] - low[2];
    g->left = low[0];
    g->top = low[1];
    g->cell = fmaxf(cell_least, fmaxf(high[0] - low[0], high[1] - low[1]) / CELLS_MOST);
    g->columns = (int)((high[0] - low[0]) / g->cell) + 1;
    g->rows = (int)((high[1] - low[1]) / g->cell) + 1;
    return true;
}

bool segment_grid_build(segment_grid *g, const ribbon_job *job)
{
    *g = (segment_grid){0};
    if (!lay_out(g, job))
        return true;
    size_t cells = (size_t)g->columns * (size_t)g->rows;
    g->starts = mem_calloc(cells + 1, sizeof *g->starts);
    uint32_t *next = mem_calloc(cells + 1, sizeof *next);
    if (g->starts && next) {
        each_visible(g, job, g->starts, NULL);
        for (size_t i = 0; i < cells; i++)
            g->starts[i + 1] += g->starts[i];
        memcpy(next, g->starts, (cells + 1) * sizeof *next);
        g->items = mem_calloc((size_t)g->starts[cells] + 1, sizeof *g->items);
        if (g->items)
            each_visible(g, job, NULL, next);
    }
    mem_free(next);
    return g->items != NULL;
}

void segment_grid_release(segment_grid *g)
{
    mem_free(g->starts);
    mem_free(g->items);
    *g = (segment_grid){0};
}
