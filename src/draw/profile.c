/* Times of passes: wall time between two finishes, in frames of their own. */
#include "draw/frame_private.h"

#include <stdio.h>
#include <string.h>

#include "base/clock.h"

/* --- profiling ------------------------------------------------------------------------------------------------- */

stopwatch watch_start(frame *f)
{
    if (!f->profile)
        return (stopwatch){0};
    gpu_finish(f->g);
    return (stopwatch){clock_ms(), gpu_draw_count(f->g)};
}

void watch_stop(frame *f, stopwatch w, const char *group, const char *name)
{
    if (!f->profile)
        return;
    gpu_finish(f->g);
    char joined[sizeof f->times[0].name];
    snprintf(joined, sizeof joined, "%s%s%s", group, *group ? ": " : "", name);
    pass_time *t = NULL;
    for (size_t i = 0; i < f->time_count && !t; i++)
        if (strcmp(f->times[i].name, joined) == 0)
            t = &f->times[i];
    if (!t) {
        if (f->time_count == PASS_TIMES_MAX)
            return;
        t = &f->times[f->time_count++];
        memset(t, 0, sizeof *t);
        memcpy(t->name, joined, sizeof joined);
    }
    t->ms += clock_ms() - w.start;
    t->draws += gpu_draw_count(f->g) - w.draws;
}
