/* Triangles sorted into cells of the page. One size of cells would either hold crowds of small triangles or be
 * filled over and over by large ones, so there are several levels, each twice as coarse as the one below; a
 * triangle lies in the finest one in which it spans few cells. Where small triangles crowd all the same, a cell has
 * a finer grid of its own. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/threads.h"

/* A cell with more triangles than this gets a finer grid with about so many a cell. */
enum { CROWD = 256, FEW = 8, SUB_SIDE_MAX = 24 };
/* Its cells are divided in turn unless its triangles are so large that they lie in more of them, on average, or in more
 * than so many all in all: where surfaces lie one behind the other, cells stay crowded however fine they are. */
enum { SPLIT_MOST = 3, COPIES_MOST = 8 };
/* A finer grid is kept if its cells have so many times fewer triangles, on average: those that are larger than the cell
 * would be in all of them. */
enum { EMPTIER = 4 };

/* Cells that a box touches: first and last column and row. */
typedef struct cell_range {
    int32_t c0, r0, c1, r1;
} cell_range;

/* The quotient as a product, half a unit from where rounding could change it: four divisions a triangle are much of
 * what a grid takes. */
static int32_t cell_of(int32_t at, int32_t low, double cells, int32_t count)
{
    int32_t offset = at - low; /* window coordinates are far from the limits of 32 bits */
    if (offset < 0)
        return -1;
    int32_t number = (int32_t)((offset + 0.5) * cells);
    return number < count ? number : count;
}

/* False when the box lies outside the grid. */
static bool range_of(const grid_level *l, int32_t low_x, int32_t low_y, int32_t high_x, int32_t high_y, cell_range *out)
{
    out->c0 = cell_of(low_x, l->low_x, l->cells, l->columns);
    out->r0 = cell_of(low_y, l->low_y, l->cells, l->rows);
    out->c1 = cell_of(high_x, l->low_x, l->cells, l->columns);
    out->r1 = cell_of(high_y, l->low_y, l->cells, l->rows);
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
    int32_t width = box->high_x - box->low_x, height = box->high_y - box->low_y, side = width > height ? width : height;
    int     level = 0;
    while (level + 1 < GRID_LEVELS && side > GRID_SPAN * g->levels[level].cell)
        level++;
    return level;
}

/* Lines a·x + b·y + c that are above 0 inside the triangle. */
typedef struct inside_test {
    double a[3], b[3], c[3];
} inside_test;

static inside_test test_of(const stroke_view *v, const window_triangle *t)
{
    inside_test  out;
    window_point p[3] = {v->points[t->v[0]], v->points[t->v[1]], v->points[t->v[2]]};
    double       sign = window_side(p[0], p[1], p[2]) < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++) {
        window_point from = p[k], to = p[k == 2 ? 0 : k + 1];
        out.a[k] = sign * ((double)from.y - to.y);
        out.b[k] = sign * ((double)to.x - from.x);
        out.c[k] = -(out.a[k] * from.x + out.b[k] * from.y);
    }
    return out;
}

/* May the triangle touch the cell? The corner that lies deepest inside decides, for each side. */
static bool touches(const grid_level *l, const inside_test *t, int32_t column, int32_t row)
{
    double x = (double)l->low_x + (double)column * l->cell, y = (double)l->low_y + (double)row * l->cell;
    for (int k = 0; k < 3; k++)
        if (t->a[k] * (t->a[k] > 0 ? x + l->cell : x) + t->b[k] * (t->b[k] > 0 ? y + l->cell : y) + t->c[k] < 0)
            return false;
    return true;
}

/* Counts a triangle into its cells; with entries, puts it there: `slots`, one a cell, say where then. */
static void enter(const grid_level *l, const stroke_view *v, uint32_t number, uint32_t *slots, uint32_t *entries)
{
    const window_box *box = &v->boxes[number];
    cell_range        range;
    if (!range_of(l, box->low_x, box->low_y, box->high_x, box->high_y, &range))
        return;
    bool        few = range.c0 == range.c1 || range.r0 == range.r1;
    inside_test test = {{0}, {0}, {0}};
    if (!few)
        test = test_of(v, &v->triangles[number]);
    for (int32_t r = range.r0; r <= range.r1; r++)
        for (int32_t c = range.c0; c <= range.c1; c++) {
            if (!few && !touches(l, &test, c, r))
                continue;
            uint32_t *slot = &slots[(size_t)r * (size_t)l->columns + (size_t)c];
            if (entries)
                entries[*slot] = number;
            ++*slot;
        }
}

/* Makes each count where the cell's entries begin, one position on: filling moves it to their end. Returns where those
 * of the next grid begin. */
static uint32_t add_up(const grid_level *l, uint32_t total)
{
    size_t cells = (size_t)l->columns * (size_t)l->rows;
    l->starts[0] = l->starts[1] = total;
    for (size_t c = 0; c < cells; c++) {
        uint32_t count = l->starts[c + 2];
        if (c + 1 < cells)
            l->starts[c + 2] = total + count;
        total += count;
    }
    l->starts[cells + 1] = total;
    return total;
}

static bool make_levels(window_grid *g, const stroke_view *v)
{
    double  width = v->camera.width * v->units, height = v->camera.height * v->units;
    double  wanted = sqrt(width * height / ((double)v->triangle_count / 2 + 256)), finest = fmax(width, height) / 1024;
    int32_t cell = (int32_t)fmax(fmax(1.5 * wanted, finest), 64);
    for (int k = 0; k < GRID_LEVELS; k++) {
        grid_level *l = &g->levels[k];
        *l = (grid_level){(int32_t)(-width / 2),
                          (int32_t)(-height / 2),
                          1.0 / cell,
                          cell,
                          (int32_t)(width / cell) + 1,
                          (int32_t)(height / cell) + 1,
                          NULL,
                          NULL,
                          1,
                          false};
        l->starts = mem_calloc((size_t)l->columns * (size_t)l->rows + 2, sizeof *l->starts);
        if (!l->starts)
            return false;
        cell = cell > INT32_MAX / 64 ? cell : cell * 2;
    }
    return true;
}

typedef struct plane_entry {
    uint32_t wheel, plane, entry;
} plane_entry;

static int compare_planes(const void *a, const void *b)
{
    const plane_entry *p = a, *q = b;
    if (p->wheel != q->wheel)
        return p->wheel < q->wheel ? -1 : 1;
    return p->plane != q->plane ? (p->plane < q->plane ? -1 : 1) : (p->entry > q->entry) - (p->entry < q->entry);
}

/* Sorts the entries of cells that are a crowd by their wheels, and by the planes in which they lie. */
static bool sort_crowds(const window_grid *g, const stroke_view *v, const uint32_t *starts, size_t cells,
                        uint32_t *entries)
{
    plane_entry *keys = NULL;
    size_t       capacity = 0;
    bool         good = true;
    for (size_t c = 0; c < cells && (v->planes || g->wheels.of_triangles) && good; c++) {
        size_t count = starts[c + 1] - starts[c];
        if (count <= GRID_CROWD)
            continue;
        good = mem_grow((void **)&keys, &capacity, count, sizeof *keys);
        for (size_t i = 0; i < count && good; i++) {
            uint32_t entry = entries[starts[c] + i];
            keys[i] = (plane_entry){g->wheels.of_triangles ? g->wheels.of_triangles[entry] : 0,
                                    v->planes ? v->planes[v->triangles[entry].face] : 0, entry};
        }
        if (good)
            qsort(keys, count, sizeof *keys, compare_planes);
        for (size_t i = 0; i < count && good; i++)
            entries[starts[c] + i] = keys[i].entry;
    }
    mem_free(keys);
    return good;
}

/* Room for a finer grid of so many cells; where its numbers begin. */
static bool open_sub(window_grid *g, size_t cells)
{
    size_t more = g->sub_start_count + cells + 2;
    return mem_grow((void **)&g->subs, &g->sub_capacity, g->sub_count + 1, sizeof *g->subs) &&
           mem_grow((void **)&g->sub_starts, &g->sub_start_capacity, more, sizeof *g->sub_starts) &&
           mem_grow((void **)&g->sub_links, &g->sub_link_capacity, more, sizeof *g->sub_links);
}

/* A finer grid for the triangles of a crowded cell, which are entries of the grid or of finer ones. Where its numbers
 * are is said when all are made. *link: its number + 1; 0: there is none, as its cells would be hardly less crowded.
 * False when memory is gone. */
static bool divide_cell(window_grid *g, const stroke_view *v, const grid_level *l, size_t number, bool nested,
                        uint32_t *link)
{
    uint32_t begin = l->starts[number], count = l->starts[number + 1] - begin;
    int32_t  column = (int32_t)(number % (size_t)l->columns), row = (int32_t)(number / (size_t)l->columns),
            side = (int32_t)sqrt((double)count / FEW);
    side = side < SUB_SIDE_MAX ? side : SUB_SIDE_MAX;
    size_t     cells = (size_t)side * (size_t)side;
    int32_t    cell = (l->cell + side - 1) / side;
    grid_level sub = {
        l->low_x + column * l->cell, l->low_y + row * l->cell, 1.0 / cell, cell, side, side, NULL, NULL, false};
    *link = 0;
    if (!open_sub(g, cells)) /* of nested ones, l's own numbers may have moved */
        return false;
    sub.starts = g->sub_starts + g->sub_start_count;
    memset(sub.starts, 0, (cells + 2) * sizeof *sub.starts);
    memset(g->sub_links + g->sub_start_count, 0, (cells + 2) * sizeof *g->sub_links);
    for (uint32_t i = 0; i < count; i++)
        enter(&sub, v, (nested ? g->sub_entries : g->entries)[begin + i], sub.starts + 2, NULL);
    uint32_t total = add_up(&sub, (uint32_t)g->sub_entry_count);
    size_t   own = total - g->sub_entry_count;
    if (own * EMPTIER > (size_t)count * cells)
        return true;
    if (!mem_grow((void **)&g->sub_entries, &g->sub_entry_capacity, (size_t)total + 1, sizeof *g->sub_entries))
        return false;
    for (uint32_t i = 0; i < count; i++)
        enter(&sub, v, (nested ? g->sub_entries : g->entries)[begin + i], sub.starts + 1, g->sub_entries);
    sub.copies = l->copies * (float)own / (float)count;
    sub.divisible = own <= (size_t)SPLIT_MOST * count && sub.copies <= COPIES_MOST;
    g->sub_entry_count = total;
    g->sub_start_count += cells + 2;
    if (!sort_crowds(g, v, sub.starts, cells, g->sub_entries))
        return false;
    sub.starts = NULL;
    g->subs[g->sub_count++] = sub;
    *link = (uint32_t)g->sub_count;
    return true;
}

static bool is_crowd(const grid_level *l, size_t number)
{
    return l->starts[number + 1] - l->starts[number] > CROWD && l->cell > SUB_SIDE_MAX;
}

/* Finer grids for cells of finer grids: what lies in one pixel may be as rich as the rest of the page. */
static bool divide_subs(window_grid *g, const stroke_view *v)
{
    size_t at = 0;
    for (size_t i = 0; i < g->sub_count; i++) {
        size_t cells = (size_t)g->subs[i].columns * (size_t)g->subs[i].rows;
        for (size_t c = 0; c < cells && g->subs[i].divisible; c++) {
            grid_level l = g->subs[i];
            l.starts = g->sub_starts + at;
            uint32_t link = 0;
            if (is_crowd(&l, c) && !divide_cell(g, v, &l, c, true, &link))
                return false;
            g->sub_links[at + c] = link;
        }
        at += cells + 2;
    }
    return true;
}

static bool divide_crowds(window_grid *g, const stroke_view *v)
{
    for (int k = 0; k < GRID_LEVELS; k++) {
        grid_level *l = &g->levels[k];
        size_t      cells = (size_t)l->columns * (size_t)l->rows;
        if (l->starts[cells] == l->starts[0])
            continue;
        if (!sort_crowds(g, v, l->starts, cells, g->entries))
            return false;
        l->subs = mem_calloc(cells, sizeof *l->subs);
        if (!l->subs)
            return false;
        for (size_t c = 0; c < cells; c++)
            if (is_crowd(l, c) && !divide_cell(g, v, l, c, false, &l->subs[c]))
                return false;
    }
    if (!divide_subs(g, v))
        return false;
    size_t at = 0;
    for (size_t i = 0; i < g->sub_count; i++) { /* now that they do not move any longer */
        g->subs[i].starts = g->sub_starts + at;
        g->subs[i].subs = g->sub_links + at;
        at += (size_t)g->subs[i].columns * (size_t)g->subs[i].rows + 2;
    }
    return true;
}

/* Triangles are counted and put in runs side by side, each with slots of its own; in a cell runs follow each other, as
 * if there were one. */
enum { RUNS = 4, RUN_LEAST = 16384 };

typedef struct grid_job {
    window_grid       *g;
    const stroke_view *v;
    uint32_t          *slots[RUNS][GRID_LEVELS];
    uint32_t           run_count;
    uint32_t          *entries; /* NULL: they are counted */
} grid_job;

static void enter_runs(size_t begin, size_t end, void *user)
{
    grid_job *j = user;
    size_t    count = j->v->triangle_count;
    for (size_t r = begin; r < end; r++)
        for (size_t i = count * r / j->run_count; i < count * (r + 1) / j->run_count; i++) {
            int level = level_of(j->g, &j->v->boxes[i]);
            enter(&j->g->levels[level], j->v, (uint32_t)i, j->slots[r][level], j->entries);
        }
}

/* Where each cell's entries begin, and those of each run in it. Returns where those of the next level begin. */
static uint32_t place_runs(grid_job *j, int level, uint32_t total)
{
    grid_level *l = &j->g->levels[level];
    size_t      cells = (size_t)l->columns * (size_t)l->rows;
    for (size_t c = 0; c < cells; c++) {
        l->starts[c] = total;
        for (uint32_t r = 0; r < j->run_count; r++) {
            uint32_t own = j->slots[r][level][c];
            j->slots[r][level][c] = total;
            total += own;
        }
    }
    l->starts[cells] = l->starts[cells + 1] = total;
    return total;
}

static bool open_runs(grid_job *j)
{
    bool good = true;
    j->run_count = j->v->triangle_count < RUN_LEAST ? 1 : RUNS;
    for (uint32_t r = 0; r < j->run_count; r++)
        for (int k = 0; k < GRID_LEVELS; k++) {
            const grid_level *l = &j->g->levels[k];
            j->slots[r][k] = good ? mem_calloc((size_t)l->columns * (size_t)l->rows, sizeof **j->slots[r]) : NULL;
            good = j->slots[r][k] != NULL;
        }
    return good;
}

static bool enter_all(grid_job *j)
{
    uint32_t total = 0;
    threads_for(j->run_count, 1, enter_runs, j);
    for (int k = 0; k < GRID_LEVELS; k++)
        total = place_runs(j, k, total);
    j->g->entries = j->entries = mem_alloc(((size_t)total + 1) * sizeof *j->entries);
    j->g->entry_count = total;
    if (j->entries)
        threads_for(j->run_count, 1, enter_runs, j);
    return j->entries;
}

/* --- corners -------------------------------------------------------------------------------------------- */

typedef struct corner_job {
    grid_corners      *out;
    const stroke_view *v;
    const grid_level  *level;
    const uint32_t    *entries;
    size_t             first; /* corner of the first of these */
} corner_job;

static void put_corner(const corner_job *j, uint32_t entry)
{
    const grid_corners    *c = j->out;
    const uint32_t         number = j->entries[entry];
    const size_t           at = j->first + entry;
    const window_triangle *t = &j->v->triangles[number];
    const window_point     p[3] = {j->v->points[t->v[0]], j->v->points[t->v[1]], j->v->points[t->v[2]]};
    const double           side = window_side(p[0], p[1], p[2]);
    for (int k = 0; k < 3; k++) {
        c->x[k][at] = (float)p[k].x;
        c->y[k][at] = (float)p[k].y;
    }
    c->near_z[at] = j->v->boxes[number].near_z;
    c->inner_z[at] = j->v->boxes[number].inner_z;
    c->turn[at] = (float)((side > 0) - (side < 0));
}

/* Of rows of cells: not of those that have finer grids, which no one looks into. */
static void put_rows(size_t begin, size_t end, void *user)
{
    const corner_job *j = user;
    const grid_level *l = j->level;
    const size_t      columns = (size_t)l->columns;
    for (size_t c = begin * columns; c < end * columns; c++)
        for (uint32_t i = l->starts[c]; i < l->starts[c + 1] && !(l->subs && l->subs[c]); i++)
            put_corner(j, i);
}

bool grid_corners_make(grid_corners *out, const stroke_view *v)
{
    enum { NUMBERS = 9, ROWS_LEAST = 16 };
    const window_grid *g = &v->grid;
    const size_t       count = g->entry_count + g->sub_entry_count, stride = count + GRID_LANES;
    out->memory = mem_alloc(NUMBERS * stride * sizeof *out->memory);
    if (!out->memory)
        return false;
    for (int k = 0; k < 3; k++) {
        out->x[k] = out->memory + (size_t)k * stride;
        out->y[k] = out->memory + (size_t)(3 + k) * stride;
    }
    out->near_z = out->memory + 6 * stride;
    out->turn = out->memory + 7 * stride;
    out->inner_z = out->memory + 8 * stride;
    for (int k = 0; k < NUMBERS; k++)
        memset(out->memory + (size_t)k * stride + count, 0, GRID_LANES * sizeof *out->memory);
    for (int k = 0; k < GRID_LEVELS; k++)
        threads_for((size_t)g->levels[k].rows, ROWS_LEAST, put_rows,
                    &(corner_job){out, v, &g->levels[k], g->entries, 0});
    for (size_t i = 0; i < g->sub_count; i++)
        put_rows(0, (size_t)g->subs[i].rows, &(corner_job){out, v, &g->subs[i], g->sub_entries, g->entry_count});
    return true;
}

void grid_corners_release(grid_corners *c)
{
    mem_free(c->memory);
    memset(c, 0, sizeof *c);
}

lmn_status grid_build(window_grid *out, const stroke_view *v, lmn_error *error)
{
    grid_job job = {.g = out, .v = v};
    memset(out, 0, sizeof *out);
    bool good = wheels_make(&out->wheels, v) && make_levels(out, v) && open_runs(&job) && enter_all(&job);
    for (uint32_t r = 0; r < job.run_count; r++)
        for (int k = 0; k < GRID_LEVELS; k++)
            mem_free(job.slots[r][k]);
    return good && divide_crowds(out, v) ? LMN_OK : error_memory(error);
}

void grid_release(window_grid *g)
{
    for (int k = 0; k < GRID_LEVELS; k++) {
        mem_free(g->levels[k].starts);
        mem_free(g->levels[k].subs);
    }
    wheels_release(&g->wheels);
    mem_free(g->subs);
    mem_free(g->sub_starts);
    mem_free(g->sub_links);
    mem_free(g->entries);
    mem_free(g->sub_entries);
    memset(g, 0, sizeof *g);
}

/* --- walking -------------------------------------------------------------------------------------------- */

typedef struct walk {
    const window_grid *g;
    window_point       a, b; /* goes down or is level: a.y ≤ b.y */
    int32_t            low_x, high_x;
    grid_visit         visit;
    void              *user;
} walk;

/* The columns of a row that a segment touches. */
static void columns_of(const walk *w, const grid_level *l, int32_t row, cell_range *range)
{
    double top = (double)l->low_y + (double)row * l->cell, bottom = top + l->cell, height = (double)w->b.y - w->a.y,
           width = (double)w->b.x - w->a.x;
    double from = w->a.x, to = w->b.x;
    if (w->a.y < top)
        from = w->a.x + width * ((top - w->a.y) / height);
    if (w->b.y > bottom)
        to = w->a.x + width * ((bottom - w->a.y) / height);
    double  low = (from < to ? from : to) - 1, high = (from < to ? to : from) + 1;
    int32_t c0 = cell_of((int32_t)low, l->low_x, l->cells, l->columns),
            c1 = cell_of((int32_t)high, l->low_x, l->cells, l->columns);
    range->c0 = c0 < range->c0 ? range->c0 : c0;
    range->c1 = c1 > range->c1 ? range->c1 : c1;
}

/* `corner`: where those of the entries begin. */
static void walk_level(const walk *w, const grid_level *l, const uint32_t *entries, size_t corner, bool alone)
{
    cell_range range;
    if (!range_of(l, w->low_x, w->a.y, w->high_x, w->b.y, &range))
        return;
    alone = alone && range.c0 == range.c1 && range.r0 == range.r1;
    for (int32_t r = range.r0; r <= range.r1; r++) {
        cell_range row = range;
        if (range.r0 != range.r1 && range.c0 != range.c1)
            columns_of(w, l, r, &row);
        for (int32_t c = row.c0; c <= row.c1; c++) {
            size_t   number = (size_t)r * (size_t)l->columns + (size_t)c;
            uint32_t begin = l->starts[number], end = l->starts[number + 1];
            if (begin == end)
                continue;
            if (l->subs && l->subs[number])
                walk_level(w, &w->g->subs[l->subs[number] - 1], w->g->sub_entries, w->g->entry_count, alone);
            else
                w->visit(w->user, entries + begin, corner + begin, end - begin, alone);
        }
    }
}

void grid_walk(const window_grid *g, window_point a, window_point b, grid_visit visit, void *user)
{
    bool down = a.y <= b.y;
    walk w = {g, down ? a : b, down ? b : a, a.x < b.x ? a.x : b.x, a.x < b.x ? b.x : a.x, visit, user};
    for (int k = 0; k < GRID_LEVELS; k++) {
        const grid_level *l = &g->levels[k];
        if (l->starts[(size_t)l->columns * (size_t)l->rows] != l->starts[0])
            walk_level(&w, l, g->entries, 0, true);
    }
}
