/* Lines that lie on lines. What runs all its length within a fraction of a pixel of more important lines adds nothing but ink: seams of parts that touch, hidden edges right behind
 * visible ones, the dozens of edges in which a finely divided surface turns away. Visible comes before hidden, then the order of the classes, then the longer one. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Lines are looked at so often, pixels. */
#define STEP 0.5f

typedef struct trace_point {
    float    x, y;
    uint32_t next;
} trace_point;

typedef struct crowd {
    stroke_set  *set;
    float        apart;
    uint32_t    *heads; /* hash table of cells */
    size_t       mask;
    trace_point *traces; /* along strokes that stay */
    size_t       trace_count, trace_capacity;
} crowd;

static size_t cell_hash(int32_t column, int32_t row)
{
    return (size_t)(((uint64_t)(uint32_t)column * UINT64_C(0x9E3779B97F4A7C15) ^ (uint64_t)(uint32_t)row * UINT64_C(0xC2B2AE3D27D4EB4F)) >> 24);
}

static bool is_traced(const crowd *c, float x, float y)
{
    int32_t c0 = (int32_t)floorf(x - c->apart), c1 = (int32_t)floorf(x + c->apart), r0 = (int32_t)floorf(y - c->apart), r1 = (int32_t)floorf(y + c->apart);
    for (int32_t r = r0; r <= r1; r++)
        for (int32_t k = c0; k <= c1; k++)
            for (uint32_t i = c->heads[cell_hash(k, r) & c->mask]; i != NO_VERTEX; i = c->traces[i].next) {
                float dx = c->traces[i].x - x, dy = c->traces[i].y - y;
                if (dx * dx + dy * dy <= c->apart * c->apart)
                    return true;
            }
    return false;
}

static bool put_trace(crowd *c, float x, float y)
{
    if (!mem_grow((void **)&c->traces, &c->trace_capacity, c->trace_count + 1, sizeof *c->traces))
        return false;
    uint32_t *head = &c->heads[cell_hash((int32_t)floorf(x), (int32_t)floorf(y)) & c->mask];
    c->traces[c->trace_count] = (trace_point){x, y, *head};
    *head = (uint32_t)c->trace_count++;
    return true;
}

/* Steps along a stroke. Tracing: puts every place; else: asks whether all are traced. False: out of memory, or one is not. */
static bool step_along(crowd *c, const stroke *s, bool trace)
{
    const stroke_point *p = &c->set->points[s->first];
    for (uint32_t i = 0; i + 1 < s->count; i++) {
        float x = p[i + 1].x - p[i].x, y = p[i + 1].y - p[i].y, length = sqrtf(x * x + y * y);
        int steps = (int)(length / STEP) + 1;
        for (int k = 0; k < steps; k++) {
            float share = (float)k / (float)steps;
            if (trace ? !put_trace(c, p[i].x + share * x, p[i].y + share * y) : !is_traced(c, p[i].x + share * x, p[i].y + share * y))
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

lmn_status strokes_thin(stroke_set *set, float apart, lmn_error *error)
{
    if (!(apart > 0) || set->stroke_count < 2)
        return LMN_OK;
    size_t slots = 1024;
    while (slots < set->point_count * 8)
        slots *= 2;
    crowd c = {.set = set, .apart = apart, .heads = mem_alloc(slots * sizeof *c.heads), .mask = slots - 1};
    ranked *ranks = mem_alloc(set->stroke_count * sizeof *ranks);
    uint8_t *kept = mem_calloc(set->stroke_count, 1);
    bool good = c.heads && ranks && kept;
    if (good) {
        memset(c.heads, 0xFF, slots * sizeof *c.heads);
        for (uint32_t i = 0; i < set->stroke_count; i++) {
            const stroke *s = &set->strokes[i];
            ranks[i] = (ranked){i, s->hidden_by, (int)s->kind, set->points[s->first + s->count - 1].arc - set->points[s->first].arc};
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
    mem_free(c.heads);
    mem_free(c.traces);
    mem_free(ranks);
    mem_free(kept);
    return good ? LMN_OK : error_memory(error);
}
