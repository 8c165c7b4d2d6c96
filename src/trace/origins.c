/* Where speed lines begin: at the rear of each body, across its motion from one extreme to the other, at heights that
 * are spread by chance within their strips. A height of its own, and not a vertex, is what a line keeps from frame to
 * frame; so it does not jump when another vertex becomes the rearmost. */
#include "trace/trace_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Lines are moved within their strips by this fraction of a strip at most, times `uneven`. */
#define SHAKEN 1.4
/* Of what lies all around its axis lines begin beyond the rim, so far as a fraction of the radius, on circles in turn;
 * no line reaches farther than this fraction of the way to the next one on its circle. */
#define BEYOND     1.04
#define RING_APART 0.07
#define OF_RING    0.7
enum { RINGS = 3 };
static const double pi = 3.14159265358979323846;

/* The rearmost position at a height. */
typedef struct rear {
    double   across, along;
    uint32_t from, to; /* vertices of all */
    double   fraction;
} rear;

double trace_random(const traces_options *o, uint32_t body, uint32_t line, uint32_t what)
{
    uint32_t n = o->seed * 0x9E3779B9u + body * 0x85EBCA6Bu + line * 0xC2B2AE35u + what * 0x27D4EB2Fu + 1;
    n = (n ^ n >> 16) * 0x7FEB352Du;
    n = (n ^ n >> 15) * 0x846CA68Bu;
    return (n ^ n >> 16) / 4294967296.0;
}

/* Where an edge has a height: up to two fractions of it. */
static int edge_at(const trace_body *b, const double *p, const double *q, double across, double out[2])
{
    double along[2], heights[2];
    body_coordinates(b, p, &along[0], &heights[0]);
    body_coordinates(b, q, &along[1], &heights[1]);
    if (b->motion != MOVES_AROUND) {
        double apart = heights[1] - heights[0];
        if (fabs(apart) > pi && b->motion == MOVES_TOWARDS) /* over the angle where counting begins */
            return 0;
        if ((heights[0] < across) == (heights[1] < across) && heights[0] != across && heights[1] != across)
            return 0;
        out[0] = apart != 0 ? fmin(fmax((across - heights[0]) / apart, 0), 1) : along[0] < along[1] ? 0 : 1;
        return 1;
    }
    /* |p + f (q − p) − c| = across. */
    double x = p[0] - b->centre[0], y = p[1] - b->centre[1], dx = q[0] - p[0], dy = q[1] - p[1];
    double a = dx * dx + dy * dy, half = x * dx + y * dy, root = half * half - a * (x * x + y * y - across * across);
    int    count = 0;
    for (int sign = -1; sign <= 1 && a > 0 && root >= 0; sign += 2) {
        double f = (-half + sign * sqrt(root)) / a;
        if (f >= -1e-9 && f <= 1 + 1e-9)
            out[count++] = fmin(fmax(f, 0), 1);
    }
    return count;
}

/* Takes one edge into account at one height. */
static void look_at_edge(rear *r, const trace_bodies *t, const trace_body *b, uint32_t from, uint32_t to)
{
    const double *p = t->now[from], *q = t->now[to];
    double        fractions[2];
    int           count = edge_at(b, p, q, r->across, fractions);
    for (int k = 0; k < count; k++) {
        const double at[3] = {p[0] + fractions[k] * (q[0] - p[0]), p[1] + fractions[k] * (q[1] - p[1]), 0};
        double       along, across;
        body_coordinates(b, at, &along, &across);
        if (along < r->along) {
            r->along = along;
            r->from = from;
            r->to = to;
            r->fraction = fractions[k];
        }
    }
}

/* Heights are in ascending order. */
static void find_rears(rear *rears, size_t count, const trace_bodies *t, const trace_body *b)
{
    for (uint32_t i = b->first; i < b->first + b->count; i++) {
        double low = INFINITY, high = -INFINITY, along, across;
        for (int k = 0; k < 3; k++) {
            body_coordinates(b, t->now[t->triangles[i][k]], &along, &across);
            low = fmin(low, across);
            high = fmax(high, across);
        }
        if (b->motion == MOVES_AROUND) /* an edge may pass nearer to the centre than both of its ends */
            low = 0;
        size_t first = 0, last = count;
        while (first < last) {
            size_t middle = (first + last) / 2;
            if (rears[middle].across < low)
                first = middle + 1;
            else
                last = middle;
        }
        for (size_t n = first; n < count && rears[n].across <= high; n++)
            for (int k = 0; k < 3; k++)
                look_at_edge(&rears[n], t, b, t->triangles[i][k], t->triangles[i][(k + 1) % 3]);
    }
}

static size_t count_open(const trace_heights *h, uint32_t body)
{
    size_t count = 0;
    for (uint32_t i = h->first[body]; i < h->first[body + 1]; i++)
        count += h->open[i];
    return count;
}

/* The height that a fraction of all open ones lie below: fractions 0 and 1 are the extremes of what is open. */
static double open_height(const trace_heights *h, uint32_t body, const trace_body *b, double fraction)
{
    uint32_t first = h->first[body], count = h->first[body + 1] - first;
    double   wanted = fraction * (double)(count_open(h, body) - 1), passed = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!h->open[first + i])
            continue;
        bool on = i + 1 < count && h->open[first + i + 1];
        if (passed + 1 > wanted || !(passed + 1 < (double)count_open(h, body)))
            return b->across[0] +
                   (b->across[1] - b->across[0]) * (i + (on ? wanted - passed : 0)) / fmax(count - 1.0, 1);
        passed++;
    }
    return b->across[0];
}

/* Heights of so many lines: both extremes of what is open, and between them one in each strip. */
static void spread_heights(rear *rears, size_t count, const traces_options *o, const trace_body *b, uint32_t number,
                           const trace_heights *h)
{
    double shaken = SHAKEN * (double)o->values->uneven;
    for (size_t i = 0; i < count; i++) {
        bool   extreme = (i == 0 || i + 1 == count) && count > 1 && b->motion != MOVES_TOWARDS;
        double at = count > 1 ? (double)i / (double)(count - 1) : 0.5,
               shake = extreme ? 0 : shaken * (trace_random(o, number, (uint32_t)i, 0) - 0.5) / (double)count;
        rears[i] = (rear){.across = open_height(h, number, b, fmin(fmax(at + shake, 0), 1)), .along = INFINITY};
    }
}

/* Hanl's: of each of equal strips the rearmost vertex. */
static void find_strip_vertices(rear *rears, size_t count, const trace_bodies *t, const trace_body *b)
{
    for (uint32_t i = b->first; i < b->first + b->count; i++)
        for (int k = 0; k < 3; k++) {
            double along, across, range = b->across[1] - b->across[0];
            body_coordinates(b, t->now[t->triangles[i][k]], &along, &across);
            double at = range > 0 ? (across - b->across[0]) / range : 0;
            size_t n = count > 2 && at > 0 && at < 1 ? 1 + (size_t)fmin(at * (double)(count - 2), (double)(count - 3))
                       : at >= 1                     ? count - 1
                                                     : 0;
            if (along < rears[n].along)
                rears[n] = (rear){across, along, t->triangles[i][k], t->triangles[i][k], 0};
        }
}

static bool put_item(origin_list *l, trace_origin item)
{
    if (!mem_grow((void **)&l->items, &l->capacity, l->count + 1, sizeof *l->items))
        return false;
    l->items[l->count++] = item;
    return true;
}

static bool put_origin(origin_list *l, const trace_bodies *t, const rear *r, uint32_t body, uint32_t number)
{
    uint32_t mesh = trace_mesh_of(t, r->from), first = t->meshes[mesh].first;
    return put_item(l, (trace_origin){.mesh = mesh,
                                      .vertex = {r->from - first, r->to - first},
                                      .fraction = r->fraction,
                                      .body = body,
                                      .number = number,
                                      .longest = 1});
}

/* A wheel: lines begin beyond the rim, on circles about its axis, at angles of their own. */
static bool put_round(origin_list *l, const traces_options *o, const trace_bodies *t, uint32_t number, uint32_t count)
{
    const trace_body *b = &t->bodies[number];
    uint32_t          mesh = trace_mesh_of(t, t->triangles[b->first][0]);
    bool              good = true;
    for (uint32_t n = 0; n < count && good; n++) {
        double ring = BEYOND + RING_APART * (n % RINGS), apart = RINGS * 2 * pi / fmax(count, RINGS),
               shaken = (double)o->values->uneven * (trace_random(o, number, n, 1) - 0.5),
               angle = 2 * pi * (n + shaken) / count;
        good = put_item(l, (trace_origin){.mesh = mesh,
                                          .beside = true,
                                          .at = body_circle(b, ring * b->radius, angle),
                                          .body = number,
                                          .number = n,
                                          .longest = fmin(OF_RING * apart / b->turn, 1)});
    }
    return good;
}

bool origins_of_heights(origin_list *out, const trace_bodies *bodies, uint32_t body, uint32_t heights)
{
    const trace_body *b = &bodies->bodies[body];
    rear             *rears = mem_alloc((heights + 1) * sizeof *rears);
    bool              good = rears != NULL;
    for (uint32_t i = 0; i < heights && good; i++)
        rears[i] = (rear){.across = b->across[0] + (b->across[1] - b->across[0]) * i / fmax(heights - 1.0, 1),
                          .along = INFINITY};
    if (good)
        find_rears(rears, heights, bodies, b);
    for (uint32_t i = 0; i < heights && good; i++)
        if (isfinite(rears[i].along))
            good = put_origin(out, bodies, &rears[i], body, i);
    mem_free(rears);
    return good;
}

static bool put_body(origin_list *l, const traces_options *o, const trace_bodies *t, uint32_t number, size_t count,
                     const trace_heights *h)
{
    const trace_body *b = &t->bodies[number];
    if (b->round)
        return put_round(l, o, t, number, (uint32_t)count);
    if (count_open(h, number) == 0)
        return true;
    rear *rears = mem_alloc((count + 1) * sizeof *rears);
    bool  good = rears != NULL;
    if (good) {
        spread_heights(rears, count, o, b, number, h);
        if (o->values->origin == TRACES_VERTICES)
            find_strip_vertices(rears, count, t, b);
        else
            find_rears(rears, count, t, b);
    }
    for (size_t i = 0; i < count && good; i++)
        if (isfinite(rears[i].along))
            good = put_origin(l, t, &rears[i], number, (uint32_t)i);
    mem_free(rears);
    return good;
}

/* What of a body's extent is open, times its speed. */
static double weight_of(const trace_bodies *t, uint32_t body, const trace_heights *h)
{
    const trace_body *b = &t->bodies[body];
    double            wide = b->motion == MOVES_TOWARDS ? 2 * pi : b->across[1] - b->across[0];
    uint32_t          heights = h->first[body + 1] - h->first[body];
    double            open = b->round ? 1 : (double)count_open(h, body) / fmax(heights, 1);
    return open * fmax(wide, 1) * b->speed;
}

bool origins_find(origin_list *out, const traces_options *o, const trace_bodies *bodies, const trace_heights *heights)
{
    double whole = 0, carried = 0;
    bool   good = true;
    memset(out, 0, sizeof *out);
    for (uint32_t i = 0; i < bodies->body_count; i++)
        whole += weight_of(bodies, i, heights);
    for (uint32_t i = 0; i < bodies->body_count && good && whole > 0; i++) {
        /* What rounding leaves goes to the next one, so that there are as many in all as were wished for. */
        carried += weight_of(bodies, i, heights) / whole * o->values->lines;
        double own = floor(carried + 0.5);
        carried -= own;
        if (own >= 1)
            good = put_body(out, o, bodies, i, (size_t)own, heights);
    }
    return good;
}
