/* Dots on a surface: many candidates, evenly shared out by area, of which those that crowd each other are taken away. Seed 001, section 5.4.7; rows EX-31, EX-32. */
#include "halftone/marks.h"

#include <math.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "halftone/random.h"

enum { CANDIDATES = 3 /* for each dot that is wanted */ };

static double triangle_area(const mark_surface *s, uint32_t t)
{
    const uint32_t *i = &s->indices[3 * (size_t)t];
    const vec3 *a = &s->places[i[0]], *b = &s->places[i[1]], *c = &s->places[i[2]];
    double u[3] = {(double)b->x - (double)a->x, (double)b->y - (double)a->y, (double)b->z - (double)a->z};
    double v[3] = {(double)c->x - (double)a->x, (double)c->y - (double)a->y, (double)c->z - (double)a->z};
    double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
    return 0.5 * sqrt(x * x + y * y + z * z);
}

double mark_surface_area(const mark_surface *s)
{
    double sum = 0;
    for (uint32_t t = 0; t < s->triangle_count; t++)
        sum += triangle_area(s, t);
    return sum;
}

static vec3 between(const vec3 *values, const uint32_t *i, const float share[2])
{
    const vec3 *a = &values[i[0]], *b = &values[i[1]], *c = &values[i[2]];
    float rest = 1 - share[0] - share[1];
    return (vec3){rest * a->x + share[0] * b->x + share[1] * c->x, rest * a->y + share[0] * b->y + share[1] * c->y,
                  rest * a->z + share[0] * b->z + share[1] * c->z};
}

static vec3 unit(vec3 v)
{
    float length = sqrtf(v.x * v.x + v.y * v.y + v.z * v.z);
    return length > 0 ? (vec3){v.x / length, v.y / length, v.z / length} : (vec3){0, 0, 1};
}

/* One candidate in each of `count` equal shares of the area, as the triangles follow each other. */
static void share_out(mark_dot *out, size_t count, const mark_surface *s, double area, uint32_t seed)
{
    random_source r = random_start(seed, 0x5711);
    double before = 0, own = triangle_area(s, 0);
    uint32_t t = 0;
    for (size_t i = 0; i < count; i++) {
        double at = ((double)i + random_unit(&r)) * area / (double)count;
        while (at > before + own && t + 1 < s->triangle_count) {
            before += own;
            own = triangle_area(s, ++t);
        }
        double a = random_unit(&r), b = random_unit(&r);
        if (a + b > 1) {
            a = 1 - a;
            b = 1 - b;
        }
        mark_dot *d = &out[i];
        *d = (mark_dot){.share = {(float)a, (float)b}, .triangle = t};
        d->place = between(s->places, &s->indices[3 * (size_t)t], d->share);
        d->normal = unit(between(s->normals, &s->indices[3 * (size_t)t], d->share));
    }
}

/* Ranks of the candidates; false when memory is gone. */
static bool rank(uint32_t *ranks, const mark_dot *candidates, size_t count, size_t wanted, double area, mark_way_fn way, void *user, double length)
{
    spread_place *points = mem_alloc(count * sizeof *points);
    for (size_t i = 0; points && i < count; i++)
        points[i] = (spread_place){candidates[i].place, candidates[i].normal, way ? way(user, &candidates[i]) : (vec3){0, 0, 0}};
    bool done = points && marks_eliminate(ranks, points, count, wanted, area, length);
    mem_free(points);
    return done;
}

lmn_status marks_stipple(marks *out, const mark_surface *s, size_t count, uint32_t seed, lmn_error *error)
{
    return marks_spread(out, s, count, seed, NULL, NULL, 0, error);
}

lmn_status marks_spread(marks *out, const mark_surface *s, size_t count, uint32_t seed, mark_way_fn way, void *user, double length, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->area = mark_surface_area(s);
    if (count > LIMIT_MARKS)
        return error_set(error, LMN_LIMIT, "%zu dots are more than %d", count, LIMIT_MARKS);
    if (count == 0 || !(out->area > 0))
        return LMN_OK;
    size_t many = count * CANDIDATES;
    mark_dot *candidates = mem_alloc(many * sizeof *candidates);
    uint32_t *ranks = mem_alloc(many * sizeof *ranks);
    out->dots = mem_alloc(count * sizeof *out->dots);
    bool done = candidates && ranks && out->dots;
    if (done) {
        share_out(candidates, many, s, out->area, seed);
        done = rank(ranks, candidates, many, count, out->area, way, user, length);
    }
    for (size_t i = 0; done && i < many; i++) {
        if (ranks[i] == UINT32_MAX)
            continue;
        candidates[i].priority = 1 - (float)ranks[i] / (float)count;
        out->dots[ranks[i]] = candidates[i];
    }
    out->dot_count = done ? count : 0;
    mem_free(candidates);
    mem_free(ranks);
    return done ? LMN_OK : error_memory(error);
}

void surface_marks_release(marks *m)
{
    mem_free(m->dots);
    mem_free(m->lines);
    memset(m, 0, sizeof *m);
}
