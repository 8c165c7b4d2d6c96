/* Sequential thinning by simple points: a cell goes when its neighbours stay connected without it. Each round peels
 * the four sides one after another, so that what stays lies in the middle, and looks only at cells beside the last
 * round's, so that the work is that of the ink's area. */
#include "lines/thin.h"

#include <string.h>

#include "base/memory.h"

enum { CELL_QUEUED = 4, SIDES = 4 };

static unsigned pattern_of(const uint8_t *cells, uint32_t cell, const int around[8])
{
    unsigned pattern = 0;
    for (unsigned k = 0; k < 8; k++)
        pattern |= (unsigned)(cells[(int64_t)cell + around[k]] & CELL_THIN) / CELL_THIN << k;
    return pattern;
}

int thin_degree(const thin_grid *g, uint32_t cell)
{
    int degree = 0;
    for (int k = 0; k < 8; k++)
        degree += (g->cells[(int64_t)cell + g->around[k]] & CELL_THIN) != 0;
    return degree;
}

/* Counts single empty pixels inside ink too, which would make rings of a few pixels. */
static bool is_ink(const uint8_t *ink, int width, int height, int x, int y)
{
    const uint8_t *at = &ink[(size_t)y * (size_t)width + (size_t)x];
    if (*at)
        return true;
    return x > 0 && y > 0 && x + 1 < width && y + 1 < height && at[-1] && at[1] && at[-width] && at[width];
}

static void add_row(thin_grid *g, const uint8_t *ink, int y)
{
    const uint8_t *row = &ink[(size_t)y * (size_t)g->width];
    for (int x = 0; x < g->width; x++) {
        uint64_t eight;
        /* Most of a picture is empty. */
        while (x + 8 <= g->width && (memcpy(&eight, &row[x], sizeof eight), eight == 0))
            x += 8;
        if (x >= g->width || !is_ink(ink, g->width, g->height, x, y))
            continue;
        uint32_t cell = (uint32_t)((y + 1) * g->stride + x + 1);
        g->cells[cell] = CELL_INK | CELL_THIN;
        g->pixels[g->count++] = cell;
    }
}

bool thin_create(thin_grid *out, const uint8_t *ink, int width, int height)
{
    *out = (thin_grid){.width = width, .height = height, .stride = width + 2};
    const int around[8] = {1,  1 + out->stride,  out->stride,  out->stride - 1,
                           -1, -1 - out->stride, -out->stride, 1 - out->stride};
    memcpy(out->around, around, sizeof around);
    out->cells = mem_calloc((size_t)(height + 2), (size_t)out->stride);
    size_t capacity = 0;
    bool   good = out->cells != NULL;
    for (int y = 0; good && y < height; y++) {
        good = mem_grow((void **)&out->pixels, &capacity, out->count + (size_t)width, sizeof *out->pixels);
        if (good)
            add_row(out, ink, y);
    }
    if (!good)
        thin_release(out);
    return good;
}

void thin_release(thin_grid *g)
{
    mem_free(g->cells);
    mem_free(g->pixels);
    *g = (thin_grid){0};
}

/* Cells that may go: the eight around stay connected (Yokoi's number is 1), and it is no end. */
static void make_table(bool table[256])
{
    for (unsigned pattern = 0; pattern < 256; pattern++) {
        int number = 0, neighbours = 0;
        for (unsigned k = 0; k < 8; k++)
            neighbours += (int)(pattern >> k & 1);
        for (unsigned k = 0; k < 8; k += 2) {
            bool a = !(pattern >> k & 1), b = !(pattern >> ((k + 1) & 7) & 1), c = !(pattern >> ((k + 2) & 7) & 1);
            number += a - (a && b && c);
        }
        table[pattern] = number == 1 && neighbours >= 2;
    }
}

typedef struct peel_lists {
    uint32_t *active, *bare, *gone;
    size_t    active_count, gone_count;
} peel_lists;

/* One side: the cells that were bare there when it began. */
static void peel_side(thin_grid *g, peel_lists *l, const bool table[256], const int around[8], int side)
{
    size_t bare = 0;
    for (size_t i = 0; i < l->active_count; i++) {
        uint32_t cell = l->active[i];
        if (g->cells[cell] & CELL_THIN && !(g->cells[(int64_t)cell + around[side]] & CELL_THIN))
            l->bare[bare++] = cell;
    }
    for (size_t i = 0; i < bare; i++) {
        uint32_t cell = l->bare[i];
        if (table[pattern_of(g->cells, cell, around)]) {
            g->cells[cell] = (uint8_t)(g->cells[cell] & ~CELL_THIN);
            l->gone[l->gone_count++] = cell;
        }
    }
}

/* What the next round looks at: all that stays beside what went. */
static void queue_neighbours(thin_grid *g, peel_lists *l, const int around[8])
{
    l->active_count = 0;
    for (size_t i = 0; i < l->gone_count; i++)
        for (int k = 0; k < 8; k++) {
            uint32_t cell = (uint32_t)((int64_t)l->gone[i] + around[k]);
            if ((g->cells[cell] & (CELL_THIN | CELL_QUEUED)) != CELL_THIN)
                continue;
            g->cells[cell] |= CELL_QUEUED;
            l->active[l->active_count++] = cell;
        }
    for (size_t i = 0; i < l->active_count; i++)
        g->cells[l->active[i]] = (uint8_t)(g->cells[l->active[i]] & ~CELL_QUEUED);
    l->gone_count = 0;
}

bool thin_run(thin_grid *g)
{
    static const int order[SIDES] = {2, 6, 0, 4};
    bool             table[256];
    const int       *around = g->around;
    peel_lists       l = {mem_alloc(g->count * sizeof(uint32_t)), mem_alloc(g->count * sizeof(uint32_t)),
                          mem_alloc(g->count * sizeof(uint32_t)), 0, 0};
    bool             good = l.active && l.bare && l.gone;
    make_table(table);
    for (size_t i = 0; good && i < g->count; i++)
        if (g->cells[g->pixels[i]] & CELL_THIN)
            l.active[l.active_count++] = g->pixels[i];
    while (good && l.active_count) {
        for (int k = 0; k < SIDES; k++)
            peel_side(g, &l, table, around, order[k]);
        queue_neighbours(g, &l, around);
    }
    mem_free(l.active);
    mem_free(l.bare);
    mem_free(l.gone);
    size_t kept = 0;
    for (size_t i = 0; i < g->count; i++)
        if (g->cells[g->pixels[i]] & CELL_THIN)
            g->pixels[kept++] = g->pixels[i];
    g->count = kept;
    return good;
}
