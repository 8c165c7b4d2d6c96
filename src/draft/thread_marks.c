#include "draft/thread_marks.h"

#include <math.h>

#include "base/vector3.h"

static const double pi = 3.14159265358979323846;
static const double leaning = 1e-3;       /* cosine */
static const double least = 0.8;          /* mm: the circle of what is smaller is a dot, and its lines are one */
static const double off = 2e-3;           /* of the crests' radius: so far in front of surfaces places are looked at */
static const double before_crests = 0.08; /* of the depth, besides: where corners are near the crests' cylinder */
static const double chamfer_least = 0.02; /* of the crests' radius */
static const double crumb = 0.3;          /* mm: what is shorter is not told apart */
enum { SAMPLES = 192 };

/* A line of the symbol: places along it on the sheet, and in the world those that say whether it is seen. */
typedef struct mark {
    double   at[SAMPLES][2];
    double   places[SAMPLES][3];
    uint32_t before[SAMPLES];
    bool     gone[SAMPLES];
    double   width;
    bool     straight;
} mark;

static void towards_eye(const draft_view *v, double out[3])
{
    const double *m = v->camera->view.m;
    vector3_set(out, m[2], m[6], m[10]);
}

/* 0: it is seen; 1: hidden; 2: not there. */
static int state_of(const mark *m, size_t i)
{
    return m->gone[i] || m->before[i] == UINT32_MAX ? 2 : m->before[i] > 0;
}

static void put_run(const draft_view *v, const mark *m, size_t from, size_t to, bool hidden, uint64_t *count)
{
    double length = 0;
    for (size_t i = from + 1; i <= to; i++)
        length += hypot(m->at[i][0] - m->at[i - 1][0], m->at[i][1] - m->at[i - 1][1]);
    if (length < crumb)
        return;
    const double ends[2][2] = {{m->at[from][0], m->at[from][1]}, {m->at[to][0], m->at[to][1]}};
    draft_polyline(v, m->straight ? ends : (const double(*)[2])m->at + from, m->straight ? 2 : to - from + 1,
                   hidden ? v->narrow : m->width, hidden);
    ++*count;
}

/* Stretches that are seen, and dashed those that are hidden. */
static void put_mark(const draft_view *v, mark *m, const draft_sight *sight, uint64_t *count)
{
    sight->count(sight->user, (const double(*)[3])m->places, SAMPLES, m->before);
    for (size_t i = 0, end; i < SAMPLES; i = end) {
        int state = state_of(m, i);
        for (end = i + 1; end < SAMPLES && state_of(m, end) == state; end++)
            ;
        if (state == 0 || (state == 1 && sight->hidden))
            put_run(v, m, i, end < SAMPLES && state_of(m, end) != 2 ? end : end - 1, state == 1, count);
    }
}

/* A place in the plane of the axis that lies across the view, and how far in front of it the thread's surface is: where
 * that is cut away, the cut face says what is seen. */
static void take_place(mark *m, size_t i, const draft_view *v, const draft_thread *t, const draft_sight *sight,
                       const double place[3], double front)
{
    double eye[3], behind[3];
    towards_eye(v, eye);
    draft_project(v, place, m->at[i]);
    vector3_add(m->places[i], place,
                front > 0 ? front + before_crests * fabs(t->crest - t->root) + off * t->crest : off * t->crest, eye);
    m->gone[i] = false;
    if (!sight->away(sight->user, m->places[i]))
        return;
    vector3_add(behind, place, -off * t->crest, eye);
    vector3_add(m->places[i], place, off * t->crest, eye);
    m->gone[i] = sight->away(sight->user, behind);
}

/* What the crests' radius is so far from the first end. */
static double crest_at(const draft_thread *t, double along)
{
    double       length = vector3_distance(t->ends[0], t->ends[1]);
    double       f = along < t->flat[0]   ? along / t->flat[0]
                     : along > t->flat[1] ? (length - along) / (length - t->flat[1])
                                          : 1;
    const double tip = t->tip[along > t->flat[1]];
    return tip + fmin(fmax(f, 0), 1) * (t->crest - tip);
}

static void put_sides(const draft_view *v, const draft_thread *t, const draft_sight *sight, uint64_t *count)
{
    double eye[3], across[3];
    mark   m = {.width = v->narrow, .straight = true};
    towards_eye(v, eye);
    vector3_cross(across, eye, t->axis);
    vector3_normalise(across);
    const double length = vector3_distance(t->ends[0], t->ends[1]);
    for (int side = -1; side <= 1; side += 2) {
        for (size_t i = 0; i < SAMPLES; i++) {
            double place[3];
            vector3_mix(place, t->ends[0], t->ends[1], (double)i / (SAMPLES - 1));
            vector3_add(place, place, side * t->root, across);
            double crest = crest_at(t, length * (double)i / (SAMPLES - 1));
            take_place(&m, i, v, t, sight, place, t->hollow ? 0 : sqrt(fmax(crest * crest - t->root * t->root, 0)));
            m.gone[i] = m.gone[i] || (t->hollow ? crest > t->root : crest < t->root);
        }
        put_mark(v, &m, sight, count);
    }
}

/* Where a thread ends on what is round, from edge to edge, or its chamfer begins: the length that is useful. */
static void put_limit(const draft_view *v, const draft_thread *t, int end, const draft_sight *sight, uint64_t *count)
{
    double       eye[3], across[3], at[3];
    const double outer = t->goes_on[end] ? fmax(t->crest, t->root) : t->crest;
    mark         m = {.width = v->wide, .straight = true};
    towards_eye(v, eye);
    vector3_cross(across, eye, t->axis);
    vector3_normalise(across);
    for (size_t i = 0; i < SAMPLES; i++) {
        double place[3], x = outer * (2.0 * (double)i / (SAMPLES - 1) - 1);
        vector3_add(at, t->ends[0], t->flat[end], t->axis);
        vector3_add(place, at, x, across);
        take_place(&m, i, v, t, sight, place, t->hollow ? 0 : sqrt(fmax(t->crest * t->crest - x * x, 0)));
    }
    put_mark(v, &m, sight, count);
}

/* Three quarters of a circle, open above on the right. */
static void put_circle(const draft_view *v, const draft_thread *t, const draft_sight *sight, uint64_t *count)
{
    const double *view = v->camera->view.m;
    double        eye[3], right[3] = {view[0], view[4], view[8]}, up[3] = {view[1], view[5], view[9]};
    mark          m = {.width = v->narrow};
    towards_eye(v, eye);
    const double *end = t->ends[vector3_dot(t->axis, eye) > 0];
    for (size_t i = 0; i < SAMPLES; i++) {
        double place[3], angle = pi / 2 + 0.06 + (1.5 * pi - 0.12 + 0.06) * (double)i / (SAMPLES - 1);
        vector3_add(place, end, t->root * cos(angle), right);
        vector3_add(place, place, t->root * sin(angle), up);
        take_place(&m, i, v, t, sight, place, 0);
    }
    put_mark(v, &m, sight, count);
}

void draft_thread_marks(const draft_view *v, const draft_thread *t, const draft_sight *sight, uint64_t *count)
{
    double axis[3];
    draft_turn(v, t->axis, axis);
    if (2 * t->crest * draft_scale(v) < least)
        return;
    if (hypot(axis[0], axis[1]) < leaning) {
        put_circle(v, t, sight, count);
    } else if (fabs(axis[2]) < leaning) {
        put_sides(v, t, sight, count);
        for (int end = 0; end < 2; end++)
            if (t->goes_on[end] ||
                fabs(t->flat[end] - (end ? vector3_distance(t->ends[0], t->ends[1]) : 0)) > chamfer_least * t->crest)
                put_limit(v, t, end, sight, count);
    }
}
