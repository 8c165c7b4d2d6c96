/* What many things do together. */
#include "depict/groups.h"

#include "depict/pieces.h"
#include "depict/turning.h"

enum { BURST_LEAST = 4, STEPS = 64 };

/* When a piece sets off: the last time at which it is where it began. */
static double set_off(const pieces *p, size_t i, double from, double to)
{
    double begin[3], now[3];
    piece_at(p, i, from, begin);
    for (int k = 1; k <= STEPS; k++) {
        piece_at(p, i, from + (to - from) * k / STEPS, now);
        if (vector3_distance(begin, now) > 0.05 * p->items[i].radius)
            return from + (to - from) * (k - 1) / STEPS;
    }
    return to;
}

/* All of them go away from their middle at once, to all sides. */
static bool is_burst(const pieces *p, double parting, double from, double to)
{
    double middle[3] = {0, 0, 0}, sum[3] = {0, 0, 0}, reach = 0;
    size_t outward = 0;
    for (size_t i = 0; i < p->count; i++) {
        double at[3];
        piece_at(p, i, parting, at);
        vector3_add(middle, middle, 1.0 / (double)p->count, at);
    }
    for (size_t i = 0; i < p->count; i++) {
        double at[3], end[3], gone[3], off[3];
        piece_at(p, i, parting, at);
        piece_at(p, i, to, end);
        vector3_add(gone, end, -1, at);
        vector3_add(off, at, -1, middle);
        reach = fmax(reach, vector3_length(off) + p->items[i].radius);
        outward += vector3_dot(gone, off) > 0;
        if (vector3_normalise(gone))
            vector3_add(sum, sum, 1.0 / (double)p->count, gone);
        if (fabs(set_off(p, i, from, to) - parting) > 0.1 * (to - from))
            return false;
    }
    return outward * 4 >= p->count * 3 && vector3_length(sum) < 0.6 && pieces_spread(p, parting, to) > 2 * reach;
}

/* They have gone a way together before they part. */
static bool is_split(const pieces *p, double parting, double from, double to)
{
    double begin[3], now[3], radius = p->items[0].radius;
    piece_at(p, 0, from, begin);
    piece_at(p, 0, parting, now);
    return parting < to && vector3_distance(begin, now) > 3 * radius && pieces_spread(p, parting, to) > 3 * radius;
}

lmn_status group_find(group *out, const depict_job *j, int32_t node, double from, double to, lmn_error *error)
{
    pieces     p;
    lmn_status status = pieces_open(&p, j, node, error);
    *out = (group){GROUP_NONE, 0};
    if (status == LMN_OK && p.count > 1 && to > from) {
        const double parting = pieces_parting(&p, from, to, 0.02 * p.items[0].radius);
        out->things = p.count;
        if (p.count >= BURST_LEAST && is_burst(&p, parting, from, to))
            out->kind = GROUP_BURSTS;
        else if (is_split(&p, parting, from, to))
            out->kind = GROUP_SPLITS;
    }
    pieces_release(&p);
    return status;
}

lmn_status spins_along(bool *out, const depict_job *j, int32_t node, double from, double to, lmn_error *error)
{
    depict_target t;
    turning       turn;
    double        a[3], b[3];
    lmn_status    status = target_open(&t, j, node, error);
    *out = false;
    if (status == LMN_OK) {
        turning_find(&turn, &t.way, from, to, from);
        way_point(&t.way, t.centre, from, a);
        way_point(&t.way, t.centre, to, b);
        vector3_add(b, b, -1, a);
        *out = turn.angle > 6 && vector3_normalise(b) && fabs(vector3_dot(b, turn.axis)) > 0.7;
    }
    target_release(&t);
    return status;
}

lmn_status goes_with(bool *out, const depict_job *j, int32_t node, int32_t other, double from, double to,
                     lmn_error *error)
{
    way        a = {0}, b = {0};
    lmn_status status = way_open(&a, j->scene, node, &j->when, error);
    double     most = 0, gone = 0, first[3], begin[3];
    if (status == LMN_OK)
        status = way_open(&b, j->scene, other, &j->when, error);
    for (int i = 0; i <= STEPS && status == LMN_OK; i++) {
        const double seconds = from + (to - from) * i / STEPS;
        mat4         one = way_world(&a, seconds), two = way_world(&b, seconds);
        double       apart[3];
        vector3_add(apart, &one.m[12], -1, &two.m[12]);
        if (i == 0) {
            vector3_copy(first, apart);
            vector3_copy(begin, &one.m[12]);
        }
        most = fmax(most, vector3_distance(apart, first));
        gone = fmax(gone, vector3_distance(begin, &one.m[12]));
    }
    *out = gone > 0 && most < 0.15 * gone;
    way_release(&a);
    way_release(&b);
    return status;
}
