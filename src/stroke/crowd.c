/* Lines that lie on lines. What runs all its length within a fraction of a pixel of more important lines adds
 * nothing but ink: seams of parts that touch, hidden edges right behind visible ones, the dozens of edges in which
 * a finely divided surface turns away. Visible comes before hidden, then the order of the classes, then the longer
 * one. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Where strokes that stay run is marked in cells of this fraction of the distance; a position is near one when its own
 * or a neighbouring cell is marked. */
#define CELL (2.0f / 3)
enum { BLOCK = 64 }; /* cells a side of the blocks that marks are kept in */

typedef struct block {
    uint64_t rows[BLOCK];
} block;

typedef struct crowd {
    stroke_set *set;
    float       cell;          /* pixels */
    int32_t     columns, rows; /* of blocks */
    uint32_t   *numbers;       /* per block: 1 + its position in `blocks`, 0: nothing in it is marked */
    block      *blocks;
    size_t      block_count, block_capacity;
} crowd;

static bool is_marked(const crowd *c, int32_t column, int32_t row)
{
    if (column < 0 || row < 0 || column >= c->columns * BLOCK || row >= c->rows * BLOCK)
        return false;
    uint32_t number = c->numbers[(size_t)(row / BLOCK) * (size_t)c->columns + (size_t)(column / BLOCK)];
    return number && c->blocks[number - 1].rows[row % BLOCK] >> (column % BLOCK) & 1;
}

static bool is_traced(const crowd *c, float x, float y)
{
    int32_t column = (int32_t)(x / c->cell), row = (int32_t)(y / c->cell);
    for (int32_t r = row - 1; r <= row + 1; r++)
        for (int32_t k = column - 1; k <= column + 1; k++)
            if (is_marked(c, k, r))
                return true;
    return false;
}

static bool put_trace(crowd *c, float x, float y)
{
    int32_t column = (int32_t)(x / c->cell), row = (int32_t)(y / c->cell);
    if (column < 0 || row < 0 || column >= c->columns * BLOCK || row >= c->rows * BLOCK)
        return true;
    uint32_t *number = &c->numbers[(size_t)(row / BLOCK) * (size_t)c->columns + (size_t)(column / BLOCK)];
    if (!*number) {
        if (!mem_grow((void **)&c->blocks, &c->block_capacity, c->block_count + 1, sizeof *c->blocks))
            return false;
        memset(&c->blocks[c->block_count++], 0, sizeof *c->blocks);
        *number = (uint32_t)c->block_count;
    }
    c->blocks[*number - 1].rows[row % BLOCK] |= UINT64_C(1) << (column % BLOCK);
    return true;
}

/* Steps along a stroke. Tracing: marks every position; else: asks whether all are near marked ones. False: out of
 * memory, or one is not. */
static bool step_along(crowd *c, const stroke *s, bool trace)
{
    const stroke_point *p = &c->set->points[s->first];
    for (uint32_t i = 0; i + 1 < s->count; i++) {
        float x = p[i + 1].x - p[i].x, y = p[i + 1].y - p[i].y, length = sqrtf(x * x + y * y);
        int   steps = (int)(length / c->cell) + 1;
        for (int k = 0; k < steps; k++) {
            float fraction = (float)k / (float)steps;
            if (trace ? !put_trace(c, p[i].x + fraction * x, p[i].y + fraction * y)
                      : !is_traced(c, p[i].x + fraction * x, p[i].y + fraction * y))
                return false;
        }
    }
    p += s->count - 1;
    return trace ? put_trace(c, p->x, p->y) : is_traced(c, p->x, p->y);
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

static bool mark_kept(crowd *c, const ranked *ranks, uint8_t *kept)
{
    for (size_t i = 0; i < c->set->stroke_count; i++) {
        const stroke *s = &c->set->strokes[ranks[i].number];
        kept[ranks[i].number] = !step_along(c, s, false);
        if (kept[ranks[i].number] && !step_along(c, s, true))
            return false;
    }
    return true;
}

lmn_status strokes_thin(stroke_set *set, float apart, int width, int height, lmn_error *error)
{
    if (!(apart > 0.01f) || set->stroke_count < 2)
        return LMN_OK;
    crowd c = {.set = set, .cell = apart * CELL};
    c.columns = (int32_t)((float)width / (c.cell * BLOCK)) + 1;
    c.rows = (int32_t)((float)height / (c.cell * BLOCK)) + 1;
    c.numbers = mem_calloc((size_t)c.columns * (size_t)c.rows, sizeof *c.numbers);
    ranked  *ranks = mem_alloc(set->stroke_count * sizeof *ranks);
    uint8_t *kept = mem_calloc(set->stroke_count, 1);
    bool     good = c.numbers && ranks && kept;
    if (good) {
        for (uint32_t i = 0; i < set->stroke_count; i++) {
            const stroke *s = &set->strokes[i];
            ranks[i] = (ranked){i, s->hidden_by, (int)s->kind,
                                set->points[s->first + s->count - 1].arc - set->points[s->first].arc};
        }
        qsort(ranks, set->stroke_count, sizeof *ranks, compare_ranks);
        good = mark_kept(&c, ranks, kept);
    }
    size_t count = 0;
    for (size_t i = 0; i < set->stroke_count && good; i++)
        if (kept[i])
            set->strokes[count++] = set->strokes[i];
    if (good)
        set->stroke_count = count;
    mem_free(c.numbers);
    mem_free(c.blocks);
    mem_free(ranks);
    mem_free(kept);
    return good ? LMN_OK : error_memory(error);
}
