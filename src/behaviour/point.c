/* Where a point of a node goes. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "behaviour/inspect.h"

typedef struct point_place {
    const schedule *s;
    int32_t         node;
    double          point[3];
} point_place;

static void place(const void *of, double seconds, time_side side, double out[3])
{
    const point_place *p = of;
    mat4               world = schedule_world(p->s, p->node, seconds, side);
    for (int k = 0; k < 3; k++)
        out[k] =
            world.m[k] * p->point[0] + world.m[4 + k] * p->point[1] + world.m[8 + k] * p->point[2] + world.m[12 + k];
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
        trajectory_sort_times(*times, count);
    }
    return good;
}

static point_place point_of(const schedule *s, int32_t node_index, const double point[3])
{
    point_place out = {s, node_index, {0, 0, 0}};
    if (point)
        memcpy(out.point, point, sizeof out.point);
    return out;
}

lmn_status schedule_trajectory(trajectory *out, const schedule *s, int32_t node_index, const double point[3],
                               double from, double to, double tolerance, lmn_error *error)
{
    const point_place of = point_of(s, node_index, point);
    double           *times = NULL;
    size_t            count = 0;
    *out = (trajectory){.samples = NULL};
    lmn_status status = find_breaks(s, node_index, from, to, &times, &count) ? LMN_OK : error_memory(error);
    if (status == LMN_OK)
        status = trajectory_create(out, &(trajectory_source){place, &of, times, count}, tolerance, TRAJECTORY_CORNERS,
                                   error);
    mem_free(times);
    return status;
}

lmn_status schedule_point_at(trajectory_sample *out, const schedule *s, int32_t node_index, const double point[3],
                             double seconds, time_side side, lmn_error *error)
{
    const point_place of = point_of(s, node_index, point);
    double           *times = NULL, end = fmax(s->duration, seconds);
    size_t            count = 0, i = 0;
    *out = (trajectory_sample){.seconds = seconds};
    if (!find_breaks(s, node_index, fmin(0, seconds), end, &times, &count)) {
        mem_free(times);
        return error_memory(error);
    }
    while (i + 2 < count && (times[i + 1] < seconds || (times[i + 1] == seconds && side != SIDE_BEFORE)))
        i++;
    const trajectory_source source = {place, &of, times, count};
    *out = trajectory_sample_at(&source, seconds, times[i], times[count > 1 ? i + 1 : i]);
    mem_free(times);
    return LMN_OK;
}
