#include "pace.h"

#include <math.h>

/* Steps and smoothing as in Google's model-viewer (2020 on); the budget is that of a picture every 44 ms. */
static const double scales[] = {1, 0.79, 0.62, 0.5, 0.4};
enum { LEVELS = sizeof scales / sizeof *scales };
static const double TOO_SLOW_MS = 44, FAST_MS = 24, WEIGHT = 0.35;

double pace_scale(const pace *p)
{
    return scales[p->level];
}

static void go_to(pace *p, int level)
{
    /* What is expected there, by area, so that one picture more is enough to be sure. */
    double ratio = scales[level] / scales[p->level];
    p->mean_ms *= ratio * ratio;
    p->level = level;
}

void pace_told(pace *p, double ms)
{
    if (!p->warm) {
        p->warm = true;
        return;
    }
    p->mean_ms = p->mean_ms > 0 ? p->mean_ms + WEIGHT * (ms - p->mean_ms) : ms;
    if (p->mean_ms > TOO_SLOW_MS && p->level + 1 < LEVELS) {
        /* Far too slow: several steps at once. */
        int steps = p->mean_ms > 3 * TOO_SLOW_MS && p->level + 2 < LEVELS ? 2 : 1;
        go_to(p, p->level + steps);
    } else if (p->mean_ms < FAST_MS && p->level > 0) {
        go_to(p, p->level - 1);
    }
}
