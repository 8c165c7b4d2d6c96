#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "behaviour/inspect.h"

/* One constant pull draws it against the normal on both sides, by enough to tell in the time that each lasts, and it
 * comes from where it is thrown to. Straight pieces of a sampled curve meet at corners without any pull, turned ones
 * with another one in each. `a` is the last sample before the instant, those before it and behind its two are at the
 * other ends of both sides. */
static bool is_thrown_back(const trajectory_sample *a, const double normal[3])
{
    const trajectory_sample *b = a + 1;
    const double             since = a->seconds - a[-1].seconds, until = b[1].seconds - b->seconds,
                 in = -vector3_dot(a->velocity, normal), out = vector3_dot(b->velocity, normal),
                 pull = vector3_length(a->acceleration);
    for (int i = -1; i <= 2; i++)
        if (vector3_distance(a[i].acceleration, a->acceleration) > 0.05 * pull)
            return false;
    return -vector3_dot(a->acceleration, normal) > 0.7 * pull && in > 0.2 * vector3_length(a->velocity) &&
           out > 0.1 * vector3_length(b->velocity) && pull * since > 0.2 * in && pull * until > 0.2 * out;
}

/* Two samples of one instant on either side of a corner; false when the place jumps, or hardly anything does. */
static bool is_impact(const trajectory_sample *a, const trajectory_sample *b, double least, impact *out)
{
    double change[3], moved = 0, fast = vector3_length(a->velocity) + vector3_length(b->velocity);
    if (a->seconds != b->seconds)
        return false;
    for (int k = 0; k < 3; k++) {
        change[k] = b->velocity[k] - a->velocity[k];
        moved = fmax(moved, fabs(b->position[k] - a->position[k]));
    }
    out->seconds = a->seconds;
    out->speed = vector3_length(change);
    for (int k = 0; k < 3; k++)
        out->normal[k] = out->speed > 0 ? change[k] / out->speed : 0;
    memcpy(out->place, a->position, sizeof out->place);
    memcpy(out->before, a->velocity, sizeof out->before);
    memcpy(out->after, b->velocity, sizeof out->after);
    out->sets_off = vector3_length(a->velocity) <= 1e-6 * out->speed;
    out->stops = vector3_length(b->velocity) <= 1e-6 * out->speed;
    return moved <= 1e-6 * (1 + fast) && out->speed >= least && out->speed > 1e-4 * fast;
}

lmn_status impacts_find(impact **out, size_t *count, const schedule *s, int32_t node_index, const double point[3],
                        double from, double to, double least, lmn_error *error)
{
    trajectory t;
    size_t     capacity = 0;
    *out = NULL;
    *count = 0;
    lmn_status status = schedule_trajectory(&t, s, node_index, point, from, to, INFINITY, error);
    for (size_t i = 0; i + 1 < t.count && status == LMN_OK; i++) {
        impact found;
        if (!is_impact(&t.samples[i], &t.samples[i + 1], least, &found))
            continue;
        /* Nothing is sampled between breaks. */
        found.since = i > 0 ? found.seconds - t.samples[i - 1].seconds : 0;
        found.until = i + 2 < t.count ? t.samples[i + 2].seconds - found.seconds : 0;
        found.thrown_back = i > 0 && i + 2 < t.count && is_thrown_back(&t.samples[i], found.normal);
        if (mem_grow((void **)out, &capacity, *count + 1, sizeof **out))
            (*out)[(*count)++] = found;
        else
            status = error_memory(error);
    }
    trajectory_release(&t);
    return status;
}
