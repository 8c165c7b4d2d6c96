/* Halos: lines stop short of visible lines that pass in front of them. Crossings are found in a grid of the visible
 * strokes' segments. A stroke that ends at what hides it touches that line and no more, so its ends are looked for
 * a little beyond. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/ribbon_private.h"

enum { CELLS_MOST = 1024 };
static const float cell_least = 16;        /* pixels */
static const float beyond = 1.5f;          /* how far beyond its ends a stroke is looked for crossings, pixels */
static const float depth_fraction = 1e-3f; /* what is nearer than this fraction of all depths is at the same position */
static const float flattest = 0.25f;       /* sine of the angle between two lines below which a gap grows no longer */

typedef struct segment {
    uint32_t stroke, point;
} segment;

typedef struct segment_grid {
    float     left, top, cell;
    int       columns, rows;
    uint32_t *starts; /* of each cell in `items`, one more at the end */
    segment  *items;
} segment_grid;

typedef struct halo_search {
    const ribbon_job *job;
    segment_grid      grid;
    float             depth_gap;
    gap_list         *out;
} halo_search;

static bool is_finite_point(const stroke_point *p)
{
    return isfinite(p->x) && isfinite(p->y) && isfinite(p->depth) && isfinite(p->arc);
}

/* The cells that a segment's box covers: first column, first row, last column, last row. */
static void cells_of(const segment_grid *g, const stroke_point *a, const stroke_point *b, float margin, int out[4])
{
    float low[2] = {fminf(a->x, b->x) - margin - g->left, fminf(a->y, b->y) - margin - g->top};
    float high[2] = {fmaxf(a->x, b->x) + margin - g->left, fmaxf(a->y, b->y) + margin - g->top};
    int   most[2] = {g->columns - 1, g->rows - 1};
    for (int k = 0; k < 2; k++) {
        out[k] = (int)fminf(fmaxf(floorf(low[k] / g->cell), 0), (float)most[k]);
        out[2 + k] = (int)fminf(fmaxf(floorf(high[k] / g->cell), 0), (float)most[k]);
    }
}

/* Long segments cover many cells of their box that they do not cross: a cell counts when its circle meets the line. */
static bool meets_cell(const segment_grid *g, const stroke_point *a, const stroke_point *b, int column, int row)
{
    float x = g->left + ((float)column + 0.5f) * g->cell, y = g->top + ((float)row + 0.5f) * g->cell;
    float dx = b->x - a->x, dy = b->y - a->y, length = hypotf(dx, dy);
    return fabsf(dx * (y - a->y) - dy * (x - a->x)) <= length * (g->cell * 0.7072f + beyond);
}

typedef void (*segment_fn)(halo_search *h, size_t cell, segment s, uint32_t *counts);

static void count_segment(halo_search *h, size_t cell, segment s, uint32_t *counts)
{
    (void)h, (void)s;
    counts[cell + 1]++;
}

static void store_segment(halo_search *h, size_t cell, segment s, uint32_t *counts)
{
    h->grid.items[counts[cell]++] = s;
}

/* Calls `fn` for each cell that each visible segment meets. */
static void each_visible(halo_search *h, segment_fn fn, uint32_t *counts)
{
    const stroke_set *set = h->job->strokes;
    for (size_t i = 0; i < set->stroke_count; i++) {
        const stroke *s = &set->strokes[i];
        if (s->hidden_by > 0 || !h->job->drawn[i])
            continue;
        for (uint32_t k = s->first; k + 1 < s->first + s->count; k++) {
            const stroke_point *a = &set->points[k], *b = a + 1;
            int                 cells[4];
            if (!is_finite_point(a) || !is_finite_point(b))
                continue;
            cells_of(&h->grid, a, b, 0, cells);
            for (int row = cells[1]; row <= cells[3]; row++)
                for (int column = cells[0]; column <= cells[2]; column++)
                    if (meets_cell(&h->grid, a, b, column, row))
                        fn(h, (size_t)row * (size_t)h->grid.columns + (size_t)column, (segment){(uint32_t)i, k},
                           counts);
        }
    }
}

/* Lays the grid out over all points; false when there is nothing in it or memory is gone. */
static bool build_grid(halo_search *h)
{
    const stroke_set *set = h->job->strokes;
    segment_grid     *g = &h->grid;
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
    h->depth_gap = depth_fraction * (high[2] - low[2]);
    g->left = low[0];
    g->top = low[1];
    g->cell = fmaxf(cell_least, fmaxf(high[0] - low[0], high[1] - low[1]) / CELLS_MOST);
    g->columns = (int)((high[0] - low[0]) / g->cell) + 1;
    g->rows = (int)((high[1] - low[1]) / g->cell) + 1;
    size_t cells = (size_t)g->columns * (size_t)g->rows;
    g->starts = mem_calloc(cells + 1, sizeof *g->starts);
    uint32_t *next = mem_calloc(cells + 1, sizeof *next);
    if (g->starts && next) {
        each_visible(h, count_segment, g->starts);
        for (size_t i = 0; i < cells; i++)
            g->starts[i + 1] += g->starts[i];
        memcpy(next, g->starts, (cells + 1) * sizeof *next);
        g->items = mem_calloc(g->starts[cells], sizeof *g->items);
        if (g->items)
            each_visible(h, store_segment, next);
    }
    mem_free(next);
    h->out->failed = h->out->failed || !g->items;
    return g->items != NULL;
}

/* One segment against one visible one in front of it. */
static void cross(halo_search *h, uint32_t own, const stroke_point *a, const stroke_point *b, bool first, bool last,
                  segment front)
{
    const stroke_set   *set = h->job->strokes;
    const stroke_point *c = &set->points[front.point], *d = c + 1;
    float               ux = b->x - a->x, uy = b->y - a->y, vx = d->x - c->x, vy = d->y - c->y;
    float               length = hypotf(ux, uy), across = hypotf(vx, vy), area = ux * vy - uy * vx;
    if (front.stroke == own || !(length > 0) || !(across > 0) || fabsf(area) < 1e-3f * length * across)
        return;
    float t = ((c->x - a->x) * vy - (c->y - a->y) * vx) / area, u = ((c->x - a->x) * uy - (c->y - a->y) * ux) / area;
    float reach = beyond / length, own_reach = beyond / across;
    if (t < (first ? -reach : 0) || t > (last ? 1 + reach : 1) || u < -own_reach || u > 1 + own_reach)
        return;
    float fraction = fminf(fmaxf(t, 0), 1), front_fraction = fminf(fmaxf(u, 0), 1);
    float depth = ribbon_depth_between(h->job, a->depth, b->depth, fraction),
          nearer = ribbon_depth_between(h->job, c->depth, d->depth, front_fraction);
    if (!(nearer < depth - h->depth_gap))
        return;
    float sine = fmaxf(fabsf(area) / (length * across), flattest);
    float half = (h->job->style->halo + ribbon_width(h->job, &set->strokes[front.stroke]) / 2) / sine;
    float arc = a->arc + t * (b->arc - a->arc);
    gap_list_add(h->out, own, arc - half, arc + half);
}

static void search_segment(halo_search *h, uint32_t own, uint32_t point)
{
    const stroke_set   *set = h->job->strokes;
    const stroke       *s = &set->strokes[own];
    const stroke_point *a = &set->points[point], *b = a + 1;
    int                 cells[4];
    bool                first = point == s->first, last = point + 2 == s->first + s->count;
    if (!is_finite_point(a) || !is_finite_point(b))
        return;
    cells_of(&h->grid, a, b, beyond, cells);
    for (int row = cells[1]; row <= cells[3]; row++)
        for (int column = cells[0]; column <= cells[2]; column++) {
            size_t cell = (size_t)row * (size_t)h->grid.columns + (size_t)column;
            if (h->grid.starts[cell] == h->grid.starts[cell + 1] || !meets_cell(&h->grid, a, b, column, row))
                continue;
            for (uint32_t i = h->grid.starts[cell]; i < h->grid.starts[cell + 1]; i++)
                cross(h, own, a, b, first, last, h->grid.items[i]);
        }
}

void ribbon_find_halos(gap_list *out, const ribbon_job *job)
{
    halo_search h = {.job = job, .out = out};
    if (job->style->halo > 0 && build_grid(&h))
        for (size_t i = 0; i < job->strokes->stroke_count && !out->failed; i++)
            for (uint32_t k = 0; job->drawn[i] && k + 1 < job->strokes->strokes[i].count; k++)
                search_segment(&h, (uint32_t)i, job->strokes->strokes[i].first + k);
    mem_free(h.grid.starts);
    mem_free(h.grid.items);
}
