/* A point that falls and is thrown back by a floor, in closed form: after the first impact flights last as long as
 * powers of the restitution say, so that their sum is a geometric series. */
#include <math.h>

#include "behaviour/map.h"

/* Along the way up: where it begins, how fast, and how much it is pulled. */
typedef struct fall {
    double height, speed, pull, up[3];
    double first, rebound; /* when it meets the floor, and how fast it leaves it then */
} fall;

static fall fall_of(const behaviour_map *m)
{
    fall f = {.pull =
                  sqrt(m->gravity[0] * m->gravity[0] + m->gravity[1] * m->gravity[1] + m->gravity[2] * m->gravity[2]),
              .first = INFINITY};
    if (!(f.pull > 0))
        return f;
    for (int k = 0; k < 3; k++) {
        f.up[k] = -m->gravity[k] / f.pull;
        f.height += f.up[k] * m->start[k];
        f.speed += f.up[k] * m->velocity[k];
    }
    f.height = fmax(f.height - m->floor, 0);
    double arriving = sqrt(f.speed * f.speed + 2 * f.pull * f.height);
    f.first = (f.speed + arriving) / f.pull;
    f.rebound = m->restitution * arriving;
    return f;
}

/* Seconds from the first impact to the n-th after it. */
static double flights(const behaviour_map *m, const fall *f, double n)
{
    double e = m->restitution, first = 2 * f->rebound / f->pull;
    return e >= 1 ? n * first : first * (1 - pow(e, n)) / (1 - e);
}

double bounce_impact(const behaviour_map *m, int n)
{
    fall f = fall_of(m);
    if (n > 0 && !(f.rebound > 0))
        return INFINITY;
    return isfinite(f.first) ? f.first + flights(m, &f, n) : INFINITY;
}

double bounce_speed(const behaviour_map *m, int n)
{
    fall f = fall_of(m);
    return m->restitution > 0 ? f.rebound / m->restitution * pow(m->restitution, n)
           : n > 0            ? 0
                              : f.pull * f.first - f.speed;
}

double bounce_rest(const behaviour_map *m)
{
    fall f = fall_of(m);
    return m->restitution >= 1 || !isfinite(f.first) ? INFINITY : f.first + flights(m, &f, INFINITY);
}

/* Height above the floor. */
static double height_at(const behaviour_map *m, const fall *f, double t)
{
    if (t <= f->first)
        return f->height + f->speed * t - f->pull * t * t / 2;
    double since = t - f->first, flight = 2 * f->rebound / f->pull, e = m->restitution;
    if (!(flight > 0) || t >= bounce_rest(m))
        return 0;
    double n = e >= 1 ? floor(since / flight) : floor(log1p(-since * (1 - e) / flight) / log(e));
    n = fmax(n, 0);
    /* Rounding may have put it into the flight beside. */
    if (flights(m, f, n) > since && n > 0)
        n--;
    else if (flights(m, f, n + 1) <= since)
        n++;
    double within = since - flights(m, f, n), leaving = f->rebound * pow(e, n);
    return fmax(leaving * within - f->pull * within * within / 2, 0);
}

void bounce_at(const behaviour_map *m, double t, double out[3])
{
    fall f = fall_of(m);
    if (!isfinite(f.first)) {
        for (int k = 0; k < 3; k++)
            out[k] = m->start[k] + m->velocity[k] * t;
        return;
    }
    double height = height_at(m, &f, t), begin = 0;
    for (int k = 0; k < 3; k++)
        begin += f.up[k] * m->start[k];
    /* What is not along gravity goes on as it was. */
    for (int k = 0; k < 3; k++)
        out[k] = m->start[k] + (m->velocity[k] - f.speed * f.up[k]) * t + (height + m->floor - begin) * f.up[k];
}
