/* Segments to loops. In a closed mesh each vertex has as many segments in as out, so that walking along them always
 * comes back. Where it does not, ends that nearly meet are joined; what still does not close is walked in either
 * direction, which helps with triangles of mixed winding, and what is open then stays open. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "cut/cut_private.h"

/* Ends this near to each other, in parts of the part's extent, are the same point to whoever made the model. */
#define GAP 2e-5
/* Neighbours that are looked at for each end: where more lie within the gap, any will do. */
enum { GAP_NEIGHBOURS = 64 };

typedef struct outline {
    const cut_job *job;
    cut_segment   *segments; /* between positions in `vertices` */
    size_t         count, capacity;
    uint32_t      *vertices; /* ascending */
    size_t         vertex_count;
    int32_t       *excess; /* segments out − segments in; undirected: how many */
    uint32_t      *group;  /* union-find */
    bool           failed;
} outline;

static int compare_numbers(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static uint32_t position_in(const outline *o, uint32_t vertex)
{
    size_t low = 0, high = o->vertex_count;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (o->vertices[middle] <= vertex)
            low = middle;
        else
            high = middle;
    }
    return (uint32_t)low;
}

static bool number_vertices(outline *o)
{
    o->vertices = mem_alloc(2 * o->count * sizeof *o->vertices);
    if (!o->vertices)
        return false;
    for (size_t i = 0; i < o->count; i++) {
        o->vertices[2 * i] = o->segments[i].from;
        o->vertices[2 * i + 1] = o->segments[i].to;
    }
    qsort(o->vertices, 2 * o->count, sizeof *o->vertices, compare_numbers);
    for (size_t i = 0; i < 2 * o->count; i++)
        if (o->vertex_count == 0 || o->vertices[o->vertex_count - 1] != o->vertices[i])
            o->vertices[o->vertex_count++] = o->vertices[i];
    for (size_t i = 0; i < o->count; i++) {
        o->segments[i].from = position_in(o, o->segments[i].from);
        o->segments[i].to = position_in(o, o->segments[i].to);
    }
    o->excess = mem_calloc(o->vertex_count, sizeof *o->excess);
    o->group = mem_alloc(o->vertex_count * sizeof *o->group);
    return o->excess && o->group;
}

static uint32_t low_end(const cut_segment *s)
{
    return s->from < s->to ? s->from : s->to;
}

static uint32_t high_end(const cut_segment *s)
{
    return s->from < s->to ? s->to : s->from;
}

static int compare_segments(const void *a, const void *b)
{
    const cut_segment *s = a, *t = b;
    int                ends = (low_end(s) > low_end(t)) - (low_end(s) < low_end(t));
    if (ends == 0)
        ends = (high_end(s) > high_end(t)) - (high_end(s) < high_end(t));
    if (ends == 0)
        ends = (s->from > t->from) - (s->from < t->from);
    return ends ? ends : (s->primitive > t->primitive) - (s->primitive < t->primitive);
}

/* Drops what cancels: there and back, or with `any_direction` every second one. */
static size_t cancel(cut_segment *segments, size_t count, bool any_direction)
{
    size_t kept = 0;
    qsort(segments, count, sizeof *segments, compare_segments);
    for (size_t i = 0, end; i < count; i = end) {
        long net = 0;
        for (end = i; end < count && low_end(&segments[end]) == low_end(&segments[i]) &&
                      high_end(&segments[end]) == high_end(&segments[i]);
             end++)
            net += segments[end].from < segments[end].to ? 1 : -1;
        cut_segment s = segments[i];
        if (s.from == s.to)
            continue;
        if (any_direction)
            net = (long)(end - i) & 1;
        if ((net > 0) != (s.from < s.to))
            s = (cut_segment){s.to, s.from, s.primitive};
        for (long n = labs(net); n > 0; n--)
            segments[kept++] = s;
    }
    return kept;
}

static uint32_t group_of(uint32_t *group, uint32_t i)
{
    while (group[i] != i)
        i = group[i] = group[group[i]];
    return i;
}

static void find_groups(outline *o)
{
    for (uint32_t i = 0; i < o->vertex_count; i++)
        o->group[i] = i;
    for (size_t i = 0; i < o->count; i++) {
        uint32_t a = group_of(o->group, o->segments[i].from), b = group_of(o->group, o->segments[i].to);
        o->group[a > b ? a : b] = a > b ? b : a;
    }
}

/* --- gaps ----------------------------------------------------------------------------------------------- */

typedef struct loose_end {
    double   along; /* sorted by this: a direction that nothing in a model is likely to share */
    uint32_t position;
    int32_t  sign; /* 1: a chain begins here, −1: one ends here; 0: either, or taken */
    bool     taken;
} loose_end;

static int compare_ends(const void *a, const void *b)
{
    const loose_end *s = a, *t = b;
    int              along = (s->along > t->along) - (s->along < t->along);
    return along ? along : (s->position > t->position) - (s->position < t->position);
}

static double distance(const outline *o, uint32_t a, uint32_t b)
{
    const double *p = o->job->vertices[o->vertices[a]].world, *q = o->job->vertices[o->vertices[b]].world;
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2])) *
           o->job->scale;
}

static bool add_segment(outline *o, uint32_t from, uint32_t to)
{
    if (!mem_grow((void **)&o->segments, &o->capacity, o->count + 1, sizeof *o->segments))
        return false;
    o->segments[o->count++] = (cut_segment){from, to, 0};
    return true;
}

static bool join_end(outline *o, loose_end *ends, size_t count, size_t i)
{
    size_t best = count;
    double least = GAP;
    for (size_t k = i + 1; k < count && k < i + GAP_NEIGHBOURS && ends[k].along - ends[i].along <= GAP; k++) {
        if (ends[k].taken || ends[k].sign * ends[i].sign > 0 || (ends[k].sign == 0) != (ends[i].sign == 0))
            continue;
        double apart = distance(o, ends[i].position, ends[k].position);
        if (apart <= least) {
            least = apart;
            best = k;
        }
    }
    if (best == count)
        return true;
    ends[i].taken = ends[best].taken = true;
    uint32_t from = ends[i].sign < 0 ? ends[i].position : ends[best].position,
             to = ends[i].sign < 0 ? ends[best].position : ends[i].position;
    o->excess[from]++;
    o->excess[to] += ends[i].sign == 0 ? 1 : -1;
    return add_segment(o, from, to);
}

/* Joins ends that nearly meet; with `any_direction`, vertices with an odd number of segments. */
static bool join_gaps(outline *o, bool any_direction)
{
    size_t count = 0;
    for (size_t i = 0; i < o->vertex_count; i++)
        count += any_direction ? (size_t)(o->excess[i] & 1) : (size_t)abs(o->excess[i]);
    loose_end *ends = mem_alloc(count * sizeof *ends);
    if (!ends)
        return false;
    count = 0;
    for (uint32_t i = 0; i < o->vertex_count; i++) {
        const double *p = o->job->vertices[o->vertices[i]].world;
        double        along = (0.5377 * p[0] + 0.6532 * p[1] + 0.5332 * p[2]) * o->job->scale;
        int           copies = any_direction ? o->excess[i] & 1 : abs(o->excess[i]);
        for (int k = 0; k < copies && isfinite(along); k++)
            ends[count++] = (loose_end){along, i, any_direction ? 0 : o->excess[i] > 0 ? 1 : -1, false};
    }
    qsort(ends, count, sizeof *ends, compare_ends);
    bool done = true;
    for (size_t i = 0; i < count && done; i++)
        if (!ends[i].taken)
            done = join_end(o, ends, count, i);
    mem_free(ends);
    return done;
}

/* --- walking -------------------------------------------------------------------------------------------- */

/* Which segments leave each vertex. */
typedef struct walk {
    const outline     *outline;
    const cut_segment *segments;
    size_t             count;
    size_t            *starts, *next; /* per vertex */
    uint32_t          *leaving;
    bool              *used;
} walk;

static void walk_release(walk *w)
{
    mem_free(w->starts);
    mem_free(w->next);
    mem_free(w->leaving);
    mem_free(w->used);
}

static bool walk_make(walk *w, const outline *o, const cut_segment *segments, size_t count, bool any_direction)
{
    *w = (walk){o,
                segments,
                count,
                mem_calloc(o->vertex_count + 1, sizeof(size_t)),
                mem_alloc(o->vertex_count * sizeof(size_t)),
                mem_alloc(2 * count * sizeof(uint32_t)),
                mem_calloc(count, sizeof(bool))};
    if (!w->starts || !w->next || !w->leaving || !w->used)
        return false;
    for (size_t i = 0; i < count; i++) {
        w->starts[segments[i].from + 1]++;
        w->starts[segments[i].to + 1] += any_direction;
    }
    for (size_t v = 0; v < o->vertex_count; v++) {
        w->starts[v + 1] += w->starts[v];
        w->next[v] = w->starts[v];
    }
    for (uint32_t i = 0; i < count; i++) {
        w->leaving[w->next[segments[i].from]++] = i;
        if (any_direction)
            w->leaving[w->next[segments[i].to]++] = i;
    }
    memcpy(w->next, w->starts, o->vertex_count * sizeof(size_t));
    return true;
}

/* The segment to go on with; UINT32_MAX when all are used. */
static uint32_t leave(walk *w, uint32_t at)
{
    while (w->next[at] < w->starts[at + 1]) {
        uint32_t s = w->leaving[w->next[at]++];
        if (!w->used[s])
            return s;
    }
    return UINT32_MAX;
}

/* Walks from a segment's beginning until it comes back. Loops that do not are dropped. */
static bool walk_from(walk *w, uint32_t start, cut_loops *out, bool *closed)
{
    size_t   before = out->point_count;
    uint32_t at = start, primitive = 0;
    *closed = false;
    for (uint32_t s = leave(w, at); s != UINT32_MAX; s = leave(w, at)) {
        w->used[s] = true;
        if (out->point_count == before)
            primitive = w->segments[s].primitive;
        if (!mem_grow((void **)&out->points, &out->point_capacity, out->point_count + 1, sizeof *out->points))
            return false;
        out->points[out->point_count++] = w->outline->vertices[at];
        at = w->segments[s].from == at ? w->segments[s].to : w->segments[s].from;
        if (at == start) {
            *closed = true;
            break;
        }
    }
    if (!*closed || out->point_count - before < 3) {
        out->point_count = before;
        return true;
    }
    if (!mem_grow((void **)&out->primitives, &out->primitive_capacity, out->count + 1, sizeof *out->primitives) ||
        !mem_grow((void **)&out->starts, &out->start_capacity, out->count + 2, sizeof *out->starts))
        return false;
    out->primitives[out->count++] = primitive;
    out->starts[out->count] = out->point_count;
    return true;
}

static bool walk_all(outline *o, const cut_segment *segments, size_t count, bool any_direction, cut_loops *out)
{
    walk w;
    bool done = walk_make(&w, o, segments, count, any_direction), closed;
    /* Open chains first, from their ends, so that closed loops are left. */
    for (uint32_t v = 0; v < o->vertex_count && done && any_direction; v++)
        if (o->excess[v] & 1 && w.next[v] < w.starts[v + 1]) {
            size_t before = out->count, points = out->point_count;
            done = walk_from(&w, v, out, &closed);
            out->open = true;
            out->count = before;
            out->point_count = points;
        }
    for (size_t i = 0; i < count && done; i++)
        while (done && !w.used[i]) {
            done = walk_from(&w, segments[i].from, out, &closed);
            out->open = out->open || !closed;
        }
    walk_release(&w);
    return done;
}

/* Moves segments of groups with loose ends behind the others; returns how many others there are. */
static size_t part_closed(outline *o)
{
    bool        *loose = mem_calloc(o->vertex_count, sizeof *loose);
    cut_segment *copy = mem_copy(o->segments, o->count * sizeof *copy);
    size_t       closed = 0, back = o->count;
    if (!loose || !copy)
        o->failed = true;
    for (uint32_t i = 0; i < o->vertex_count && !o->failed; i++)
        if (o->excess[i])
            loose[group_of(o->group, i)] = true;
    for (size_t i = 0; i < o->count && !o->failed; i++) {
        if (loose[group_of(o->group, copy[i].from)])
            o->segments[--back] = copy[i];
        else
            o->segments[closed++] = copy[i];
    }
    mem_free(loose);
    mem_free(copy);
    return closed;
}

static bool chain(outline *o, cut_loops *out)
{
    if (!number_vertices(o))
        return false;
    o->count = cancel(o->segments, o->count, false);
    for (size_t i = 0; i < o->count; i++) {
        o->excess[o->segments[i].from]++;
        o->excess[o->segments[i].to]--;
    }
    if (!join_gaps(o, false))
        return false;
    find_groups(o);
    size_t closed = part_closed(o);
    if (o->failed || !walk_all(o, o->segments, closed, false, out))
        return false;
    out->directed = out->count;
    if (closed == o->count)
        return true;
    memmove(o->segments, o->segments + closed, (o->count - closed) * sizeof *o->segments);
    o->count = cancel(o->segments, o->count - closed, true);
    memset(o->excess, 0, o->vertex_count * sizeof *o->excess);
    for (size_t i = 0; i < o->count; i++) {
        o->excess[o->segments[i].from]++;
        o->excess[o->segments[i].to]++;
    }
    return join_gaps(o, true) && walk_all(o, o->segments, o->count, true, out);
}

bool outline_chain(cut_loops *out, const cut_job *j, cut_segment *segments, size_t count)
{
    memset(out, 0, sizeof *out);
    outline o = {.job = j, .segments = mem_copy(segments, count * sizeof *segments), .count = count, .capacity = count};
    bool    done = mem_grow((void **)&out->starts, &out->start_capacity, 1, sizeof *out->starts) && o.segments;
    if (done)
        out->starts[0] = 0;
    done = done && (count == 0 || chain(&o, out));
    mem_free(o.segments);
    mem_free(o.vertices);
    mem_free(o.excess);
    mem_free(o.group);
    return done;
}

void outline_release(cut_loops *l)
{
    mem_free(l->points);
    mem_free(l->starts);
    mem_free(l->primitives);
    memset(l, 0, sizeof *l);
}
