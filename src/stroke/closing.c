/* Lines that were left out of a crowd come back where what is left would have open corners: from the end of a line that
 * meets nothing else, the few short ones that lead to something that is drawn. Whatever is drawn then ends at a line,
 * as draughtsmen have it, or where it ended before anything was left out. */
#include "stroke/stroke_private.h"

#include <math.h>

#include "base/memory.h"

#define MM      PAPER_UNITS_PER_MM
#define CELL    MM
#define TOUCHES (0.06 * MM) /* shared corners are at one place; where one hides another, nearly so */
#define BESIDE  (0.25 * MM) /* about a pen: ink of lines so near runs together */
#define LONGEST (12 * MM)   /* what is longer is what made the crowd */
enum { WAY_MOST = 3 };      /* lines that come back for one end */

/* A piece of a drawn stroke, in each cell that it runs through. */
typedef struct piece {
    uint32_t stroke, point; /* the first of its two points */
    uint32_t next;          /* of its cell, + 1 */
} piece;

typedef struct page_pieces {
    const stroke_set *set;
    double            low[2];
    int               columns, rows;
    uint32_t         *heads; /* per cell: a piece + 1 */
    piece            *items;
    size_t            count, capacity;
} page_pieces;

static const stroke_point *point_of(const stroke_set *set, const stroke *s, bool last)
{
    return &set->points[s->first + (last ? s->count - 1 : 0)];
}

static bool counts(const stroke_set *set, const uint8_t *gone, size_t i, bool wanted_gone)
{
    return (gone[i] != 0) == wanted_gone && set->strokes[i].hidden_by == 0 && set->strokes[i].count > 1;
}

static bool open_pieces(page_pieces *p, const stroke_set *set)
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
    p->columns = (int)fmin(fmax((high[0] - p->low[0]) / CELL, 0), CELLS_MOST) + 1;
    p->rows = (int)fmin(fmax((high[1] - p->low[1]) / CELL, 0), CELLS_MOST) + 1;
    p->heads = mem_calloc((size_t)p->columns * (size_t)p->rows, sizeof *p->heads);
    return p->heads != NULL;
}

static int cell_along(double at, double low, int cells)
{
    return (int)fmin(fmax((at - low) / CELL, 0), cells - 1);
}

/* Puts a piece into every cell that it runs through, by steps of half a cell. */
static bool put_piece(page_pieces *p, uint32_t stroke, uint32_t point)
{
    const stroke_point *a = &p->set->points[point], *b = a + 1;
    const double        x = (double)b->x - a->x, y = (double)b->y - a->y;
    const int           steps = (int)(hypot(x, y) / (CELL / 2)) + 1;
    size_t              last = SIZE_MAX;
    for (int i = 0; i <= steps; i++) {
        const size_t cell = (size_t)cell_along(a->y + y * i / steps, p->low[1], p->rows) * (size_t)p->columns +
                            (size_t)cell_along(a->x + x * i / steps, p->low[0], p->columns);
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

static bool put_stroke(page_pieces *p, size_t index)
{
    const stroke *s = &p->set->strokes[index];
    bool          good = true;
    for (uint32_t k = 0; k + 1 < s->count && good; k++)
        good = put_piece(p, (uint32_t)index, s->first + k);
    return good;
}

static bool is_near(const stroke_point *at, const stroke_point *a, double most)
{
    const double x = (double)a[1].x - a->x, y = (double)a[1].y - a->y, square = x * x + y * y;
    const double t = square > 0 ? fmin(fmax(((at->x - a->x) * x + (at->y - a->y) * y) / square, 0), 1) : 0;
    return hypot(a->x + t * x - at->x, a->y + t * y - at->y) <= most;
}

static bool is_end(const stroke_set *set, const stroke *s, const stroke_point *at)
{
    for (int last = 0; last < 2 && !s->closed; last++) {
        const stroke_point *end = point_of(set, s, last);
        if (hypot((double)end->x - at->x, (double)end->y - at->y) <= TOUCHES)
            return true;
    }
    return false;
}

/* What is drawn at a place: nothing, the end of one line alone, or more. */
typedef enum meeting_kind { MEETS_NOTHING, MEETS_OPEN_END, MEETS_LINES } meeting_kind;

static meeting_kind meeting_at(const page_pieces *p, const stroke_point *at)
{
    const int row = cell_along(at->y, p->low[1], p->rows), column = cell_along(at->x, p->low[0], p->columns);
    uint32_t  found = UINT32_MAX;
    for (int r = row - 1; r <= row + 1; r++)
        for (int c = column - 1; c <= column + 1; c++) {
            if (r < 0 || c < 0 || r >= p->rows || c >= p->columns)
                continue;
            for (uint32_t i = p->heads[(size_t)r * (size_t)p->columns + (size_t)c]; i; i = p->items[i - 1].next) {
                const piece *of = &p->items[i - 1];
                if (of->stroke == found || !is_near(at, &p->set->points[of->point], TOUCHES))
                    continue;
                if (found != UINT32_MAX || !is_end(p->set, &p->set->strokes[of->stroke], at))
                    return MEETS_LINES;
                found = of->stroke;
            }
        }
    return found == UINT32_MAX ? MEETS_NOTHING : MEETS_OPEN_END;
}

static bool is_short(const stroke_set *set, const stroke *s)
{
    double length = 0;
    for (uint32_t k = 1; k < s->count && length <= LONGEST; k++) {
        const stroke_point *q = &set->points[s->first + k];
        length += hypot((double)q->x - q[-1].x, (double)q->y - q[-1].y);
    }
    return length <= LONGEST && !s->closed;
}

/* A way of strokes that are gone. */
typedef struct way {
    uint32_t strokes[WAY_MOST];
    int      count;
} way;

static bool is_on(const way *w, uint32_t stroke)
{
    bool on = false;
    for (int i = 0; i < w->count; i++)
        on = on || w->strokes[i] == stroke;
    return on;
}

/* Where a stroke leads that has an end here; NULL: it has none. */
static const stroke_point *leads_to(const stroke_set *set, const stroke *s, const stroke_point *at)
{
    for (int last = 0; last < 2; last++) {
        const stroke_point *end = point_of(set, s, last);
        if (hypot((double)end->x - at->x, (double)end->y - at->y) <= TOUCHES)
            return point_of(set, s, !last);
    }
    return NULL;
}

/* Finds a way from a place over strokes that are gone to one where something is drawn. The shortest in lines is found
 * first, since `most` grows. */
static bool find_way(way *w, const page_pieces *drawn, const page_pieces *left, const uint8_t *gone,
                     const stroke_point *at, int most)
{
    const int row = cell_along(at->y, left->low[1], left->rows),
              column = cell_along(at->x, left->low[0], left->columns);
    for (int r = row - 1; r <= row + 1; r++)
        for (int c = column - 1; c <= column + 1; c++) {
            if (r < 0 || c < 0 || r >= left->rows || c >= left->columns)
                continue;
            for (uint32_t i = left->heads[(size_t)r * (size_t)left->columns + (size_t)c]; i;
                 i = left->items[i - 1].next) {
                const uint32_t      index = left->items[i - 1].stroke;
                const stroke_point *to =
                    gone[index] && !is_on(w, index) ? leads_to(left->set, &left->set->strokes[index], at) : NULL;
                if (!to)
                    continue;
                w->strokes[w->count++] = index;
                if (w->count < most ? find_way(w, drawn, left, gone, to, most) : meeting_at(drawn, to) != MEETS_NOTHING)
                    return true;
                w->count--;
            }
        }
    return false;
}

/* Finds a stroke that is gone, runs beside a place and ends at what is drawn on both sides. */
static bool find_beside(way *w, const page_pieces *drawn, const page_pieces *left, const uint8_t *gone,
                        const stroke_point *at)
{
    const int row = cell_along(at->y, left->low[1], left->rows),
              column = cell_along(at->x, left->low[0], left->columns);
    for (int r = row - 1; r <= row + 1; r++)
        for (int c = column - 1; c <= column + 1; c++) {
            if (r < 0 || c < 0 || r >= left->rows || c >= left->columns)
                continue;
            for (uint32_t i = left->heads[(size_t)r * (size_t)left->columns + (size_t)c]; i;
                 i = left->items[i - 1].next) {
                const piece  *of = &left->items[i - 1];
                const stroke *s = &left->set->strokes[of->stroke];
                if (gone[of->stroke] && is_near(at, &left->set->points[of->point], BESIDE) &&
                    meeting_at(drawn, point_of(left->set, s, false)) != MEETS_NOTHING &&
                    meeting_at(drawn, point_of(left->set, s, true)) != MEETS_NOTHING) {
                    *w = (way){.strokes = {of->stroke}, .count = 1};
                    return true;
                }
            }
        }
    return false;
}

/* What ends in the open is led on to the next line, or has one beside it. */
static bool close_end(page_pieces *drawn, const page_pieces *left, uint8_t *gone, const stroke_point *at)
{
    way  w = {.count = 0};
    bool found = false, good = true;
    if (meeting_at(drawn, at) != MEETS_OPEN_END)
        return true;
    for (int most = 1; most <= WAY_MOST && !found; most++)
        found = find_way(&w, drawn, left, gone, at, most);
    found = found || find_beside(&w, drawn, left, gone, at);
    for (int i = 0; i < w.count && found && good; i++) {
        gone[w.strokes[i]] = 0;
        good = put_stroke(drawn, w.strokes[i]);
    }
    return good;
}

bool strokes_close_corners(const stroke_set *set, uint8_t *gone)
{
    page_pieces drawn, left = {0};
    bool        good = open_pieces(&drawn, set) && open_pieces(&left, set);
    for (size_t i = 0; i < set->stroke_count && good; i++)
        if (counts(set, gone, i, false))
            good = put_stroke(&drawn, i);
        else if (counts(set, gone, i, true) && is_short(set, &set->strokes[i]))
            good = put_stroke(&left, i);
    for (size_t i = 0; i < set->stroke_count && good && left.count; i++)
        if (counts(set, gone, i, false) && !set->strokes[i].closed)
            good = close_end(&drawn, &left, gone, point_of(set, &set->strokes[i], false)) &&
                   close_end(&drawn, &left, gone, point_of(set, &set->strokes[i], true));
    mem_free(drawn.heads);
    mem_free(drawn.items);
    mem_free(left.heads);
    mem_free(left.items);
    return good;
}
