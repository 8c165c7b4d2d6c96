/* Samples of lines in cells of space, so that those near a position are found. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "marks/streamlines.h"

static const double SAME_SIDE =
    0.6; /* cosine of normals above which it is one surface, not its back nor beyond a crease */
static const double SAME_DIRECTION = 0.5; /* and of lines above which they run side by side */

/* Cells of a block of four by four by four lie together, so that neighbours do in memory. */
static uint32_t bucket_of(const flow_grid *g, int32_t x, int32_t y, int32_t z)
{
    uint32_t h = (uint32_t)(x >> 2) * 73856093u ^ (uint32_t)(y >> 2) * 19349663u ^ (uint32_t)(z >> 2) * 83492791u;
    return ((h ^ h >> 15) << 6 | (uint32_t)((z & 3) << 4 | (y & 3) << 2 | (x & 3))) & g->mask;
}

static int32_t cell_of(const flow_grid *g, float at)
{
    float   scaled = at * g->cells;
    int32_t low = (int32_t)scaled;
    return low - ((float)low > scaled);
}

static uint32_t bucket_at(const flow_grid *g, vec3 at)
{
    return bucket_of(g, cell_of(g, at.x), cell_of(g, at.y), cell_of(g, at.z));
}

bool flow_grid_open(flow_grid *g, double apart, size_t count)
{
    uint32_t size = 1024;
    while (size < count && size < 1u << 24)
        size *= 2;
    flow_grid_release(g);
    g->buckets = mem_alloc((size_t)size * sizeof *g->buckets);
    if (!g->buckets)
        return false;
    memset(g->buckets, 0xFF, (size_t)size * sizeof *g->buckets);
    g->mask = size - 1;
    g->apart = apart;
    g->cells = (float)(1 / (1.2 * apart));
    return true;
}

void flow_grid_release(flow_grid *g)
{
    mem_free(g->samples);
    mem_free(g->buckets);
    *g = (flow_grid){.count = 0};
}

bool flow_grid_add(flow_grid *g, const flow_sample *s)
{
    if (!mem_grow((void **)&g->samples, &g->capacity, g->count + 1, sizeof *g->samples))
        return false;
    uint32_t bucket = bucket_at(g, s->at);
    g->samples[g->count] = *s;
    for (int k = 0; k < 3; k++)
        g->samples[g->count].cell[k] = cell_of(g, k == 0 ? s->at.x : k == 1 ? s->at.y : s->at.z);
    g->samples[g->count].next = g->buckets[bucket];
    g->buckets[bucket] = (uint32_t)g->count++;
    return true;
}

void flow_grid_shorten(flow_grid *g, size_t count)
{
    while (g->count > count) {
        const flow_sample *s = &g->samples[--g->count];
        g->buckets[bucket_at(g, s->at)] = s->next;
    }
}

static double product(vec3 a, vec3 b)
{
    return (double)a.x * (double)b.x + (double)a.y * (double)b.y + (double)a.z * (double)b.z;
}

static vec3 difference(vec3 a, vec3 b)
{
    return (vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

/* Calls for every sample in the cells around; false from it ends. */
typedef bool (*visit_fn)(const flow_sample *other, void *user);

static void visit(const flow_grid *g, vec3 at, double reach, visit_fn fn, void *user)
{
    int32_t from[3] = {cell_of(g, at.x - (float)reach), cell_of(g, at.y - (float)reach),
                       cell_of(g, at.z - (float)reach)},
            to[3] = {cell_of(g, at.x + (float)reach), cell_of(g, at.y + (float)reach), cell_of(g, at.z + (float)reach)};
    for (int32_t z = from[2]; z <= to[2]; z++)
        for (int32_t y = from[1]; y <= to[1]; y++)
            for (int32_t x = from[0]; x <= to[0]; x++)
                for (uint32_t i = g->buckets[bucket_of(g, x, y, z)]; i != UINT32_MAX; i = g->samples[i].next) {
                    const flow_sample *s = &g->samples[i];
                    if (s->cell[0] == x && s->cell[1] == y && s->cell[2] == z && !fn(s, user))
                        return;
                }
}

/* How far two samples of one line are from each other along it. */
static double between(const flow_sample *a, const flow_sample *b)
{
    double away = fabs((double)a->arc - (double)b->arc);
    return a->loop > 0 ? fmin(away, (double)a->loop - away) : away;
}

typedef struct near_query {
    const flow_sample *own;
    double             square, arcs;
    bool               found;
} near_query;

static bool find_near(const flow_sample *other, void *user)
{
    near_query *q = user;
    vec3        to = difference(other->at, q->own->at);
    if (other->body != q->own->body || (other->line == q->own->line && between(other, q->own) < q->arcs))
        return true;
    q->found = product(to, to) < q->square && product(other->normal, q->own->normal) > SAME_SIDE;
    return !q->found;
}

bool flow_grid_is_near(const flow_grid *g, const flow_sample *s, double distance, double own)
{
    near_query q = {.own = s, .square = distance * distance, .arcs = own};
    visit(g, s->at, distance, find_near, &q);
    return q.found;
}

typedef struct gap_query {
    const flow_sample *own;
    vec3               aside;
    double             reach, along;
    double            *out;
} gap_query;

/* Beside the sample, not before or behind it. */
static bool find_gap(const flow_sample *other, void *user)
{
    gap_query *q = user;
    if (other->body != q->own->body)
        return true;
    vec3   to = difference(other->at, q->own->at);
    double along = fabs(product(to, q->own->direction));
    if (along > q->along || (other->line == q->own->line && between(other, q->own) < 2 * q->reach))
        return true;
    double off = product(to, q->aside), size = sqrt(fmax(product(to, to) - along * along, 0));
    if (size > q->reach || product(other->normal, q->own->normal) < SAME_SIDE ||
        fabs(product(other->direction, q->own->direction)) < SAME_DIRECTION)
        return true;
    double *side = &q->out[off < 0];
    *side = fmin(*side, size);
    return true;
}

void flow_grid_gaps(const flow_grid *g, const flow_sample *s, double reach, double out[2])
{
    gap_query q = {.own = s, .reach = reach, .along = 0.3 * g->apart, .out = out};
    q.aside = (vec3){s->normal.y * s->direction.z - s->normal.z * s->direction.y,
                     s->normal.z * s->direction.x - s->normal.x * s->direction.z,
                     s->normal.x * s->direction.y - s->normal.y * s->direction.x};
    out[0] = out[1] = INFINITY;
    /* Outwards, box by box, until one is found. */
    for (int side = 0; side < 2; side++)
        for (double off = 0.5 * g->apart; off < reach + 0.25 * g->apart && out[side] > off; off += 0.5 * g->apart) {
            float by = (float)(side ? -off : off);
            vec3  at = {s->at.x + by * q.aside.x, s->at.y + by * q.aside.y, s->at.z + by * q.aside.z};
            visit(g, at, 0.5 * g->apart, find_gap, &q);
        }
}
