#include "gpu/profile.h"

#include <stdio.h>
#include <string.h>

#include "base/clock.h"

stopwatch watch_start(const gpu_profile *p)
{
    if (!p->on)
        return (stopwatch){0};
    gpu_finish(p->g);
    return (stopwatch){clock_ms(), clock_cpu_ms(), gpu_draw_count(p->g)};
}

void watch_stop(gpu_profile *p, stopwatch w, const char *group, const char *name)
{
    if (!p->on)
        return;
    gpu_finish(p->g);
    char joined[sizeof p->times[0].name];
    snprintf(joined, sizeof joined, "%s%s%s", group, *group ? ": " : "", name);
    gpu_pass_time *t = NULL;
    for (size_t i = 0; i < p->count && !t; i++)
        if (strcmp(p->times[i].name, joined) == 0)
            t = &p->times[i];
    if (!t) {
        if (p->count == PASS_TIMES_MAX)
            return;
        t = &p->times[p->count++];
        memset(t, 0, sizeof *t);
        memcpy(t->name, joined, sizeof joined);
    }
    t->ms += clock_ms() - w.start;
    t->cpu_ms += clock_cpu_ms() - w.cpu_start;
    t->draws += gpu_draw_count(p->g) - w.draws;
}
