#include "behaviour/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/vector3.h"
#include "base/work.h"

enum { SAMPLES_MAX = 1000000, HALVINGS_MAX = 16 };

/* An interval without breaks. */
typedef struct sampler {
    trajectory              *out;
    const trajectory_source *source;
    double                   begin, end, tolerance;
    bool                     corners;
    lmn_status               status;
    lmn_error               *error;
} sampler;

/* Rounding must not lead past a break. */
static void place(const trajectory_source *s, double t, double begin, double end, double out[3])
{
    t = fmin(fmax(t, begin), end);
    s->place(s->of, t, t <= begin ? SIDE_BEHIND : t >= end ? SIDE_BEFORE : SIDE_AT, out);
}

trajectory_sample trajectory_sample_at(const trajectory_source *s, double t, double begin, double end)
{
    trajectory_sample out = {.seconds = t};
    double            h = 1e-3 * (end - begin), a[3], b[3], c[3];
    place(s, t, begin, end, out.position);
    if (!(h > 0))
        return out;
    /* The three times around it, moved inside: the parabola through them gives both derivatives. */
    double middle = fmin(fmax(t, begin + h), end - h), away = t - middle;
    place(s, middle - h, begin, end, a);
    place(s, middle, begin, end, b);
    place(s, middle + h, begin, end, c);
    for (int k = 0; k < 3; k++) {
        out.acceleration[k] = (a[k] - 2 * b[k] + c[k]) / (h * h);
        out.velocity[k] = (c[k] - a[k]) / (2 * h) + out.acceleration[k] * away;
    }
    return out;
}

static trajectory_sample sample_at(const sampler *q, double t)
{
    if (q->corners)
        return trajectory_sample_at(q->source, t, q->begin, q->end);
    trajectory_sample out = {.seconds = t};
    place(q->source, t, q->begin, q->end, out.position);
    return out;
}

static void add(sampler *q, const trajectory_sample *sample)
{
    if (q->status != LMN_OK)
        return;
    if (work_stopped())
        q->status = work_check(q->error);
    else if (q->out->count >= SAMPLES_MAX)
        q->status = error_set(q->error, LMN_LIMIT, "a trajectory of more than %d samples", SAMPLES_MAX);
    else if (!mem_grow((void **)&q->out->samples, &q->out->capacity, q->out->count + 1, sizeof *q->out->samples))
        q->status = error_memory(q->error);
    else
        q->out->samples[q->out->count++] = *sample;
}

/* How far a point is from the straight line between two others. */
static double off_line(const double p[3], const double a[3], const double b[3])
{
    double along[3], to[3];
    vector3_add(along, b, -1, a);
    vector3_add(to, p, -1, a);
    double length = vector3_dot(along, along), share = length > 0 ? vector3_dot(to, along) / length : 0;
    vector3_add(to, to, -fmin(fmax(share, 0), 1), along);
    return vector3_length(to);
}

/* May a straight line stand for what lies between two samples? Three places tell, two of them beside the middle and
 * not opposite to each other, so that no bend of a cubic hides. */
static bool is_straight(const sampler *q, const trajectory_sample *a, const trajectory_sample *middle,
                        const trajectory_sample *b)
{
    if (off_line(middle->position, a->position, b->position) > q->tolerance)
        return false;
    for (int i = 0; i < 2; i++) {
        double at[3];
        place(q->source, a->seconds + (i == 0 ? 0.29 : 0.77) * (b->seconds - a->seconds), q->begin, q->end, at);
        if (off_line(at, a->position, b->position) > q->tolerance)
            return false;
    }
    if (!q->corners || vector3_distance(a->position, b->position) <= q->tolerance)
        return true;
    double fast = vector3_dot(a->velocity, a->velocity), other = vector3_dot(b->velocity, b->velocity);
    return vector3_dot(a->velocity, b->velocity) >= 0.809 * sqrt(fast * other);
}

static void between(sampler *q, const trajectory_sample *a, const trajectory_sample *b, int halvings)
{
    if (q->status != LMN_OK || halvings == 0)
        return;
    trajectory_sample middle = sample_at(q, a->seconds + (b->seconds - a->seconds) / 2);
    if (is_straight(q, a, &middle, b))
        return;
    between(q, a, &middle, halvings - 1);
    add(q, &middle);
    between(q, &middle, b, halvings - 1);
}

lmn_status trajectory_create(trajectory *out, const trajectory_source *source, double tolerance,
                             trajectory_detail detail, lmn_error *error)
{
    sampler q = {.out = out, .source = source, .tolerance = tolerance, .error = error};
    q.corners = detail == TRAJECTORY_CORNERS;
    *out = (trajectory){.samples = NULL};
    for (size_t i = 0; i + 1 < source->break_count && q.status == LMN_OK; i++) {
        q.begin = source->breaks[i];
        q.end = source->breaks[i + 1];
        trajectory_sample first = sample_at(&q, q.begin), last = sample_at(&q, q.end);
        first.forced = last.forced = true;
        if (q.corners || i == 0)
            add(&q, &first);
        between(&q, &first, &last, HALVINGS_MAX);
        add(&q, &last);
    }
    if (source->break_count == 1 && q.status == LMN_OK) { /* an instant */
        q.begin = q.end = source->breaks[0];
        trajectory_sample only = sample_at(&q, q.begin);
        only.forced = true;
        add(&q, &only);
    }
    return q.status;
}

void trajectory_release(trajectory *t)
{
    mem_free(t->samples);
    memset(t, 0, sizeof *t);
}

double *trajectory_lengths(const trajectory *t)
{
    double *lengths = mem_alloc(t->count * sizeof *lengths);
    for (size_t i = 0; i < t->count && lengths; i++)
        lengths[i] = i == 0 ? 0 : lengths[i - 1] + vector3_distance(t->samples[i - 1].position, t->samples[i].position);
    return lengths;
}

static int compare_times(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void trajectory_sort_times(double *times, size_t *count)
{
    size_t kept = 0;
    if (*count)
        qsort(times, *count, sizeof *times, compare_times);
    for (size_t i = 0; i < *count; i++)
        if (i == 0 || times[i] > times[kept - 1])
            times[kept++] = times[i];
    *count = kept;
}
