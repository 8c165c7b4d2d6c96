/* Lines that lie on lines. What runs all its length within a fraction of a pixel of more important lines adds
 * nothing but ink: seams of parts that touch, hidden edges right behind visible ones, the dozens of edges in which
 * a finely divided surface turns away. Visible comes before hidden, then the order of the classes, then the longer
 * one.
 *
 * Where outlines of a mesh end within it, its edges change between front and back by turns, and beside the outline lie
 * crumbs of others. Short ones that run side by side with a visible line, within less than a pen, are such crumbs. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Where strokes that stay run is marked in cells of this fraction of the distance; a position is near one when its own
 * or a neighbouring cell is marked. */
#define CELL (2.0f / 3)
/* Outlines no longer than this that run all their length so near to longer lines are crumbs. */
#define CRUMB_LENGTH (5 * PAPER_UNITS_PER_MM)
#define CRUMB_APART  ((float)(0.6 * PAPER_UNITS_PER_MM))
enum { BLOCK = 64 /* cells a side of the blocks that marks are kept in */, DIRECTIONS = 8 };

typedef struct block {
    uint64_t rows[BLOCK];
} block;

/* Where lines of one range of directions run. */
typedef struct layer {
    uint32_t *numbers; /* per block: 1 + its position in `blocks`, 0: nothing in it is marked */
    block    *blocks;
    size_t    block_count, block_capacity;
} layer;

typedef struct crowd {
    const stroke_set *set;
    float             cell;          /* pixels */
    int32_t           columns, rows; /* of blocks */
    int               layer_count;   /* 1: directions do not matter; or DIRECTIONS */
    layer             layers[DIRECTIONS];
} crowd;

static bool is_marked(const crowd *c, const layer *l, int32_t column, int32_t row)
{
    if (column < 0 || row < 0 || column >= c->columns * BLOCK || row >= c->rows * BLOCK)
        return false;
    uint32_t number = l->numbers[(size_t)(row / BLOCK) * (size_t)c->columns + (size_t)(column / BLOCK)];
    return number && l->blocks[number - 1].rows[row % BLOCK] >> (column % BLOCK) & 1;
}

static int layer_of(const crowd *c, float x, float y)
{
    float angle = atan2f(y, x) / 3.14159265f; /* −1 … 1; lines have no sense */
    return c->layer_count == 1 ? 0 : (int)((angle < 0 ? angle + 1 : angle) * DIRECTIONS) % DIRECTIONS;
}

static bool is_traced(const crowd *c, int direction, float x, float y)
{
    int32_t column = (int32_t)(x / c->cell), row = (int32_t)(y / c->cell);
    int     around = c->layer_count == 1 ? 0 : 1;
    for (int i = -around; i <= around; i++)
        for (int32_t r = row - 1; r <= row + 1; r++)
            for (int32_t k = column - 1; k <= column + 1; k++)
                if (is_marked(c, &c->layers[(direction + i + c->layer_count) % c->layer_count], k, r))
                    return true;
    return false;
}

static bool put_trace(crowd *c, int direction, float x, float y)
{
    int32_t column = (int32_t)(x / c->cell), row = (int32_t)(y / c->cell);
    layer  *l = &c->layers[direction];
    if (column < 0 || row < 0 || column >= c->columns * BLOCK || row >= c->rows * BLOCK)
        return true;
    uint32_t *number = &l->numbers[(size_t)(row / BLOCK) * (size_t)c->columns + (size_t)(column / BLOCK)];
    if (!*number) {
        if (!mem_grow((void **)&l->blocks, &l->block_capacity, l->block_count + 1, sizeof *l->blocks))
            return false;
        memset(&l->blocks[l->block_count++], 0, sizeof *l->blocks);
        *number = (uint32_t)l->block_count;
    }
    l->blocks[*number - 1].rows[row % BLOCK] |= UINT64_C(1) << (column % BLOCK);
    return true;
}

/* Steps along a stroke. Tracing: marks every position; else: asks whether all are near marked ones. False: out of
 * memory, or one is not. */
static bool step_along(crowd *c, const stroke *s, bool trace)
{
    const stroke_point *p = &c->set->points[s->first];
    int                 direction = 0;
    for (uint32_t i = 0; i + 1 < s->count; i++) {
        float x = p[i + 1].x - p[i].x, y = p[i + 1].y - p[i].y, length = sqrtf(x * x + y * y);
        int   steps = (int)(length / c->cell) + 1;
        direction = layer_of(c, x, y);
        for (int k = 0; k < steps; k++) {
            float fraction = (float)k / (float)steps;
            if (trace ? !put_trace(c, direction, p[i].x + fraction * x, p[i].y + fraction * y)
                      : !is_traced(c, direction, p[i].x + fraction * x, p[i].y + fraction * y))
                return false;
        }
    }
    p += s->count - 1;
    return trace ? put_trace(c, direction, p->x, p->y) : is_traced(c, direction, p->x, p->y);
}

static bool open_crowd(crowd *c, const stroke_set *set, float apart, int width, int height, int layers)
{
    bool good = true;
    *c = (crowd){.set = set, .cell = apart * CELL, .layer_count = layers};
    c->columns = (int32_t)((float)width / (c->cell * BLOCK)) + 1;
    c->rows = (int32_t)((float)height / (c->cell * BLOCK)) + 1;
    for (int i = 0; i < layers; i++) {
        c->layers[i].numbers = mem_calloc((size_t)c->columns * (size_t)c->rows, sizeof *c->layers[i].numbers);
        good = good && c->layers[i].numbers;
    }
    return good;
}

static void close_crowd(crowd *c)
{
    for (int i = 0; i < c->layer_count; i++) {
        mem_free(c->layers[i].numbers);
        mem_free(c->layers[i].blocks);
    }
}

typedef struct ranked {
    uint32_t number, hidden;
    int      kind;
    float    length;
} ranked;

static int compare_ranks(const void *a, const void *b)
{
    const ranked *p = a, *q = b;
    if (p->hidden != q->hidden)
        return p->hidden < q->hidden ? -1 : 1;
    if (p->kind != q->kind)
        return p->kind < q->kind ? -1 : 1;
    if (p->length != q->length)
        return p->length > q->length ? -1 : 1;
    return p->number < q->number ? -1 : p->number > q->number;
}

static bool is_crumb(const stroke *s, const ranked *rank)
{
    return s->kind == STROKE_CONTOUR && !s->closed && (double)rank->length < CRUMB_LENGTH;
}

/* What runs along what stays goes, too; `crumbs`: only crumbs may go, beside what is visible. */
static bool mark_gone(crowd *c, const ranked *ranks, uint8_t *gone, bool crumbs)
{
    for (size_t i = 0; i < c->set->stroke_count; i++) {
        const stroke *s = &c->set->strokes[ranks[i].number];
        bool          may_go = !crumbs || (s->hidden_by == 0 && is_crumb(s, &ranks[i]));
        if (gone[ranks[i].number])
            continue;
        gone[ranks[i].number] = may_go && step_along(c, s, false);
        if (!gone[ranks[i].number] && (!crumbs || s->hidden_by == 0) && !step_along(c, s, true))
            return false;
    }
    return true;
}

static bool thin(const stroke_set *set, float apart, int width, int height, bool crumbs, uint8_t *gone)
{
    crowd   c;
    ranked *ranks = mem_alloc((set->stroke_count + 1) * sizeof *ranks);
    bool    good = open_crowd(&c, set, apart, width, height, crumbs ? DIRECTIONS : 1) && ranks;
    if (good) {
        for (uint32_t i = 0; i < set->stroke_count; i++) {
            const stroke *s = &set->strokes[i];
            ranks[i] = (ranked){i, s->hidden_by, (int)s->kind,
                                set->points[s->first + s->count - 1].arc - set->points[s->first].arc};
        }
        qsort(ranks, set->stroke_count, sizeof *ranks, compare_ranks);
        good = mark_gone(&c, ranks, gone, crumbs);
    }
    close_crowd(&c);
    mem_free(ranks);
    return good;
}

lmn_status strokes_thin(const stroke_set *set, float apart, int width, int height, uint8_t *gone, lmn_error *error)
{
    if (!(apart > 0.01f) || set->stroke_count < 2)
        return LMN_OK;
    return thin(set, apart, width, height, false, gone) && thin(set, CRUMB_APART, width, height, true, gone)
               ? LMN_OK
               : error_memory(error);
}
