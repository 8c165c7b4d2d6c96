/* Dots on a surface: many candidates, evenly shared out by area, of which those that crowd each other are taken
 * away. Freudenberg 2003, section 5.4.7; rows EX-31, EX-32. */
#include "marks/marks.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/store.h"

enum { CANDIDATES = 3 /* for each dot that is wanted */ };

static double triangle_area(const mark_surface *s, uint32_t t)
{
    const uint32_t *i = &s->indices[3 * (size_t)t];
    const vec3     *a = &s->positions[i[0]], *b = &s->positions[i[1]], *c = &s->positions[i[2]];
    double          u[3] = {(double)b->x - (double)a->x, (double)b->y - (double)a->y, (double)b->z - (double)a->z};
    double          v[3] = {(double)c->x - (double)a->x, (double)c->y - (double)a->y, (double)c->z - (double)a->z};
    double          x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
    return 0.5 * sqrt(x * x + y * y + z * z);
}

double mark_surface_area(const mark_surface *s)
{
    double sum = 0;
    for (uint32_t t = 0; t < s->triangle_count; t++)
        sum += triangle_area(s, t);
    return sum;
}

static vec3 between(const vec3 *values, const uint32_t *i, const float fraction[2])
{
    const vec3 *a = &values[i[0]], *b = &values[i[1]], *c = &values[i[2]];
    float       rest = 1 - fraction[0] - fraction[1];
    return (vec3){rest * a->x + fraction[0] * b->x + fraction[1] * c->x,
                  rest * a->y + fraction[0] * b->y + fraction[1] * c->y,
                  rest * a->z + fraction[0] * b->z + fraction[1] * c->z};
}

static vec3 unit(vec3 v)
{
    float length = sqrtf(v.x * v.x + v.y * v.y + v.z * v.z);
    return length > 0 ? (vec3){v.x / length, v.y / length, v.z / length} : (vec3){0, 0, 1};
}

/* One candidate in each of `count` equal fractions of the area, as the triangles follow each other. */
static void share_out(mark_dot *out, size_t count, const mark_surface *s, double area, uint32_t seed)
{
    random_source r = random_start(seed, 0x5711);
    double        before = 0, own = triangle_area(s, 0);
    uint32_t      t = 0;
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
        *d = (mark_dot){.fraction = {(float)a, (float)b}, .triangle = t};
        d->position = between(s->positions, &s->indices[3 * (size_t)t], d->fraction);
        d->normal = unit(between(s->normals, &s->indices[3 * (size_t)t], d->fraction));
    }
}

/* Ranks of the candidates; false when memory is gone. */
static bool rank(uint32_t *ranks, const mark_dot *candidates, size_t count, size_t wanted, double area,
                 mark_direction_fn direction, void *user, double length)
{
    spread_position *points = mem_alloc(count * sizeof *points);
    for (size_t i = 0; points && i < count; i++)
        points[i] = (spread_position){candidates[i].position, candidates[i].normal,
                                      direction ? direction(user, &candidates[i]) : (vec3){0, 0, 0}};
    bool done = points && marks_eliminate(ranks, points, count, wanted, area, length);
    mem_free(points);
    return done;
}

lmn_status marks_stipple(marks *out, const mark_surface *s, size_t count, uint32_t seed, lmn_error *error)
{
    return marks_spread(out, s, count, seed, NULL, NULL, 0, error);
}

lmn_status marks_spread(marks *out, const mark_surface *s, size_t count, uint32_t seed, mark_direction_fn direction,
                        void *user, double length, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->area = mark_surface_area(s);
    if (count > LIMIT_MARKS)
        return error_set(error, LMN_LIMIT, "%zu dots are more than %d", count, LIMIT_MARKS);
    if (count == 0 || !(out->area > 0))
        return LMN_OK;
    size_t    many = count * CANDIDATES;
    mark_dot *candidates = mem_alloc(many * sizeof *candidates);
    uint32_t *ranks = mem_alloc(many * sizeof *ranks);
    out->dots = mem_alloc(count * sizeof *out->dots);
    bool done = candidates && ranks && out->dots;
    if (done) {
        share_out(candidates, many, s, out->area, seed);
        done = rank(ranks, candidates, many, count, out->area, direction, user, length);
    }
    for (size_t i = 0; done && i < many; i++) {
        if (ranks[i] == UINT32_MAX)
            continue;
        candidates[i].priority = 1 - (float)ranks[i] / (float)count;
        candidates[i].bright = 1;
        out->dots[ranks[i]] = candidates[i];
    }
    out->dot_count = done ? count : 0;
    mem_free(candidates);
    mem_free(ranks);
    return done ? LMN_OK : error_memory(error);
}

/* --- kept on disk --------------------------------------------------------------------------------------- */

enum { KEPT_FROM = 20000 /* fewer are made as fast as they are read */, KEPT_WIDTH = 1024, DESCRIPTION_CAPACITY = 128 };

/* Two texels a dot: its triangle, in two halves that floats have exactly, and its position there. */
static void write_dots(mip_chain *chain, const marks *m)
{
    float(*texels)[2] = chain->data[0];
    for (size_t i = 0; i < m->dot_count; i++) {
        texels[2 * i][0] = (float)(m->dots[i].triangle >> 16);
        texels[2 * i][1] = (float)(m->dots[i].triangle & 0xFFFF);
        memcpy(texels[2 * i + 1], m->dots[i].fraction, sizeof texels[0]);
    }
}

/* False when what was kept does not fit the surface. */
static bool read_dots(marks *out, const mip_chain *chain, const mark_surface *s, size_t count)
{
    const float(*texels)[2] = chain->data[0];
    if (chain->format != MIP_RG16F || (size_t)chain->width * (size_t)chain->height < 2 * count)
        return false;
    for (size_t i = 0; i < count; i++) {
        uint32_t triangle = (uint32_t)texels[2 * i][0] << 16 | (uint32_t)texels[2 * i][1];
        if (triangle >= s->triangle_count)
            return false;
        mark_dot *d = &out->dots[i];
        *d = (mark_dot){.fraction = {texels[2 * i + 1][0], texels[2 * i + 1][1]},
                        .priority = 1 - (float)i / (float)count,
                        .bright = 1,
                        .triangle = triangle};
        d->position = between(s->positions, &s->indices[3 * (size_t)triangle], d->fraction);
        d->normal = unit(between(s->normals, &s->indices[3 * (size_t)triangle], d->fraction));
    }
    return true;
}

/* Equal text, equal dots. */
static void describe(char out[DESCRIPTION_CAPACITY], const mark_surface *s, size_t count, uint32_t seed)
{
    uint64_t positions = store_hash(s->positions, s->vertex_count * sizeof *s->positions),
             normals = store_hash(s->normals, s->vertex_count * sizeof *s->normals);
    uint64_t indices = store_hash(s->indices, 3 * (size_t)s->triangle_count * sizeof *s->indices);
    snprintf(out, DESCRIPTION_CAPACITY, "stipple 1 %zu %u %016llx %016llx %016llx", count, seed,
             (unsigned long long)positions, (unsigned long long)normals, (unsigned long long)indices);
}

lmn_status marks_stipple_kept(marks *out, const mark_surface *s, size_t count, uint32_t seed, lmn_error *error)
{
    char      description[DESCRIPTION_CAPACITY];
    mip_chain chain;
    if (count < KEPT_FROM || count > LIMIT_MARKS)
        return marks_stipple(out, s, count, seed, error);
    describe(description, s, count, seed);
    memset(out, 0, sizeof *out);
    if (store_find(&chain, description)) {
        out->area = mark_surface_area(s);
        out->dots = mem_alloc(count * sizeof *out->dots);
        bool done = out->dots && read_dots(out, &chain, s, count);
        mip_chain_release(&chain);
        out->dot_count = done ? count : 0;
        if (done)
            return LMN_OK;
        mem_free(out->dots);
    }
    lmn_status status = marks_stipple(out, s, count, seed, error);
    int        rows = (int)((2 * count + KEPT_WIDTH - 1) / KEPT_WIDTH);
    if (status == LMN_OK && out->dot_count == count &&
        mip_chain_create(&chain, KEPT_WIDTH, rows, 1, 1, MIP_RG16F, NULL) == LMN_OK) {
        write_dots(&chain, out);
        store_keep(&chain, description);
        mip_chain_release(&chain);
    }
    return status;
}

void surface_marks_release(marks *m)
{
    mem_free(m->dots);
    mem_free(m->lines);
    memset(m, 0, sizeof *m);
}
