/* How something turns: small turns, one after the other, summed as vectors. */
#include "depict/turning.h"

#include <string.h>

/* Columns without their lengths. */
static void pure(mat4 *m)
{
    for (int c = 0; c < 3; c++)
        vector3_normalise(&m->m[4 * c]);
    m->m[12] = m->m[13] = m->m[14] = 0;
}

/* The turn from one orientation to the next as axis times angle. */
static void small_turn(const mat4 *a, const mat4 *b, double out[3])
{
    double r[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            r[i][k] = b->m[i] * a->m[k] + b->m[4 + i] * a->m[4 + k] + b->m[8 + i] * a->m[8 + k];
    vector3_set(out, r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]);
    const double sine = vector3_length(out) / 2, cosine = (r[0][0] + r[1][1] + r[2][2] - 1) / 2;
    const double angle = atan2(sine, cosine);
    for (int k = 0; k < 3; k++)
        out[k] *= sine > 1e-12 ? angle / (2 * sine) : 0;
}

/* Relative to what it hangs on. */
static mat4 own_turn(const way *parent, const way *whole, double seconds)
{
    mat4 above = way_world(parent, seconds), below = way_world(whole, seconds), own = below;
    pure(&above);
    pure(&below);
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++)
            own.m[4 * c + r] = vector3_dot(&above.m[4 * r], &below.m[4 * c]);
    return own;
}

static void turn_direction(const mat4 *m, const double v[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m->m[k] * v[0] + m->m[4 + k] * v[1] + m->m[8 + k] * v[2];
}

static void sum_turns(const way *parent, const way *whole, double from, double to, double out[3])
{
    enum { STEPS = 512 };
    mat4 last = own_turn(parent, whole, from);
    vector3_set(out, 0, 0, 0);
    for (int i = 1; i <= STEPS && to > from; i++) {
        mat4   now = own_turn(parent, whole, from + (to - from) * i / STEPS);
        double turn[3];
        small_turn(&last, &now, turn);
        vector3_add(out, out, 1, turn);
        last = now;
    }
}

/* The piece of an interval around `now` in which it does not turn back. */
static void narrow_to_one_sense(const way *parent, const way *whole, double *from, double *to, double now)
{
    enum { STEPS = 256 };
    const double begin = *from, span = (*to - *from) / STEPS;
    double       turns[STEPS][3], sense[3];
    mat4         last = own_turn(parent, whole, begin);
    int          here = (int)fmin(fmax((now - begin) / span, 0), STEPS - 1), nearest = -1;
    for (int i = 0; i < STEPS; i++) {
        mat4 next = own_turn(parent, whole, begin + span * (i + 1));
        small_turn(&last, &next, turns[i]);
        last = next;
    }
    /* What rests now will go on, or else has been turned. */
    for (int i = 0; i < STEPS; i++) {
        int away = i >= here ? i - here : 2 * (here - i);
        if (vector3_length(turns[i]) > 1e-6 &&
            (nearest < 0 || away < (nearest >= here ? nearest - here : 2 * (here - nearest))))
            nearest = i;
    }
    if (nearest < 0)
        return;
    vector3_copy(sense, turns[nearest]);
    int first = nearest, end = nearest + 1;
    while (first > 0 && vector3_dot(turns[first - 1], sense) >= 0)
        first--;
    while (end < STEPS && vector3_dot(turns[end], sense) >= 0)
        end++;
    *from = begin + span * first;
    *to = begin + span * end;
}

void turning_find(turning *out, const way *w, double from, double to, double now)
{
    way whole = *w, parent = *w;
    memset(out, 0, sizeof *out);
    while (whole.count > 0 && !whole.steps[whole.count - 1].rotation)
        whole.count--;
    if (whole.count == 0)
        return;
    parent.count = whole.count - 1;
    if (to > from)
        narrow_to_one_sense(&parent, &whole, &from, &to, now);
    const double settled = fmin(fmax(now, from), to);
    double       all[3], past[3];
    sum_turns(&parent, &whole, from, settled, past);
    sum_turns(&parent, &whole, settled, to, all);
    vector3_add(all, all, 1, past);
    out->angle = vector3_length(all);
    mat4 world = way_world(&whole, settled), above = way_world(&parent, settled);
    vector3_copy(out->pivot, &world.m[12]);
    pure(&above);
    turn_direction(&above, all, out->axis);
    if (!vector3_normalise(out->axis))
        out->angle = 0;
    else
        out->until = fmin(fmax(vector3_dot(past, all) / out->angle, 0), out->angle);
}
