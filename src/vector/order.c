/* Lines in an order for plotters: pen by pen, and for each pen always on to the line that begins or ends nearest,
 * which is then drawn from there. Ends of lines not drawn yet lie in a grid that is searched in growing rings. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "vector/vector_private.h"

enum { CELLS_A_SIDE_MOST = 512 };

/* A line with what it is drawn with. */
typedef struct plotted {
    uint32_t   path;
    uint32_t   group;
    uint64_t   id;
    sheet_kind kind;
    colour     ink;
    float      width;
    bool       drawn;
} plotted;

typedef struct plotter {
    sheet   *page;
    plotted *lines;
    size_t   count;
    /* of the pen in hand: its lines are begin … end−1 */
    size_t    begin, end, left;
    int       side; /* cells */
    double    cell[2];
    uint32_t *heads, *next; /* ends: 2·line and 2·line + 1, + 1 */
} plotter;

static int compare_pens(const void *a, const void *b)
{
    const plotted *one = a, *other = b;
    int            ink = memcmp(&one->ink, &other->ink, sizeof one->ink);
    if (ink)
        return ink;
    if (one->width != other->width)
        return one->width > other->width ? -1 : 1;
    return one->path < other->path ? -1 : one->path > other->path;
}

static bool same_pen(const plotted *a, const plotted *b)
{
    return memcmp(&a->ink, &b->ink, sizeof a->ink) == 0 && a->width == b->width;
}

static bool gather(plotter *p)
{
    p->lines = mem_calloc(p->page->path_count, sizeof *p->lines);
    for (size_t i = 0; p->lines && i < p->page->item_count; i++) {
        const sheet_item *item = &p->page->items[i];
        for (uint32_t k = 0; k < item->count; k++) {
            const sheet_path *path = &p->page->paths[item->first + k];
            if (path->count)
                p->lines[p->count++] =
                    (plotted){item->first + k, item->group, item->id, item->kind, item->ink, path->width, false};
        }
    }
    if (p->lines && p->count)
        qsort(p->lines, p->count, sizeof *p->lines, compare_pens);
    return p->lines != NULL;
}

/* An end of a line: even numbers are beginnings. */
static const float *end_at(const plotter *p, size_t end)
{
    const sheet_path *path = &p->page->paths[p->lines[end / 2].path];
    return p->page->points[path->first + (end % 2 && !path->closed ? path->count - 1 : 0)];
}

static size_t cell_of(const plotter *p, const float *position, int out[2])
{
    for (int k = 0; k < 2; k++)
        out[k] = (int)fmin(fmax(floor((double)position[k] / p->cell[k]), 0), p->side - 1);
    return (size_t)out[1] * (size_t)p->side + (size_t)out[0];
}

static void fill_grid(plotter *p)
{
    int    cell[2];
    size_t lines = p->end - p->begin;
    p->side = 1;
    while (p->side < CELLS_A_SIDE_MOST && (size_t)p->side * (size_t)p->side < lines)
        p->side *= 2;
    p->cell[0] = p->page->width / p->side;
    p->cell[1] = p->page->height / p->side;
    memset(p->heads, 0, (size_t)p->side * (size_t)p->side * sizeof *p->heads);
    for (size_t end = 2 * p->end; end-- > 2 * p->begin;) {
        size_t at = cell_of(p, end_at(p, end), cell);
        p->next[end] = p->heads[at];
        p->heads[at] = (uint32_t)end + 1;
    }
    p->left = lines;
}

/* Looks through one cell, and takes those out that are drawn. */
static void search_cell(plotter *p, size_t at, const float *from, double *best, size_t *found)
{
    for (uint32_t *link = &p->heads[at]; *link;) {
        size_t end = *link - 1;
        if (p->lines[end / 2].drawn) {
            *link = p->next[end];
            continue;
        }
        const float *position = end_at(p, end);
        double       distance = hypot((double)(position[0] - from[0]), (double)(position[1] - from[1]));
        if (distance < *best || (distance == *best && end < *found)) {
            *best = distance;
            *found = end;
        }
        link = &p->next[end];
    }
}

/* The nearest end of a line that is left. */
static size_t nearest(plotter *p, const float *from)
{
    int    middle[2];
    double best = INFINITY, step = fmin(p->cell[0], p->cell[1]);
    size_t found = SIZE_MAX;
    cell_of(p, from, middle);
    for (int ring = 0; ring < p->side && !(best <= (ring - 1) * step); ring++)
        for (int row = middle[1] - ring; row <= middle[1] + ring; row++)
            for (int column = middle[0] - ring; column <= middle[0] + ring; column++) {
                bool border = row == middle[1] - ring || row == middle[1] + ring || column == middle[0] - ring ||
                              column == middle[0] + ring;
                if (border && row >= 0 && column >= 0 && row < p->side && column < p->side)
                    search_cell(p, (size_t)row * (size_t)p->side + (size_t)column, from, &best, &found);
            }
    return found;
}

static void turn_round(sheet *page, const sheet_path *path)
{
    for (uint32_t i = 0, k = path->count; path->count && i < --k; i++) {
        float *a = page->points[path->first + i], *b = page->points[path->first + k], kept[2] = {a[0], a[1]};
        memcpy(a, b, sizeof kept);
        memcpy(b, kept, sizeof kept);
    }
}

/* Draws the pen's lines into `order`, from where the pen is. */
static void plot_pen(plotter *p, uint32_t *order, size_t *ordered, float pen[2])
{
    for (fill_grid(p); p->left > 0; p->left--) {
        size_t            end = nearest(p, pen);
        plotted          *line = &p->lines[end / 2];
        const sheet_path *path = &p->page->paths[line->path];
        if (end % 2 && !path->closed)
            turn_round(p->page, path);
        line->drawn = true;
        memcpy(pen, end_at(p, path->closed ? end : (end | 1)), 2 * sizeof *pen);
        order[(*ordered)++] = (uint32_t)(end / 2);
    }
}

/* The items of the new order: one a line, in a group a pen; behind them the texts. */
static bool rebuild(plotter *p, const uint32_t *order)
{
    sheet      *page = p->page;
    sheet_path *paths = mem_calloc(p->count, sizeof *paths);
    sheet_item *items = mem_calloc(p->count + page->item_count, sizeof *items);
    size_t      count = p->count;
    int         pen = 0;
    uint32_t    group = 0;
    if (!paths || !items) {
        mem_free(paths);
        mem_free(items);
        return false;
    }
    for (size_t i = 0; i < p->count; i++) {
        const plotted *line = &p->lines[order[i]];
        char           name[32];
        if (i == 0 || !same_pen(line, &p->lines[order[i - 1]])) {
            snprintf(name, sizeof name, "pen-%d", ++pen);
            group = sheet_add_group(page, -1, name, "pen", 0);
        }
        paths[i] = page->paths[line->path];
        items[i] = (sheet_item){
            .kind = line->kind, .group = group, .ink = line->ink, .id = line->id, .first = (uint32_t)i, .count = 1};
    }
    for (size_t i = 0; i < page->item_count; i++) {
        mem_free(page->items[i].png);
        if (page->items[i].kind == SHEET_TEXT)
            items[count++] = page->items[i];
    }
    mem_free(page->paths);
    mem_free(page->items);
    page->paths = paths;
    page->items = items;
    page->path_count = page->path_capacity = p->count;
    page->item_count = page->item_capacity = count;
    return !page->failed;
}

lmn_status vector_order_for_plotter(sheet *page, lmn_error *error)
{
    plotter   p = {.page = page};
    float     pen[2] = {0, 0};
    size_t    ordered = 0;
    bool      good = gather(&p);
    uint32_t *order = mem_calloc(p.count, sizeof *order);
    p.heads = mem_calloc((size_t)CELLS_A_SIDE_MOST * CELLS_A_SIDE_MOST, sizeof *p.heads);
    p.next = mem_calloc(2 * p.count, sizeof *p.next);
    good = good && order && p.heads && p.next;
    for (p.begin = 0; good && p.begin < p.count; p.begin = p.end) {
        for (p.end = p.begin + 1; p.end < p.count && same_pen(&p.lines[p.begin], &p.lines[p.end]);)
            p.end++;
        plot_pen(&p, order, &ordered, pen);
    }
    good = good && rebuild(&p, order);
    mem_free(order);
    mem_free(p.heads);
    mem_free(p.next);
    mem_free(p.lines);
    return good ? LMN_OK : error_memory(error);
}
