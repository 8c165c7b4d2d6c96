#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "behaviour/inspect.h"

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
    out->sets_off = vector3_length(a->velocity) <= 1e-6 * out->speed;
    out->stops = vector3_length(b->velocity) <= 1e-6 * out->speed;
    return moved <= 1e-6 * (1 + fast) && out->speed >= least && out->speed > 1e-4 * fast;
}

lmn_status impacts_find(impact **out, size_t *count, const schedule *s, int32_t node_index, double from, double to,
                        double least, lmn_error *error)
{
    trajectory t;
    size_t     capacity = 0;
    *out = NULL;
    *count = 0;
    lmn_status status = schedule_trajectory(&t, s, node_index, NULL, from, to, INFINITY, error);
    for (size_t i = 0; i + 1 < t.count && status == LMN_OK; i++) {
        impact found;
        if (!is_impact(&t.samples[i], &t.samples[i + 1], least, &found))
            continue;
        if (mem_grow((void **)out, &capacity, *count + 1, sizeof **out))
            (*out)[(*count)++] = found;
        else
            status = error_memory(error);
    }
    trajectory_release(&t);
    return status;
}
