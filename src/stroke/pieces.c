/* Strokes sorted into the cells of a grid on paper that they run through. */
#include "stroke/pieces.h"

#include <math.h>

#include "base/memory.h"

bool page_pieces_open(page_pieces *p, const stroke_set *set)
{
    double high[2] = {-INFINITY, -INFINITY};
    *p = (page_pieces){.set = set, .low = {INFINITY, INFINITY}};
    for (size_t i = 0; i < set->point_count; i++) {
        const double at[2] = {(double)set->points[i].x, (double)set->points[i].y};
        for (int k = 0; k < 2; k++) {
            p->low[k] = fmin(p->low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    enum { CELLS_MOST = 4096 }; /* each way */
    p->columns = (int)fmin(fmax((high[0] - p->low[0]) / PIECES_CELL, 0), CELLS_MOST) + 1;
    p->rows = (int)fmin(fmax((high[1] - p->low[1]) / PIECES_CELL, 0), CELLS_MOST) + 1;
    p->heads = mem_calloc((size_t)p->columns * (size_t)p->rows, sizeof *p->heads);
    return p->heads != NULL;
}

void page_pieces_close(page_pieces *p)
{
    mem_free(p->heads);
    mem_free(p->items);
}

static int cell_of(double at, double low, int cells)
{
    return (int)fmin(fmax((at - low) / PIECES_CELL, 0), cells - 1);
}

/* Puts a piece into every cell that it runs through, by steps of half a cell. */
static bool put_piece(page_pieces *p, uint32_t stroke, uint32_t point)
{
    const stroke_point *a = &p->set->points[point], *b = a + 1;
    const double        x = (double)b->x - a->x, y = (double)b->y - a->y;
    const int           steps = (int)(hypot(x, y) / (PIECES_CELL / 2)) + 1;
    size_t              last = SIZE_MAX;
    for (int i = 0; i <= steps; i++) {
        const size_t cell = (size_t)cell_of(a->y + y * i / steps, p->low[1], p->rows) * (size_t)p->columns +
                            (size_t)cell_of(a->x + x * i / steps, p->low[0], p->columns);
        if (cell == last)
            continue;
        if (!mem_grow((void **)&p->items, &p->capacity, p->count + 1, sizeof *p->items))
            return false;
        p->items[p->count++] = (piece){stroke, point, p->heads[cell]};
        p->heads[cell] = (uint32_t)p->count;
        last = cell;
    }
    return true;
}

bool page_pieces_put(page_pieces *p, size_t index)
{
    const stroke *s = &p->set->strokes[index];
    bool          good = true;
    for (uint32_t k = 0; k + 1 < s->count && good; k++)
        good = put_piece(p, (uint32_t)index, s->first + k);
    return good;
}

pieces_walk pieces_around(const page_pieces *p, const stroke_point *at)
{
    return (pieces_walk){.pieces = p,
                         .row = cell_of(at->y, p->low[1], p->rows) - 1,
                         .column = cell_of(at->x, p->low[0], p->columns) - 1};
}

const piece *pieces_walk_next(pieces_walk *w)
{
    const page_pieces *p = w->pieces;
    for (; !w->next && w->cell < 9; w->cell++) {
        const int row = w->row + w->cell / 3, column = w->column + w->cell % 3;
        if (row >= 0 && column >= 0 && row < p->rows && column < p->columns)
            w->next = p->heads[(size_t)row * (size_t)p->columns + (size_t)column];
    }
    const piece *found = w->next ? &p->items[w->next - 1] : NULL;
    w->next = found ? found->next : 0;
    return found;
}

bool piece_is_near(const stroke_point *at, const stroke_point *a, double most)
{
    const double x = (double)a[1].x - a->x, y = (double)a[1].y - a->y, square = x * x + y * y;
    const double t = square > 0 ? fmin(fmax(((at->x - a->x) * x + (at->y - a->y) * y) / square, 0), 1) : 0;
    const double across = a->x + t * x - at->x, up = a->y + t * y - at->y;
    return across * across + up * up <= most * most; /* hypot is a call */
}
