#include "stroke/wheels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/stroke_private.h"

/* A point with fewer triangles has no wheel: cells may hold as many (grid.c). */
enum { WHEEL_LEAST = 256 };
/* Each level's triangles are half as wide as those of the one before, but for the last one's. */
enum { LEVELS = 12 };
/* Lines as near to a corner may run along the edge to it, pixels; more than visibility.c takes for near. */
#define NEAR     0.03
#define ROUNDING 1e-5
#define TURN     6.283185307179586

static double positive_turn(double angle)
{
    return angle < 0 ? angle + TURN : angle >= TURN ? angle - TURN : angle;
}

/* The directions of a triangle as seen from one of its corners, and what is near them. */
static wheel_spoke spoke_of(const stroke_view *v, uint32_t number, int corner, uint32_t wheel)
{
    const window_triangle *t = &v->triangles[number];
    const window_point     middle = v->points[t->v[corner]];
    double                 angles[2], margin = ROUNDING;
    wheel_spoke            out = {.wheel = wheel, .triangle = number, .width = (float)TURN};
    for (int k = 0; k < 2; k++) {
        const window_point p = v->points[t->v[(corner + 1 + k) % 3]];
        const double       x = (double)p.x - middle.x, y = (double)p.y - middle.y, length = sqrt(x * x + y * y);
        if (length <= 4 * NEAR * v->units)
            return out;
        margin = fmax(margin, 2 * NEAR * v->units / length + ROUNDING);
        angles[k] = atan2(y, x);
    }
    double turn = positive_turn(angles[1] - angles[0]);
    double from = turn <= 0.5 * TURN ? angles[0] : angles[1], width = fmin(turn, TURN - turn) + 2 * margin;
    out.from = (float)positive_turn(positive_turn(from) - margin);
    out.width = (float)width;
    while (out.level + 1 < LEVELS && width < TURN / (double)(2u << out.level))
        out.level++;
    return out;
}

static int compare_spokes(const void *a, const void *b)
{
    const wheel_spoke *p = a, *q = b;
    if (p->wheel != q->wheel)
        return p->wheel < q->wheel ? -1 : 1;
    if (p->level != q->level)
        return p->level < q->level ? -1 : 1;
    if (p->from != q->from)
        return p->from < q->from ? -1 : 1;
    return (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

/* Numbers points that enough triangles share, where there are counts; how many. */
static uint32_t number_wheels(uint32_t *of_points, size_t count)
{
    uint32_t wheels = 0;
    for (size_t i = 0; i < count; i++)
        of_points[i] = of_points[i] >= WHEEL_LEAST ? ++wheels : 0;
    return wheels;
}

static void put_spokes(window_wheels *out, const stroke_view *v)
{
    for (uint32_t i = 0; i < v->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            const uint32_t wheel = out->of_points[v->triangles[i].v[k]];
            if (!wheel || out->of_triangles[i])
                continue;
            out->of_triangles[i] = wheel;
            out->spokes[out->count++] = spoke_of(v, i, k, wheel);
        }
    qsort(out->spokes, out->count, sizeof *out->spokes, compare_spokes);
}

bool wheels_make(window_wheels *out, const stroke_view *v)
{
    memset(out, 0, sizeof *out);
    out->of_points = mem_calloc(v->point_count + 1, sizeof *out->of_points);
    for (size_t i = 0; i < v->triangle_count && out->of_points; i++)
        for (int k = 0; k < 3; k++)
            out->of_points[v->triangles[i].v[k]]++;
    if (!out->of_points)
        return false;
    if (number_wheels(out->of_points, v->point_count) == 0) {
        wheels_release(out);
        return true;
    }
    out->of_triangles = mem_calloc(v->triangle_count + 1, sizeof *out->of_triangles);
    out->spokes = mem_alloc((v->triangle_count + 1) * sizeof *out->spokes);
    if (!out->of_triangles || !out->spokes)
        return false;
    put_spokes(out, v);
    return true;
}

void wheels_release(window_wheels *w)
{
    mem_free(w->of_points);
    mem_free(w->of_triangles);
    mem_free(w->spokes);
    memset(w, 0, sizeof *w);
}

/* The first spoke that is not before a direction of a level. */
static size_t find_spoke(const window_wheels *w, uint32_t wheel, uint32_t level, double from)
{
    size_t low = 0, high = w->count;
    while (low < high) {
        const size_t       middle = low + (high - low) / 2;
        const wheel_spoke *s = &w->spokes[middle];
        const bool         before = s->wheel != wheel   ? s->wheel < wheel
                                    : s->level != level ? s->level < level
                                                        : s->from < from;
        if (before)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static void walk_between(const window_wheels *w, const uint32_t place[2], double from, double to, wheel_visit visit,
                         void *user)
{
    for (size_t i = find_spoke(w, place[0], place[1], from); i < w->count; i++) {
        const wheel_spoke *s = &w->spokes[i];
        if (s->wheel != place[0] || s->level != place[1] || s->from > to)
            return;
        visit(user, s->triangle);
    }
}

void wheel_walk(const window_wheels *w, uint32_t wheel, double x, double y, wheel_visit visit, void *user)
{
    const double at = positive_turn(atan2(y, x));
    for (uint32_t level = 0; level < LEVELS; level++) {
        const uint32_t place[2] = {wheel, level};
        const double   widest = TURN / (double)(1u << level), from = at - widest - ROUNDING, to = at + ROUNDING;
        if (level == 0) {
            walk_between(w, place, -1, 2 * TURN, visit, user);
            continue;
        }
        walk_between(w, place, from, to, visit, user);
        if (from < 0)
            walk_between(w, place, from + TURN, 2 * TURN, visit, user);
        if (to >= TURN)
            walk_between(w, place, -1, to - TURN, visit, user);
    }
}
