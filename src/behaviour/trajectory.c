/* Where a point goes: samples as close as the path is bent, with both sides of every corner. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"
#include "behaviour/inspect.h"

enum { SAMPLES_MAX = 1000000, HALVINGS_MAX = 16 };

/* An interval without breaks, in which derivatives are taken by differences. */
typedef struct sampler {
    trajectory     *out;
    const schedule *s;
    int32_t         node;
    double          point[3], begin, end, tolerance;
    lmn_status      status;
    lmn_error      *error;
} sampler;

static void place(const sampler *q, double t, double out[3])
{
    time_side side = t <= q->begin ? SIDE_BEHIND : t >= q->end ? SIDE_BEFORE : SIDE_AT;
    mat4      world = schedule_world(q->s, q->node, t, side);
    for (int k = 0; k < 3; k++)
        out[k] =
            world.m[k] * q->point[0] + world.m[4 + k] * q->point[1] + world.m[8 + k] * q->point[2] + world.m[12 + k];
}

static trajectory_sample sample_at(const sampler *q, double t)
{
    trajectory_sample out = {.seconds = t};
    double            h = 1e-3 * (q->end - q->begin), a[3], b[3], c[3];
    place(q, t, out.position);
    if (!(h > 0))
        return out;
    /* The three times around it, moved inside: the parabola through them gives both derivatives. */
    double middle = fmin(fmax(t, q->begin + h), q->end - h), away = t - middle;
    place(q, middle - h, a);
    place(q, middle, b);
    place(q, middle + h, c);
    for (int k = 0; k < 3; k++) {
        out.acceleration[k] = (a[k] - 2 * b[k] + c[k]) / (h * h);
        out.velocity[k] = (c[k] - a[k]) / (2 * h) + out.acceleration[k] * away;
    }
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

/* How far a point is from the straight line between two samples. */
static double off_line(const double p[3], const double a[3], const double b[3])
{
    double along = 0, length = 0, far = 0;
    for (int k = 0; k < 3; k++) {
        along += (p[k] - a[k]) * (b[k] - a[k]);
        length += (b[k] - a[k]) * (b[k] - a[k]);
    }
    double share = length > 0 ? fmin(fmax(along / length, 0), 1) : 0;
    for (int k = 0; k < 3; k++)
        far += pow(p[k] - a[k] - share * (b[k] - a[k]), 2);
    return sqrt(far);
}

static bool is_straight(const sampler *q, const trajectory_sample *a, const trajectory_sample *b)
{
    double dot = 0, fast = 0, other = 0, at[3];
    for (int i = 1; i < 4; i++) {
        place(q, a->seconds + i / 4.0 * (b->seconds - a->seconds), at);
        if (off_line(at, a->position, b->position) > q->tolerance)
            return false;
    }
    for (int k = 0; k < 3; k++) {
        dot += a->velocity[k] * b->velocity[k];
        fast += a->velocity[k] * a->velocity[k];
        other += b->velocity[k] * b->velocity[k];
    }
    double reach = off_line(b->position, a->position, a->position);
    return reach <= q->tolerance || dot >= 0.809 * sqrt(fast * other);
}

static void between(sampler *q, const trajectory_sample *a, const trajectory_sample *b, int halvings)
{
    if (q->status != LMN_OK || halvings == 0 || is_straight(q, a, b))
        return;
    trajectory_sample middle = sample_at(q, a->seconds + (b->seconds - a->seconds) / 2);
    between(q, a, &middle, halvings - 1);
    add(q, &middle);
    between(q, &middle, b, halvings - 1);
}

/* All breaks of what can move the node, and the interval's ends. */
static bool find_breaks(const schedule *s, int32_t node_index, double from, double to, double **times, size_t *count)
{
    size_t capacity = 0;
    bool   good = true;
    for (int32_t at = node_index; at != NONE; at = s->scene->nodes[at].parent)
        for (int k = PATH_TRANSLATION; k <= PATH_SCALE && good; k++) {
            int32_t index = schedule_property(s, (animation_path)k, at);
            if (index != NONE)
                good = schedule_breaks(s, &s->properties[index], from, to, times, count, &capacity);
        }
    good = good && mem_grow((void **)times, &capacity, *count + 2, sizeof **times);
    if (good) {
        (*times)[(*count)++] = from;
        (*times)[(*count)++] = to;
        schedule_sort_times(*times, count);
    }
    return good;
}

lmn_status trajectory_create(trajectory *out, const schedule *s, int32_t node_index, const double point[3], double from,
                             double to, double tolerance, lmn_error *error)
{
    sampler q = {.out = out, .s = s, .node = node_index, .tolerance = tolerance, .error = error};
    double *times = NULL;
    size_t  count = 0;
    *out = (trajectory){.samples = NULL};
    if (point)
        memcpy(q.point, point, sizeof q.point);
    if (!find_breaks(s, node_index, from, to, &times, &count))
        q.status = error_memory(error);
    for (size_t i = 0; i + 1 < count && q.status == LMN_OK; i++) {
        q.begin = times[i];
        q.end = times[i + 1];
        trajectory_sample first = sample_at(&q, q.begin), last = sample_at(&q, q.end);
        first.forced = last.forced = true;
        add(&q, &first);
        between(&q, &first, &last, HALVINGS_MAX);
        add(&q, &last);
    }
    if (count == 1 && q.status == LMN_OK) { /* an instant */
        q.begin = q.end = from;
        trajectory_sample only = sample_at(&q, from);
        add(&q, &only);
    }
    mem_free(times);
    return q.status;
}

void trajectory_release(trajectory *t)
{
    mem_free(t->samples);
    memset(t, 0, sizeof *t);
}
