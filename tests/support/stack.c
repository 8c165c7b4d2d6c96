#include "stack.h"

#include <stdlib.h>
#include <string.h>

#include "check.h"

/* Coincident in exact arithmetic: what double precision leaves of a difference of 0, as a fraction of the depth. */
static const double coincident = 1e-9;

/* Coincident for a rasteriser: what single precision makes of the depth of one plane through different triangles. */
static const double rounding = 2e-6;

/* How far a rasteriser may move what it draws, in pixels: it rounds corners to 1/256. For what must not lie near,
 * twice that. */
static const double moved = 1.0 / 256, reach = 1.0 / 128;

static const double depth_tolerance = 1e-4, normal_tolerance = 1e-3;

static int by_part(const void *a, const void *b)
{
    const stack_hit *one = a, *other = b;
    if (one->id != other->id)
        return one->id < other->id ? -1 : 1;
    if (one->front != other->front)
        return one->front ? -1 : 1;
    return one->triangle < other->triangle ? -1 : one->triangle > other->triangle;
}

static stack_hit hit_of(const tracer *t, const shot *view, dvec origin, dvec direction, const trace_hit *hit)
{
    size_t                count;
    const trace_triangle *f = &tracer_triangles(t, &count)[hit->triangle];
    dvec                  point = dvec_add(origin, dvec_scale(direction, hit->t));
    dvec                  n = dvec_add(dvec_scale(f->n[0], 1 - hit->u - hit->v),
                                       dvec_add(dvec_scale(f->n[1], hit->u), dvec_scale(f->n[2], hit->v)));
    return (stack_hit){.depth = -shot_to_eye(view, point, 1).z,
                       .normal = dvec_unit(shot_to_eye(view, n, 0)),
                       .triangle = hit->triangle,
                       .u = (float)hit->u,
                       .v = (float)hit->v,
                       .id = (uint16_t)(f->part + 1),
                       .front = dvec_dot(f->flat, direction) < 0};
}

/* Sorts what coincides by part and facing, and takes out what counts once. */
static size_t settle(stack_hit *hits, size_t count)
{
    size_t kept = 0;
    for (size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1;
             end < count && hits[end].depth - hits[end - 1].depth <= coincident * fabs(hits[end].depth); end++)
            ;
        qsort(hits + begin, end - begin, sizeof *hits, by_part);
        for (size_t k = begin; k < end; k++) {
            const stack_hit *last = kept ? &hits[kept - 1] : NULL;
            if (k > begin && last->id == hits[k].id && last->front == hits[k].front)
                continue;
            hits[kept++] = hits[k];
        }
    }
    for (size_t k = 0; k < kept; k++)
        hits[k].tied = k > 0 && hits[k].depth - hits[k - 1].depth <= rounding * fabs(hits[k].depth);
    return kept;
}

size_t stack_trace(const tracer *t, const shot *view, double x, double y, stack_hit out[STACK_MAX])
{
    dvec      origin, direction;
    trace_hit raw[STACK_MAX];
    size_t    kept = 0;
    shot_ray(view, x, y, &origin, &direction);
    size_t found = tracer_hits(t, origin, direction, view->orthographic ? -INFINITY : 0, INFINITY, raw, STACK_MAX);
    if (found > STACK_MAX)
        check_that("self", false, "%zu hits on a ray: more than the tests have room for", found);
    for (size_t k = 0; k < found && k < STACK_MAX; k++) {
        stack_hit hit = hit_of(t, view, origin, direction, &raw[k]);
        if (view->orthographic || (hit.depth >= view->near_depth && hit.depth <= view->far_depth))
            out[kept++] = hit;
    }
    return settle(out, kept);
}

/* The same surfaces in the same order, where surfaces that are tied have none. */
static bool same_structure(const stack_hit *a, const stack_hit *b, size_t count)
{
    for (size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && a[end].tied; end++)
            ;
        stack_hit sorted[2][STACK_MAX];
        memcpy(sorted[0], a + begin, (end - begin) * sizeof *a);
        memcpy(sorted[1], b + begin, (end - begin) * sizeof *b);
        for (int i = 0; i < 2 && end - begin > 1; i++)
            qsort(sorted[i], end - begin, sizeof *a, by_part);
        for (size_t k = 0; k < end - begin; k++)
            if (sorted[0][k].id != sorted[1][k].id || sorted[0][k].front != sorted[1][k].front)
                return false;
    }
    return true;
}

static const double corners[4][2] = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}};

static bool is_sharp(const tracer *t, const shot *view, int x, int y, const stack_hit *own, size_t count)
{
    stack_hit other[STACK_MAX];
    for (int k = 0; k < 4; k++)
        if (stack_trace(t, view, x + 0.5 + corners[k][0] * reach, y + 0.5 + corners[k][1] * reach, other) != count ||
            !same_structure(own, other, count))
            return false;
    return true;
}

void stack_map_make(stack_map *out, const tracer *t, const shot *view)
{
    int    count = view->width * view->height;
    size_t capacity = 4096, used = 0;
    *out = (stack_map){.width = view->width, .height = view->height};
    out->first = check_alloc((size_t)count + 1, sizeof *out->first);
    out->sharp = check_alloc((size_t)count, sizeof *out->sharp);
    out->hits = check_alloc(capacity, sizeof *out->hits);
    for (int i = 0; i < count; i++) {
        stack_hit own[STACK_MAX];
        int       x = i % view->width, y = i / view->width;
        size_t    found = stack_trace(t, view, x + 0.5, y + 0.5, own);
        if (used + found > capacity) {
            stack_hit *grown = check_alloc(capacity = 2 * capacity + found, sizeof *grown);
            memcpy(grown, out->hits, used * sizeof *grown);
            free(out->hits);
            out->hits = grown;
        }
        memcpy(out->hits + used, own, found * sizeof *own);
        used += found;
        out->first[i + 1] = used;
        out->sharp[i] = is_sharp(t, view, x, y, own, found);
        out->sharp_count += out->sharp[i];
        out->most = found > out->most ? found : out->most;
        if (out->sharp[i] && found > out->most_sharp)
            out->most_sharp = found;
    }
}

void stack_map_release(stack_map *m)
{
    free(m->first);
    free(m->hits);
    free(m->sharp);
    *m = (stack_map){0};
}

size_t stack_covered(const stack_map *m, size_t k)
{
    size_t covered = 0;
    for (int i = 0; i < m->width * m->height; i++)
        covered += stack_count(m, i) > k;
    return covered;
}

/* --- comparison ----------------------------------------------------------------------------------------- */

/* How far a depth is outside of what the surface has where the rasteriser may have moved it from, as a fraction;
 * surfaces keep their numbers there because the pixel is sharp. */
static void judge_again(const tracer *t, const shot *s, int x, int y, size_t k, double depth, dvec normal,
                        double *depth_error, double *normal_error)
{
    stack_hit other[STACK_MAX];
    stack_trace(t, s, x + 0.5, y + 0.5, other);
    double   low = other[k].depth, high = low;
    uint16_t id = other[k].id;
    bool     front = other[k].front;
    for (int c = 0; c < 4; c++) {
        size_t count = stack_trace(t, s, x + 0.5 + corners[c][0] * moved, y + 0.5 + corners[c][1] * moved, other);
        for (size_t j = 0; j < count; j++) {
            if (other[j].id != id || other[j].front != front || (j != k && !other[j].tied && !other[k].tied))
                continue;
            low = fmin(low, other[j].depth);
            high = fmax(high, other[j].depth);
            *normal_error = fmin(*normal_error, dvec_length(dvec_sub(normal, other[j].normal)));
        }
    }
    *depth_error = fmax(0, fmax(low - depth, depth - high)) / low;
}

static bool same_corners(const tracer *t, const stack_hit *a, const stack_hit *b)
{
    size_t                count;
    const trace_triangle *f = tracer_triangles(t, &count);
    return memcmp(f[a->triangle].p, f[b->triangle].p, sizeof f->p) == 0;
}

/* Which of the tied surfaces begin … end − 1 a layer shows: the one of its part that faces most like it; −1 when
 * there is none. Copies of one triangle have the same depth to the last bit, so their order is known. */
static int find_tied(const tracer *t, const stack_hit *hits, const bool *taken, size_t begin, size_t end, size_t k,
                     uint16_t id, dvec normal)
{
    bool copies = true;
    for (size_t j = begin + 1; j < end; j++)
        copies = copies && same_corners(t, &hits[begin], &hits[j]);
    if (copies || end == begin + 1)
        return hits[k].id == id ? (int)k : -1;
    int best = -1;
    for (size_t j = begin; j < end; j++)
        if (!taken[j] && hits[j].id == id &&
            (best < 0 || dvec_dot(normal, hits[j].normal) > dvec_dot(normal, hits[best].normal)))
            best = (int)j;
    return best;
}

typedef enum verdict { RIGHT, WRONG_COUNT, WRONG_ID, WRONG_DEPTH, WRONG_NORMAL, HOLE } verdict;

typedef struct judgement {
    verdict what;
    int     layer;
    double  depth_error, normal_error;
    size_t  drawn;
} judgement;

static judgement judge_pixel(const stack_map *m, const tracer *t, const shot *s, int i, size_t limit)
{
    const stack_hit *hits = stack_at(m, i);
    judgement        j = {0};
    bool             taken[STACK_MAX] = {false};
    size_t           count = stack_count(m, i), all = count;
    count = limit && count > limit ? limit : count;
    size_t last = 0;
    for (int k = 0; k < s->layer_count; k++)
        if (!isinf(s->layers[k].depth[i])) {
            j.drawn++;
            last = (size_t)k + 1;
        }
    if (last != j.drawn)
        return (j.what = HOLE, j);
    if (j.drawn != count)
        return (j.what = WRONG_COUNT, j.layer = (int)(j.drawn < count ? j.drawn : count), j);
    for (size_t k = 0, begin = 0, end = 0; k < count; k++) {
        if (k >= end)
            for (begin = k, end = k + 1; end < all && hits[end].tied; end++)
                ;
        dvec   normal = dvec_from(s->layers[k].normal[i]);
        double depth = (double)s->layers[k].depth[i];
        int    found = find_tied(t, hits, taken, begin, end, k, s->layers[k].id[i], normal);
        j.layer = (int)k;
        if (found < 0)
            return (j.what = WRONG_ID, j);
        taken[found] = true;
        double depth_error = fabs(depth - hits[found].depth) / fabs(hits[found].depth);
        double normal_error = dvec_length(dvec_sub(normal, hits[found].normal));
        if (!(depth_error <= depth_tolerance && normal_error <= normal_tolerance))
            judge_again(t, s, i % s->width, i / s->width, (size_t)found, depth, normal, &depth_error, &normal_error);
        j.depth_error = fmax(j.depth_error, depth_error);
        j.normal_error = fmax(j.normal_error, normal_error);
        if (!(depth_error <= depth_tolerance))
            return (j.what = WRONG_DEPTH, j);
        if (!(normal_error <= normal_tolerance))
            return (j.what = WRONG_NORMAL, j);
    }
    return j;
}

stack_score stack_compare(const stack_map *m, const tracer *t, const shot *s, size_t drawn)
{
    stack_score score = {.x = -1, .y = -1, .layer = -1};
    for (int i = 0; i < m->width * m->height; i++) {
        judgement j = judge_pixel(m, t, s, i, drawn);
        size_t    count = stack_count(m, i);
        score.pixels++;
        score.right += j.what == RIGHT;
        if (!m->sharp[i])
            continue;
        score.sharp++;
        score.right_sharp += j.what == RIGHT;
        score.hits += drawn && count > drawn ? drawn : count;
        score.drawn += j.drawn;
        score.wrong_count += j.what == WRONG_COUNT;
        score.wrong_id += j.what == WRONG_ID;
        score.wrong_depth += j.what == WRONG_DEPTH;
        score.wrong_normal += j.what == WRONG_NORMAL;
        score.holes += j.what == HOLE;
        score.depth_error = fmax(score.depth_error, j.depth_error);
        score.normal_error = fmax(score.normal_error, j.normal_error);
        if (j.what != RIGHT && score.x < 0) {
            score.x = i % m->width;
            score.y = i / m->width;
            score.layer = j.layer;
        }
    }
    return score;
}
