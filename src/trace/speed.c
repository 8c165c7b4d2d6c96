/* Speed lines: ways of positions at the rear, from a little behind what moves to where the line's length ends. They are
 * cut where they would lie on what moves, and where something is in front of them. */
#include "trace/trace_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Ways are looked at so often: units. */
#define APART 1.5
/* Shorter pieces are left out: widths. */
#define SHORTEST 2.0
/* A step that is longer than this fraction of the way, and than so many mean ones, is a jump. */
#define JUMP_FRACTION 0.25
#define JUMP_STEPS    8.0
/* Lengths differ by this fraction of the longest, times `uneven`. */
#define LENGTHS_APART 0.6
/* Fading lines are opaque up to so far from their end, fraction of their length: else they look shorter than they are.
 */
#define FADES 0.4
/* Where what moves was slower than this fraction of how fast it was since, it has turned or begun: there lines end. */
#define SLOW 0.12
/* Those that begin on a circle begin so far from its middle, radii. */
#define CIRCLE 1.1
static const double pi = 3.14159265358979323846;

/* A way as it is drawn: points that are close together, with the length up to each. */
typedef struct way {
    double (*at)[3];
    double *arcs;
    bool   *shown;
    size_t  count, capacity, arc_capacity, shown_capacity;
} way;

static void release_way(way *w)
{
    mem_free(w->at);
    mem_free(w->arcs);
    mem_free(w->shown);
}

static bool put_point(way *w, const double p[3])
{
    if (!mem_grow((void **)&w->at, &w->capacity, w->count + 1, sizeof *w->at) ||
        !mem_grow((void **)&w->arcs, &w->arc_capacity, w->count + 1, sizeof *w->arcs) ||
        !mem_grow((void **)&w->shown, &w->shown_capacity, w->count + 1, sizeof *w->shown))
        return false;
    double arc =
        w->count ? w->arcs[w->count - 1] + hypot(p[0] - w->at[w->count - 1][0], p[1] - w->at[w->count - 1][1]) : 0;
    memcpy(w->at[w->count], p, sizeof *w->at);
    w->arcs[w->count++] = arc;
    return true;
}

static bool put_step(way *w, const double *from, const double *to)
{
    double length = hypot(to[0] - from[0], to[1] - from[1]), pieces = fmin(fmax(ceil(length / APART), 1), 4096);
    for (double n = 1; n <= pieces; n++) {
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = from[k] + n / pieces * (to[k] - from[k]);
        if (!put_point(w, p))
            return false;
    }
    return true;
}

/* The step before which a way turns back: within an eighth of it the heading changes by more than a quarter turn, and
 * by no steady turning. What came before that is another motion. */
static uint32_t turns_back(const trace_body *b, const double (*at)[3], uint32_t steps)
{
    uint32_t apart = steps / 8 > 1 ? steps / 8 : 1;
    for (uint32_t k = apart + 1; k <= steps && !b->round; k++) {
        const double *p = at[k], *q = at[k - apart];
        double        x = p[0] - p[-3], y = p[1] - p[-2], u = q[0] - q[-3], v = q[1] - q[-2];
        if (x * u + y * v < -0.2 * hypot(x, y) * hypot(u, v))
            return k - (apart + 1) / 2;
    }
    return steps;
}

/* The way of one origin, ended where it jumps or turns back. */
static bool take_way(way *w, trace_job *j, size_t origin)
{
    uint32_t steps = j->ways.steps;
    double(*at)[3] = j->ways.at + origin * (steps + 1);
    double whole = 0;
    for (uint32_t k = 1; k <= steps; k++)
        whole += hypot(at[k][0] - at[k - 1][0], at[k][1] - at[k - 1][1]);
    w->count = 0;
    if (!isfinite(at[0][0]) || !isfinite(whole))
        return true;
    bool     good = put_point(w, at[0]);
    double   fastest = 0;
    uint32_t last = turns_back(&j->bodies.bodies[j->origins.items[origin].body], (const double(*)[3])at, steps);
    for (uint32_t k = 1; k <= last && good; k++) {
        double step = hypot(at[k][0] - at[k - 1][0], at[k][1] - at[k - 1][1]);
        fastest = fmax(fastest, step);
        if (step < SLOW * fastest)
            break;
        if (step > JUMP_FRACTION * whole && step * (steps - 1) > JUMP_STEPS * (whole - step)) {
            j->facts->jumps++;
            break;
        }
        good = put_step(w, at[k - 1], at[k]);
    }
    return good;
}

/* How far from its middle what comes nearer reaches, and which of how many rays one is. */
static void look_around(const trace_job *j, size_t origin, double *radius, uint32_t *count)
{
    uint32_t          body = j->origins.items[origin].body;
    const trace_body *b = &j->bodies.bodies[body];
    *radius = 0;
    *count = 0;
    for (uint32_t i = b->first; i < b->first + b->count; i++)
        for (int k = 0; k < 3; k++) {
            const double *p = j->bodies.now[j->bodies.triangles[i][k]];
            *radius = fmax(*radius, hypot(p[0] - b->centre[0], p[1] - b->centre[1]));
        }
    for (size_t i = 0; i < j->origins.count; i++)
        *count += j->origins.items[i].body == body;
}

/* How far a position has gone on the page during the exposure. */
double way_length(const trace_ways *w, size_t origin)
{
    double whole = 0;
    for (uint32_t k = 1; k <= w->steps; k++) {
        const double *p = w->at[origin * (w->steps + 1) + k];
        whole += hypot(p[0] - p[-3], p[1] - p[-2]);
    }
    return whole;
}

/* A ray that begins on a circle around what comes nearer, after Song (2005): all at equal angles. */
static bool take_ray_of_circle(way *w, trace_job *j, size_t origin, double depth)
{
    const trace_body *b = &j->bodies.bodies[j->origins.items[origin].body];
    uint32_t          count, number = 0;
    double            radius;
    look_around(j, origin, &radius, &count);
    for (size_t i = 0; i < origin; i++)
        number += j->origins.items[i].body == j->origins.items[origin].body;
    double angle = 2 * pi * number / count, x = cos(angle), y = sin(angle), near = CIRCLE * radius,
           far = near + way_length(&j->ways, origin);
    const double from[3] = {b->centre[0] + near * x, b->centre[1] + near * y, depth},
                 to[3] = {b->centre[0] + far * x, b->centre[1] + far * y, depth};
    return put_point(w, from) && put_step(w, from, to);
}

/* A straight ray away from the middle of what comes nearer, as long as the way of its rim. */
static bool take_ray(way *w, trace_job *j, size_t origin)
{
    const trace_body *b = &j->bodies.bodies[j->origins.items[origin].body];
    const double     *p = j->ways.at[origin * (j->ways.steps + 1)];
    double            x = p[0] - b->centre[0], y = p[1] - b->centre[1];
    w->count = 0;
    if (!isfinite(x) || !isfinite(y))
        return true;
    if (j->o->values->origin == TRACES_CIRCLE)
        return take_ray_of_circle(w, j, origin, p[2]);
    const double longer = way_length(&j->ways, origin) / fmax(hypot(x, y), 1e-9),
                 to[3] = {p[0] + longer * x, p[1] + longer * y, p[2]};
    return put_point(w, p) && put_step(w, p, to);
}

/* Which points are neither on what moves nor behind anything. */
static void see(way *w, const trace_job *j, uint32_t part)
{
    for (size_t i = 0; i < w->count; i++)
        w->shown[i] = !page_mask_has(&j->mask, w->at[i][0], w->at[i][1]) && nothing_hides(j->o, part, w->at[i]);
}

/* Half the width and the opacity at a fraction of the line, 0 where it begins. */
static void profile(const traces_values *v, double at, float *half, float *alpha)
{
    double left = fmax(1 - at, 0), wide = 1, opaque = 1;
    if (v->ends == TRACES_FADING) {
        wide = 0.35 + 0.65 * left;
        opaque = fmin(1, left / FADES);
    } else if (v->ends == TRACES_HEAVY)
        wide = 0.3 + 0.7 * left * left;
    else
        wide = 2 * left;
    *half = (float)(0.5 * (double)v->width * wide);
    *alpha = (float)opaque;
}

/* The runs of what is shown between two lengths, moved aside. */
static bool put_runs(trace_job *j, const way *w, const trace_origin *origin, uint32_t number, double from, double to,
                     double aside)
{
    const traces_values *v = j->o->values;
    ribbon_point        *points = mem_alloc((w->count + 1) * sizeof *points);
    bool                 good = points != NULL;
    uint32_t             part = j->bodies.meshes[origin->mesh].part + 1;
    size_t               count = 0;
    for (size_t i = 0; i <= w->count && good; i++) {
        bool inside = i < w->count && w->shown[i] && w->arcs[i] >= from && w->arcs[i] <= to;
        if (!inside) {
            if (count > 1 && (double)(points[count - 1].arc - points[0].arc) >= SHORTEST * (double)v->width)
                good = put_ribbon(j, STROKE_SPEED, part, (uint64_t)origin->body << 32 | number, points, count);
            count = 0;
            continue;
        }
        size_t        a = i > 0 ? i - 1 : i, b = i + 1 < w->count ? i + 1 : i;
        double        x = w->at[b][0] - w->at[a][0], y = w->at[b][1] - w->at[a][1], length = fmax(hypot(x, y), 1e-9);
        ribbon_point *p = &points[count++];
        *p = (ribbon_point){.x = (float)(w->at[i][0] - aside * y / length),
                            .y = (float)(w->at[i][1] + aside * x / length),
                            .depth = (float)w->at[i][2],
                            .arc = (float)w->arcs[i]};
        profile(v, (w->arcs[i] - from) / fmax(to - from, 1e-9), &p->half, &p->alpha);
    }
    mem_free(points);
    return good;
}

/* Where a way has left what moves for the first time. */
static double leaves_at(const trace_job *j, const way *w)
{
    for (size_t i = 0; i < w->count; i++)
        if (!page_mask_has(&j->mask, w->at[i][0], w->at[i][1]))
            return w->arcs[i];
    return INFINITY;
}

/* Where a line ends that begins so far along its way, by what it is shortened. */
static double end_of(const trace_job *j, const way *w, const trace_origin *origin, double begin, double shorter)
{
    double whole = w->arcs[w->count - 1];
    return fmin(begin + (double)j->o->values->length * origin->longest * whole * (1 - shorter), whole);
}

static bool put_line(trace_job *j, const way *w, const trace_origin *origin)
{
    const traces_values *v = j->o->values;
    uint32_t             frame = (uint32_t)llround(j->o->pose->when.seconds * 1000);
    double               begin = leaves_at(j, w) + (double)v->begin;
    for (int32_t g = 0; g < v->groups && isfinite(begin); g++) {
        uint32_t number = origin->number * TRACE_GROUPS + (uint32_t)g;
        if (trace_random(j->o, origin->body, number, 16 + frame) >= (double)v->probability)
            continue;
        double shorter = LENGTHS_APART * (double)v->uneven * trace_random(j->o, origin->body, number, 2),
               end = end_of(j, w, origin, begin, shorter),
               aside = (double)v->group_apart * (g - 0.5 * (v->groups - 1) +
                                                 (g ? 0.5 * (trace_random(j->o, origin->body, number, 3) - 0.5) : 0));
        if (!put_runs(j, w, origin, number, begin, end, v->groups > 1 ? aside : 0))
            return false;
    }
    return true;
}

lmn_status speed_lines_put(trace_job *j, lmn_error *error)
{
    way        w = {NULL};
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < j->origins.count && status == LMN_OK; i++) {
        const trace_origin *origin = &j->origins.items[i];
        bool                ray = j->bodies.bodies[origin->body].motion == MOVES_TOWARDS;
        if (!(ray ? take_ray(&w, j, i) : take_way(&w, j, i)))
            status = error_memory(error);
        if (status == LMN_OK && w.count > 1)
            see(&w, j, j->bodies.meshes[origin->mesh].part);
        if (status == LMN_OK && w.count > 1 && !put_line(j, &w, origin))
            status = error_memory(error);
    }
    release_way(&w);
    return status;
}

/* --- heights -------------------------------------------------------------------------------------------------- */

/* Heights are looked at so often: units, and at most. */
#define HEIGHTS_APART 1.0
enum { HEIGHTS_LEAST = 33, HEIGHTS_MOST = 512 };

void heights_release(trace_heights *h)
{
    mem_free(h->open);
    mem_free(h->first);
}

/* Has a line beside all that moves the shortest length that is drawn, even where it is shortened by chance? */
static bool is_open(const trace_job *j, const way *w, const trace_origin *origin)
{
    const traces_values *v = j->o->values;
    double               begin = leaves_at(j, w) + (double)v->begin, run = INFINITY;
    if (!isfinite(begin))
        return false;
    double end = end_of(j, w, origin, begin, LENGTHS_APART * (double)v->uneven);
    for (size_t i = 0; i < w->count && w->arcs[i] <= end; i++) {
        bool beside = w->arcs[i] >= begin && !page_mask_has(&j->mask, w->at[i][0], w->at[i][1]) &&
                      !is_cut_away(j->o, j->bodies.meshes[origin->mesh].part, w->at[i]);
        run = beside ? fmin(run, w->arcs[i]) : INFINITY;
        if (w->arcs[i] - run >= SHORTEST * (double)v->width)
            return true;
    }
    return false;
}

static uint32_t heights_of(const trace_body *b)
{
    double wide = b->motion == MOVES_TOWARDS ? HEIGHTS_LEAST : (b->across[1] - b->across[0]) / HEIGHTS_APART;
    return b->round ? 0 : (uint32_t)fmin(fmax(wide, HEIGHTS_LEAST), HEIGHTS_MOST);
}

/* Lines from many heights are tried. Walls do not count: what is behind one has its lines there, too. */
lmn_status heights_find(trace_heights *out, trace_job *j, lmn_error *error)
{
    const size_t count = j->bodies.body_count;
    uint32_t     all = 0;
    bool         good;
    way          w = {NULL};
    out->first = mem_calloc(count + 1, sizeof *out->first);
    for (size_t i = 0; i < count && out->first; i++)
        out->first[i + 1] = all += heights_of(&j->bodies.bodies[i]);
    out->open = mem_calloc((size_t)all + 1, sizeof *out->open);
    good = out->first && out->open;
    for (uint32_t i = 0; i < count && good; i++)
        good = j->bodies.bodies[i].round ||
               origins_of_heights(&j->origins, &j->bodies, i, out->first[i + 1] - out->first[i]);
    lmn_status status = good ? LMN_OK : error_memory(error);
    size_t     jumps = j->facts->jumps;
    if (status == LMN_OK)
        status = ways_follow(&j->ways, j->o, &j->bodies, j->origins.items, j->origins.count, error);
    for (size_t i = 0; i < j->origins.count && status == LMN_OK; i++) {
        const trace_origin *origin = &j->origins.items[i];
        bool                ray = j->bodies.bodies[origin->body].motion == MOVES_TOWARDS;
        if (!(ray ? take_ray(&w, j, i) : take_way(&w, j, i)))
            status = error_memory(error);
        if (status == LMN_OK && w.count > 1)
            out->open[out->first[origin->body] + origin->number] = is_open(j, &w, origin);
    }
    j->facts->jumps = jumps;
    release_way(&w);
    ways_release(&j->ways);
    mem_free(j->origins.items);
    memset(&j->origins, 0, sizeof j->origins);
    return status;
}
