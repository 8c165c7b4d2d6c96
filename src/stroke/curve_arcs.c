/* The law. A line that is one of many chords of a circle makes a share of the turn at either end with its arc, by its
 * length and that of its neighbour there. So lines between two turns that are alike get that share of them (the
 * geometric mean of both), lines that are much longer than their neighbours stay straight, as beside a fillet, and at
 * each point what both arcs make is stretched to what the polyline turns there: then they meet smoothly. */
#include "stroke/curve_arcs.h"

#include <math.h>

/* Radians: a polyline that turns further on the page has a corner there; one that turns less does not turn. */
#define SHARPEST 1.05
#define STRAIGHT 1e-4
/* Turns and lengths within this factor of each other are alike: a fillet's first turn is half of the others. */
#define ALIKE 3.0
/* A line that is longer than its neighbour by the first factor begins to be straight, by the second it is. */
#define LONG_FROM 2.0
#define LONG_TO   4.0
/* Arcs that make less of a turn than this fraction leave a corner there. */
#define LEAST_SHARE 0.35
/* A smooth point between two that turn by less than this fraction of what it does turns alone: nothing bends there. */
#define ALONE 0.1
/* Part of the way that a smooth point goes aside in each round. */
#define FAIRING 0.35
/* Of what a line may leave the mesh by, points take no more than this. */
#define MOVED_MOST 0.5
/* Smooth points bend by up to so many times more, or less, than both their neighbours. */
#define EXTREME 1.2
enum { STEPS_LEAST = 3, FAIRING_ROUNDS = 8 };

typedef struct polyline {
    arc_point *points;
    size_t     count; /* of points */
    size_t     lines;
    bool       closed;
} polyline;

/* The line that ends at a point, `lines` when there is none. */
static size_t line_before(const polyline *p, size_t i)
{
    return i > 0 ? i - 1 : p->closed ? p->lines - 1 : p->lines;
}

static arc_point *end_of(const polyline *p, size_t line)
{
    return &p->points[line + 1 < p->count ? line + 1 : 0];
}

static double turn_at(const polyline *p, size_t i)
{
    const arc_point *a = &p->points[line_before(p, i)], *b = &p->points[i], *c = end_of(p, i);
    double           ax = b->x - a->x, ay = b->y - a->y, bx = c->x - b->x, by = c->y - b->y;
    return atan2(ax * by - ay * bx, ax * bx + ay * by);
}

static void measure(polyline *p)
{
    for (size_t i = 0; i < p->lines; i++)
        p->points[i].length = hypot(end_of(p, i)->x - p->points[i].x, end_of(p, i)->y - p->points[i].y);
    for (size_t i = 0; i < p->count; i++) {
        arc_point *q = &p->points[i];
        size_t     before = line_before(p, i);
        if (before >= p->lines || i >= p->lines || q->length <= 0 || p->points[before].length <= 0)
            q->kind = ARC_POINT_CORNER;
        q->turn = q->kind == ARC_POINT_CORNER ? 0 : turn_at(p, i);
        if (fabs(q->turn) > SHARPEST) {
            q->kind = ARC_POINT_CORNER;
            q->turn = 0;
        }
    }
}

static bool are_alike(double a, double b)
{
    return a * b > 0 && fabs(a) <= ALIKE * fabs(b) && fabs(b) <= ALIKE * fabs(a);
}

/* How many turns in a row, from a point on and without it, are like the one before each. */
static size_t count_alike(const polyline *p, size_t from, bool forward)
{
    size_t count = 0, at = from;
    while (count < STEPS_LEAST) {
        size_t next = forward ? (at + 1 < p->count ? at + 1 : p->closed ? 0 : p->count) : line_before(p, at);
        if (next >= p->count || next == from || !are_alike(p->points[at].turn, p->points[next].turn))
            break;
        at = next;
        count++;
    }
    return count;
}

/* Where two straight lines meet and neither goes on turning at its other end, as along a cone and then along a
 * cylinder: an edge of the body, however little it turns. */
static bool turns_alone(const polyline *p, size_t i)
{
    double           most = ALONE * fabs(p->points[i].turn);
    const arc_point *before = &p->points[line_before(p, i)], *behind = end_of(p, i);
    return p->count > 2 && fabs(p->points[i].turn) > STRAIGHT &&
           (before->kind == ARC_POINT_CORNER || fabs(before->turn) < most) &&
           (behind->kind == ARC_POINT_CORNER || fabs(behind->turn) < most);
}

/* Steps that are no curve's become corners, and smooth points that turn alone: turns are read until all are judged, so
 * the kind alone is changed, of those that turn alone when all are. */
static void judge_steps(polyline *p)
{
    for (size_t i = 0; i < p->count; i++)
        p->points[i].aside = p->points[i].kind == ARC_POINT_SMOOTH && turns_alone(p, i);
    for (size_t i = 0; i < p->count; i++)
        if (p->points[i].aside != 0)
            p->points[i].kind = ARC_POINT_CORNER;
    for (size_t i = 0; i < p->count; i++)
        if (p->points[i].kind == ARC_POINT_STEP && fabs(p->points[i].turn) > STRAIGHT &&
            count_alike(p, i, true) + count_alike(p, i, false) + 1 < STEPS_LEAST)
            p->points[i].kind = ARC_POINT_CORNER;
    for (size_t i = 0; i < p->count; i++)
        if (p->points[i].kind == ARC_POINT_CORNER)
            p->points[i].turn = 0;
}

/* The line's share of the turn at one of its ends, NAN where nothing is known of it: at corners, and where a much
 * longer line is next. */
static double share_of_turn(const polyline *p, size_t line, bool at_end)
{
    const arc_point *q = at_end ? end_of(p, line) : &p->points[line];
    size_t           other = at_end ? (size_t)(q - p->points) : line_before(p, line);
    double           own = p->points[line].length;
    if (q->kind == ARC_POINT_CORNER || p->points[other].length > ALIKE * own)
        return NAN;
    return q->turn * own / (own + p->points[other].length);
}

/* 1 for a line that may be bent, 0 for one that is much longer than one beside it and not parted from it by a corner.
 */
static double bends(const polyline *p, size_t line)
{
    double           longer = 1;
    const arc_point *begin = &p->points[line], *end = end_of(p, line);
    if (begin->kind != ARC_POINT_CORNER && fabs(begin->turn) > STRAIGHT)
        longer = fmax(longer, begin->length / p->points[line_before(p, line)].length);
    if (end->kind != ARC_POINT_CORNER && fabs(end->turn) > STRAIGHT)
        longer = fmax(longer, begin->length / end->length);
    return fmin(fmax((LONG_TO - longer) / (LONG_TO - LONG_FROM), 0), 1);
}

/* Turn at a point by half the length of both lines: what bends a circle through it. */
static double curvature_at(const polyline *p, size_t i)
{
    return 2 * p->points[i].turn / (p->points[line_before(p, i)].length + p->points[i].length);
}

/* How much the polyline should turn at a smooth point: so that it bends neither much less nor much more than both its
 * neighbours. Next to a corner it should not bend the other way than the next one. */
static double turn_around(const polyline *p, size_t i)
{
    size_t ends[2] = {line_before(p, i), (size_t)(end_of(p, i) - p->points)};
    double low = INFINITY, high = -INFINITY, own = curvature_at(p, i);
    if (own == 0 || (p->points[ends[0]].kind == ARC_POINT_CORNER && p->points[ends[1]].kind == ARC_POINT_CORNER))
        return p->points[i].turn;
    for (int k = 0; k < 2; k++) {
        bool   corner = p->points[ends[k]].kind == ARC_POINT_CORNER;
        double around = corner ? fabs(own) * (p->points[ends[1 - k]].turn < 0 ? -1 : 1) : curvature_at(p, ends[k]);
        low = fmin(low, around);
        high = fmax(high, around);
    }
    if (low * high > 0) { /* where it bends most, or least, is no mistake */
        low *= low < 0 ? EXTREME : 1 / EXTREME;
        high *= high < 0 ? 1 / EXTREME : EXTREME;
    }
    return p->points[i].turn * fmin(fmax(own, low), high) / own;
}

/* How far to its left a point goes in one round. */
static double step_aside(const polyline *p, size_t i)
{
    double a = p->points[line_before(p, i)].length, b = p->points[i].length, wanted = turn_around(p, i);
    double both = bends(p, line_before(p, i)) * bends(p, i);
    return FAIRING * both * (p->points[i].turn - wanted) * a * b / (a + b);
}

static void move_aside(arc_point *q, double x, double y, double most)
{
    double away_x = q->x + x - q->home_x, away_y = q->y + y - q->home_y, away = hypot(away_x, away_y);
    double part = away > most ? most / away : 1;
    q->x = q->home_x + part * away_x;
    q->y = q->home_y + part * away_y;
}

/* Outlines of a mesh run to and fro across the outline of the body that it samples, from edge to edge. Smooth points
 * that bend less or more than both their neighbours move aside until they do not; points of circles stay. */
static void make_fair(polyline *p, double most)
{
    for (size_t i = 0; i < p->count; i++) {
        p->points[i].home_x = p->points[i].x;
        p->points[i].home_y = p->points[i].y;
    }
    for (int round = 0; round < FAIRING_ROUNDS && most > 0; round++) {
        for (size_t i = 0; i < p->count; i++)
            p->points[i].aside = p->points[i].kind == ARC_POINT_SMOOTH ? step_aside(p, i) : 0;
        for (size_t i = 0; i < p->count; i++) {
            if (p->points[i].aside == 0)
                continue;
            const arc_point *a = &p->points[line_before(p, i)], *b = end_of(p, i);
            double           x = b->x - a->x, y = b->y - a->y, length = hypot(x, y);
            if (length > 0)
                move_aside(&p->points[i], -y / length * p->points[i].aside, x / length * p->points[i].aside, most);
        }
        measure(p);
    }
}

/* What a line's arc makes of the turn at either end, as if it were part of a circle. */
static double half_turn(const polyline *p, size_t line)
{
    double a = share_of_turn(p, line, false), b = share_of_turn(p, line, true), half = 0;
    if (isnan(a) || isnan(b))
        half = !isnan(a) ? a : !isnan(b) ? b : 0;
    else if (a * b > 0)
        half = copysign(sqrt(a * b), a);
    return half * bends(p, line);
}

/* Both arcs at a point are stretched so that they make up the turn there; they never make more. */
static void meet(arc *out, const polyline *p, size_t i)
{
    size_t before = line_before(p, i);
    double turn = p->points[i].turn, made = out[before].end + out[i].begin;
    if (p->points[i].kind == ARC_POINT_CORNER || made * turn <= 0)
        return;
    if (made / turn >= LEAST_SHARE) {
        out[before].end *= turn / made;
        out[i].begin *= turn / made;
    }
}

static double moved_by(const arc_point *q)
{
    return hypot(q->x - q->home_x, q->y - q->home_y);
}

/* Slopes instead of angles, and no more of them than `most` allows. */
static void limit(arc *a, double length, double most)
{
    /* Turning left means that the arc lies to the right of its chord. */
    a->begin = -tan(a->begin);
    a->end = -tan(a->end);
    /* u (1 − u)² and u² (1 − u) are 4/27 at most. */
    double farthest = (fabs(a->begin) + fabs(a->end)) * 4 / 27 * length;
    if (farthest > most) {
        a->begin *= most / farthest;
        a->end *= most / farthest;
    }
}

void curve_arcs(arc *out, arc_point *points, size_t count, bool closed, double most)
{
    polyline p = {points, count, closed ? count : count > 0 ? count - 1 : 0, closed};
    if (p.lines == 0)
        return;
    measure(&p);
    judge_steps(&p);
    make_fair(&p, MOVED_MOST * most);
    for (size_t i = 0; i < p.lines; i++)
        out[i].begin = out[i].end = half_turn(&p, i);
    for (size_t i = 0; i < p.lines; i++)
        if (i > 0 || closed)
            meet(out, &p, i);
    for (size_t i = 0; i < p.lines; i++)
        limit(&out[i], points[i].length, most - fmax(moved_by(&points[i]), moved_by(end_of(&p, i))));
}
