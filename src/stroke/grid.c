/* Triangles sorted into cells of the page. One size of cells would either hold crowds of small triangles or be filled over and over by large ones, so there are several
 * levels, each twice as coarse as the one below; a triangle lies in the finest one in which it spans few cells. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Cells that a box touches: first and last column and row. */
typedef struct cell_range {
    int32_t c0, r0, c1, r1;
} cell_range;

static int32_t cell_of(int32_t at, int32_t low, int32_t cell, int32_t count)
{
    int64_t offset = (int64_t)at - low;
    if (offset < 0)
        return -1;
    int64_t number = offset / cell;
    return number < count ? (int32_t)number : count;
}

/* False when the box lies outside the grid. */
static bool range_of(const window_grid *g, const grid_level *l, int32_t low_x, int32_t low_y, int32_t high_x, int32_t high_y, cell_range *out)
{
    out->c0 = cell_of(low_x, g->low_x, l->cell, l->columns);
    out->r0 = cell_of(low_y, g->low_y, l->cell, l->rows);
    out->c1 = cell_of(high_x, g->low_x, l->cell, l->columns);
    out->r1 = cell_of(high_y, g->low_y, l->cell, l->rows);
    if (out->c1 < 0 || out->r1 < 0 || out->c0 >= l->columns || out->r0 >= l->rows)
        return false;
    out->c0 = out->c0 < 0 ? 0 : out->c0;
    out->r0 = out->r0 < 0 ? 0 : out->r0;
    out->c1 = out->c1 < l->columns ? out->c1 : l->columns - 1;
    out->r1 = out->r1 < l->rows ? out->r1 : l->rows - 1;
    return true;
}

static int level_of(const window_grid *g, const window_box *box)
{
    int64_t width = (int64_t)box->high_x - box->low_x, height = (int64_t)box->high_y - box->low_y, side = width > height ? width : height;
    int level = 0;
    while (level + 1 < GRID_LEVELS && side > (int64_t)GRID_SPAN * g->levels[level].cell)
        level++;
    return level;
}

/* Lines a·x + b·y + c that are above 0 inside the triangle. */
typedef struct inside_test {
    double a[3], b[3], c[3];
} inside_test;

static inside_test test_of(const stroke_view *v, const window_triangle *t)
{
    inside_test out;
    window_point p[3] = {v->points[t->v[0]], v->points[t->v[1]], v->points[t->v[2]]};
    double sign = window_side(p[0], p[1], p[2]) < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++) {
        window_point from = p[k], to = p[k == 2 ? 0 : k + 1];
        out.a[k] = sign * ((double)from.y - to.y);
        out.b[k] = sign * ((double)to.x - from.x);
        out.c[k] = -(out.a[k] * from.x + out.b[k] * from.y);
    }
    return out;
}

/* May the triangle touch the cell? The corner that lies deepest inside decides, for each side. */
static bool touches(const window_grid *g, const grid_level *l, const inside_test *t, int32_t column, int32_t row)
{
    double x = (double)g->low_x + (double)column * l->cell, y = (double)g->low_y + (double)row * l->cell;
    for (int k = 0; k < 3; k++)
        if (t->a[k] * (t->a[k] > 0 ? x + l->cell : x) + t->b[k] * (t->b[k] > 0 ? y + l->cell : y) + t->c[k] < 0)
            return false;
    return true;
}

/* Counts a triangle into its cells (fill: puts it there; starts have been counted). */
static void enter(window_grid *g, const stroke_view *v, uint32_t number, bool fill)
{
    const window_box *box = &v->boxes[number];
    grid_level *l = &g->levels[level_of(g, box)];
    cell_range range;
    if (!range_of(g, l, box->low_x, box->low_y, box->high_x, box->high_y, &range))
        return;
    bool few = range.c0 == range.c1 || range.r0 == range.r1;
    inside_test test = {{0}, {0}, {0}};
    if (!few)
        test = test_of(v, &v->triangles[number]);
    for (int32_t r = range.r0; r <= range.r1; r++)
        for (int32_t c = range.c0; c <= range.c1; c++) {
            if (!few && !touches(g, l, &test, c, r))
                continue;
            uint32_t *start = &l->starts[(size_t)r * (size_t)l->columns + (size_t)c];
            if (fill)
                g->entries[start[1]++] = number;
            else
                start[2]++;
        }
}

static bool make_levels(window_grid *g, const stroke_view *v)
{
    double width = v->camera.width * v->units, height = v->camera.height * v->units;
    double wanted = sqrt(width * height / ((double)v->triangle_count / 3 + 256));
    double finest = fmax(width, height) / 1024;
    int32_t cell = (int32_t)fmax(fmax(wanted, finest), 16);
    g->low_x = (int32_t)(-width / 2);
    g->low_y = (int32_t)(-height / 2);
    for (int k = 0; k < GRID_LEVELS; k++) {
        grid_level *l = &g->levels[k];
        l->cell = cell;
        l->columns = (int32_t)(width / cell) + 1;
        l->rows = (int32_t)(height / cell) + 1;
        l->starts = mem_calloc((size_t)l->columns * (size_t)l->rows + 2, sizeof *l->starts);
        if (!l->starts)
            return false;
        cell = cell > INT32_MAX / 4 ? cell : cell * 2;
    }
    return true;
}

lmn_status grid_build(window_grid *out, const stroke_view *v, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    if (!make_levels(out, v))
        return error_memory(error);
    for (uint32_t i = 0; i < v->triangle_count; i++)
        enter(out, v, i, false);
    uint32_t total = 0;
    for (int k = 0; k < GRID_LEVELS; k++) { /* each count becomes where the cell's entries begin, one place on: filling moves it to its end */
        grid_level *l = &out->levels[k];
        size_t cells = (size_t)l->columns * (size_t)l->rows;
        l->starts[0] = l->starts[1] = total;
        for (size_t c = 0; c < cells; c++) {
            uint32_t count = l->starts[c + 2];
            if (c + 1 < cells)
                l->starts[c + 2] = total + count;
            total += count;
        }
        l->starts[cells + 1] = total;
    }
    out->entries = mem_alloc(((size_t)total + 1) * sizeof *out->entries);
    if (!out->entries)
        return error_memory(error);
    for (uint32_t i = 0; i < v->triangle_count; i++)
        enter(out, v, i, true);
    return LMN_OK;
}

void grid_release(window_grid *g)
{
    for (int k = 0; k < GRID_LEVELS; k++)
        mem_free(g->levels[k].starts);
    mem_free(g->entries);
    memset(g, 0, sizeof *g);
}

/* --- walking ------------------------------------------------------------------------------------------------------- */

/* The columns of a row that a segment touches; the segment goes down or is level (a.y ≤ b.y). */
static void columns_of(const window_grid *g, const grid_level *l, window_point a, window_point b, int32_t row, cell_range *range)
{
    double top = (double)g->low_y + (double)row * l->cell, bottom = top + l->cell, height = (double)b.y - a.y, width = (double)b.x - a.x;
    double from = a.x, to = b.x;
    if (a.y < top)
        from = a.x + width * ((top - a.y) / height);
    if (b.y > bottom)
        to = a.x + width * ((bottom - a.y) / height);
    double low = (from < to ? from : to) - 1, high = (from < to ? to : from) + 1;
    int32_t c0 = cell_of((int32_t)low, g->low_x, l->cell, l->columns), c1 = cell_of((int32_t)high, g->low_x, l->cell, l->columns);
    range->c0 = c0 < 0 ? 0 : c0;
    range->c1 = c1 < l->columns ? c1 : l->columns - 1;
}

void grid_walk(const window_grid *g, window_point a, window_point b, grid_visit visit, void *user)
{
    if (a.y > b.y) {
        window_point other = a;
        a = b;
        b = other;
    }
    int32_t low_x = a.x < b.x ? a.x : b.x, high_x = a.x < b.x ? b.x : a.x;
    for (int k = 0; k < GRID_LEVELS; k++) {
        const grid_level *l = &g->levels[k];
        size_t cells = (size_t)l->columns * (size_t)l->rows;
        cell_range range;
        if (l->starts[cells] == l->starts[0] || !range_of(g, l, low_x, a.y, high_x, b.y, &range))
            continue;
        bool alone = range.c0 == range.c1 && range.r0 == range.r1;
        for (int32_t r = range.r0; r <= range.r1; r++) {
            cell_range row = range;
            if (range.r0 != range.r1 && range.c0 != range.c1)
                columns_of(g, l, a, b, r, &row);
            for (int32_t c = row.c0; c <= row.c1; c++) {
                const uint32_t *start = &l->starts[(size_t)r * (size_t)l->columns + (size_t)c];
                if (start[1] > start[0])
                    visit(user, g->entries + start[0], start[1] - start[0], alone);
            }
        }
    }
}
