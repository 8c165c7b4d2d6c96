/* Strokes whose ends almost touch become one. The outline of a polygon mesh jumps from one row of edges to the next
 * over edges that no one ever sees; on the page the pieces follow each other, and a hand would draw them in one go. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Ends this far apart are joined, pixels; those closer than OVERLAP even where one runs past the other. */
#define GAP     1.0f
#define OVERLAP 0.7f
/* Sharp lines whose ends are closer than this have been ended there, at a corner. */
#define TOUCH 0.02f
/* How much of a stroke says which way its end points, pixels. */
#define REACH 2.5f
/* Cosine of how much a joined stroke may turn, and how much deeper it may go on, in pixels. */
#define TURN  0.6f
#define DEPTH 12.0f

/* An end of a stroke: number 2 · stroke, + 1 for its last point. */
typedef struct stroke_end {
    float   x, y, depth;
    float   out_x, out_y; /* unit: away from the stroke */
    int32_t column, row;
} stroke_end;

typedef struct candidate {
    float    cost;
    uint32_t ends[2];
} candidate;

typedef struct joiner {
    stroke_set *set;
    double      focal;
    bool        orthographic;
    stroke_end *ends;
    uint32_t   *heads, *nexts; /* hash table of cells */
    size_t      mask;
    candidate  *candidates;
    size_t      candidate_count, candidate_capacity;
    uint32_t   *partners;    /* per end; NO_VERTEX: none */
    uint32_t   *first_marks; /* per chain, and one more */
} joiner;

static stroke_end end_of(const joiner *j, uint32_t number)
{
    const stroke       *s = &j->set->strokes[number / 2];
    const stroke_point *p = &j->set->points[s->first], *from = number & 1 ? p + s->count - 1 : p, *to = from;
    float               x = 0, y = 0;
    for (uint32_t i = 1; i < s->count && x * x + y * y < REACH * REACH; i++) {
        to = number & 1 ? from - i : from + i;
        x = from->x - to->x;
        y = from->y - to->y;
    }
    float length = sqrtf(x * x + y * y);
    float fraction = length > 0 ? 1 / length : 0;
    return (stroke_end){from->x,
                        from->y,
                        from->depth,
                        x * fraction,
                        y * fraction,
                        (int32_t)floorf(from->x / GAP),
                        (int32_t)floorf(from->y / GAP)};
}

static size_t cell_hash(int32_t column, int32_t row)
{
    return (size_t)((uint64_t)(uint32_t)column * UINT64_C(0x9E3779B97F4A7C15) ^
                    (uint64_t)(uint32_t)row * UINT64_C(0xC2B2AE3D27D4EB4F)) >>
           20;
}

static bool put_ends(joiner *j)
{
    size_t count = 2 * j->set->stroke_count, slots = 64;
    while (slots < count)
        slots *= 2;
    j->mask = slots - 1;
    j->ends = mem_alloc((count + 1) * sizeof *j->ends);
    j->nexts = mem_alloc((count + 1) * sizeof *j->nexts);
    j->partners = mem_alloc((count + 1) * sizeof *j->partners);
    j->heads = mem_alloc(slots * sizeof *j->heads);
    if (!j->ends || !j->nexts || !j->partners || !j->heads)
        return false;
    memset(j->heads, 0xFF, slots * sizeof *j->heads);
    memset(j->partners, 0xFF, (count + 1) * sizeof *j->partners);
    for (uint32_t i = 0; i < count; i++) {
        j->ends[i] = end_of(j, i);
        uint32_t *head = &j->heads[cell_hash(j->ends[i].column, j->ends[i].row) & j->mask];
        j->nexts[i] = *head;
        *head = i;
    }
    return true;
}

/* What joining two ends costs; below 0: they are not joined. */
static float cost_of(const joiner *j, uint32_t a, uint32_t b)
{
    const stroke     *s = &j->set->strokes[a / 2], *t = &j->set->strokes[b / 2];
    const stroke_end *p = &j->ends[a], *q = &j->ends[b];
    if (s->kind != t->kind || s->part != t->part || s->smooth != t->smooth || s->hidden_by != t->hidden_by ||
        s->closed || t->closed || (s == t && s->count < 4))
        return -1;
    float x = q->x - p->x, y = q->y - p->y, length = sqrtf(x * x + y * y),
          turn = -(p->out_x * q->out_x + p->out_y * q->out_y);
    double deeper = fabs((double)p->depth - q->depth) * j->focal / (j->orthographic ? 1 : p->depth);
    bool   corner =
        length < TOUCH && (s->kind == STROKE_CREASE || s->kind == STROKE_BORDER || s->kind == STROKE_MATERIAL);
    if (length > GAP || turn < TURN || deeper > DEPTH || corner)
        return -1;
    bool ahead = x * p->out_x + y * p->out_y >= TURN * length && -x * q->out_x - y * q->out_y >= TURN * length;
    return ahead || length < OVERLAP ? length + 1 - turn : -1;
}

static bool find_candidates(joiner *j, uint32_t a)
{
    const stroke_end *p = &j->ends[a];
    for (int32_t row = p->row - 1; row <= p->row + 1; row++)
        for (int32_t column = p->column - 1; column <= p->column + 1; column++)
            for (uint32_t b = j->heads[cell_hash(column, row) & j->mask]; b != NO_VERTEX; b = j->nexts[b]) {
                if (b <= a || j->ends[b].column != column || j->ends[b].row != row)
                    continue;
                float cost = cost_of(j, a, b);
                if (cost < 0)
                    continue;
                if (!mem_grow((void **)&j->candidates, &j->candidate_capacity, j->candidate_count + 1,
                              sizeof *j->candidates))
                    return false;
                j->candidates[j->candidate_count++] = (candidate){cost, {a, b}};
            }
    return true;
}

static int compare_candidates(const void *a, const void *b)
{
    const candidate *p = a, *q = b;
    if (p->cost != q->cost)
        return p->cost < q->cost ? -1 : 1;
    return p->ends[0] != q->ends[0]  ? (p->ends[0] < q->ends[0] ? -1 : 1)
           : p->ends[1] < q->ends[1] ? -1
                                     : p->ends[1] > q->ends[1];
}

/* The best ones first, each end once. */
static bool match_ends(joiner *j)
{
    for (uint32_t i = 0; i < 2 * j->set->stroke_count; i++)
        if (!find_candidates(j, i))
            return false;
    if (j->candidate_count)
        qsort(j->candidates, j->candidate_count, sizeof *j->candidates, compare_candidates);
    for (size_t i = 0; i < j->candidate_count; i++) {
        const uint32_t *ends = j->candidates[i].ends;
        if (j->partners[ends[0]] == NO_VERTEX && j->partners[ends[1]] == NO_VERTEX) {
            j->partners[ends[0]] = ends[1];
            j->partners[ends[1]] = ends[0];
        }
    }
    return true;
}

/* --- joined strokes ------------------------------------------------------------------------------------- */

typedef struct joined {
    stroke       *strokes;
    stroke_point *points;
    stroke_mark  *marks;
    size_t        stroke_count, point_count, mark_count, mark_capacity;
    bool          failed;
} joined;

/* Where the marks of each chain begin. */
static bool index_marks(joiner *j)
{
    const stroke_set *set = j->set;
    j->first_marks = mem_calloc(set->chain_count + 2, sizeof *j->first_marks);
    for (size_t i = 0; i < set->mark_count && j->first_marks; i++)
        j->first_marks[set->marks[i].chain + 1]++;
    for (size_t i = 0; i < set->chain_count && j->first_marks; i++)
        j->first_marks[i + 1] += j->first_marks[i];
    return j->first_marks != NULL;
}

/* Marks of a piece that goes into a joined stroke, which it enters at arc `from`. */
static void put_marks(joined *out, const joiner *j, uint32_t entry, float from, uint32_t chain)
{
    const stroke *s = &j->set->strokes[entry / 2];
    float         begin = j->set->points[s->first].arc, end = j->set->points[s->first + s->count - 1].arc;
    for (uint32_t i = j->first_marks[s->chain]; i < j->first_marks[s->chain + 1]; i++) {
        stroke_mark m = j->set->marks[i];
        if (m.arc < begin || m.arc > end)
            continue;
        if (!mem_grow((void **)&out->marks, &out->mark_capacity, out->mark_count + 1, sizeof *out->marks)) {
            out->failed = true;
            return;
        }
        out->marks[out->mark_count++] = (stroke_mark){m.id, chain, from + (entry & 1 ? end - m.arc : m.arc - begin)};
    }
}

/* Appends a stroke's points, the last first when it is entered at its last end. The first one is left out where it
 * only repeats the position that has been reached. */
static void put_points(joined *out, const stroke_set *set, uint32_t entry, bool goes_on)
{
    const stroke *s = &set->strokes[entry / 2];
    for (uint32_t i = goes_on ? 1 : 0; i < s->count; i++)
        out->points[out->point_count++] = set->points[s->first + (entry & 1 ? s->count - 1 - i : i)];
}

static void measure(joined *out, stroke *s)
{
    float arc = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        stroke_point *p = &out->points[s->first + i];
        if (i > 0)
            arc += hypotf(p->x - p[-1].x, p->y - p[-1].y);
        p->arc = arc;
    }
    s->chain_length = arc;
}

/* One stroke with all that is joined to it. `entry`: the end that it begins with. */
static void put_joined(joined *out, joiner *j, uint32_t entry, uint8_t *used)
{
    stroke   s = j->set->strokes[entry / 2];
    uint32_t first = entry;
    float    arc = 0;
    s.first = (uint32_t)out->point_count;
    bool alone = j->partners[entry ^ 1] == NO_VERTEX;
    if (!alone)
        s.chain = (uint32_t)j->set->chain_count++;
    for (uint32_t at = entry;;) {
        const stroke *piece = &j->set->strokes[at / 2];
        s.id = piece->id < s.id ? piece->id : s.id;
        put_points(out, j->set, at, at != first);
        if (!alone)
            put_marks(out, j, at, arc, s.chain);
        arc += j->set->points[piece->first + piece->count - 1].arc - j->set->points[piece->first].arc;
        used[at / 2] = 1;
        uint32_t next = j->partners[at ^ 1];
        s.closed = s.closed || next == first;
        if (next == NO_VERTEX || used[next / 2])
            break;
        at = next;
    }
    if (s.closed && !alone)
        out->points[out->point_count - 1] = out->points[s.first];
    s.count = (uint32_t)(out->point_count - s.first);
    if (!alone)
        measure(out, &s);
    out->strokes[out->stroke_count++] = s;
}

static bool put_all(joiner *j)
{
    stroke_set *set = j->set;
    joined      out = {mem_alloc((set->stroke_count + 1) * sizeof(stroke)),
                       mem_alloc((set->point_count + 1) * sizeof(stroke_point)),
                       NULL,
                       0,
                       0,
                       0,
                       0,
                       false};
    uint8_t    *used = mem_calloc(set->stroke_count + 1, 1);
    bool        good = out.strokes && out.points && used && index_marks(j);
    for (int rings = 0; rings < 2 && good; rings++) /* what has an end, then what has come full circle */
        for (uint32_t i = 0; i < set->stroke_count; i++) {
            bool first_free = j->partners[2 * i] == NO_VERTEX, last_free = j->partners[2 * i + 1] == NO_VERTEX;
            if (!used[i] && (rings || first_free || last_free))
                put_joined(&out, j, rings || first_free ? 2 * i : 2 * i + 1, used);
        }
    mem_free(used);
    good = good && !out.failed &&
           mem_grow((void **)&set->marks, &(size_t){set->mark_count}, set->mark_count + out.mark_count,
                    sizeof *set->marks);
    if (good && out.mark_count)
        memcpy(set->marks + set->mark_count, out.marks, out.mark_count * sizeof *out.marks);
    mem_free(out.marks);
    if (!good) {
        mem_free(out.strokes);
        mem_free(out.points);
        return false;
    }
    set->mark_count += out.mark_count;
    mem_free(set->strokes);
    mem_free(set->points);
    set->strokes = out.strokes;
    set->points = out.points;
    set->stroke_count = out.stroke_count;
    set->point_count = out.point_count;
    return true;
}

static int compare_strokes(const void *a, const void *b)
{
    const stroke *p = a, *q = b;
    if (p->kind != q->kind)
        return p->kind < q->kind ? -1 : 1;
    if (p->chain != q->chain)
        return p->chain < q->chain ? -1 : 1;
    return p->first < q->first ? -1 : p->first > q->first;
}

lmn_status strokes_join(stroke_set *set, const stroke_view *v, lmn_error *error)
{
    joiner j = {.set = set,
                .focal = 0.5 * v->camera.height * fabs(v->camera.projection.m[5]),
                .orthographic = v->camera.orthographic};
    bool   good = put_ends(&j) && match_ends(&j) && put_all(&j);
    if (good && set->stroke_count)
        qsort(set->strokes, set->stroke_count, sizeof *set->strokes, compare_strokes);
    mem_free(j.ends);
    mem_free(j.heads);
    mem_free(j.nexts);
    mem_free(j.candidates);
    mem_free(j.partners);
    mem_free(j.first_marks);
    return good ? LMN_OK : error_memory(error);
}
