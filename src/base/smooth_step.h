/* A border that is no step. */
#ifndef LIMNER_BASE_SMOOTH_STEP_H
#define LIMNER_BASE_SMOOTH_STEP_H

/* 0 up to `low`, 1 from `high` on, smooth between. */
static inline double smooth_step(double low, double high, double x)
{
    double t = (x - low) / (high - low);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return t * t * (3 - 2 * t);
}

#endif
