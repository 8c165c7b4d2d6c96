#include "draft/centres.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/vector3.h"

static const double pi = 3.14159265358979323846;
static const double beyond = 10;       /* widths of the line that centre lines run on past what they are of */
static const double same_place = 0.05; /* mm on the sheet */
static const double joined = 8;        /* mm between pieces of one axis that are one line */
static const double least = 0.6;       /* mm: smaller circles are dots already */
static const double leaning = 1e-3;    /* cosine */

/* A straight centre line: part of an endless one, x cos + y sin = offset. */
typedef struct centre_piece {
    double along[2], offset, from, to;
    double join;   /* it is one with another one this far away */
    bool   middle; /* it crosses another one in its middle */
} centre_piece;

typedef struct round_mark {
    double  at[2], radius;
    int32_t pitch; /* −1: none */
} round_mark;

typedef struct centres {
    const draft_view *v;
    centre_piece     *pieces;
    round_mark       *rounds;
    size_t            piece_count, piece_capacity, round_count, round_capacity;
    bool              failed;
} centres;

static void put_piece(centres *c, const double a[2], const double b[2], double join, bool middle)
{
    double length = hypot(b[0] - a[0], b[1] - a[1]);
    if (c->failed || !mem_grow((void **)&c->pieces, &c->piece_capacity, c->piece_count + 1, sizeof *c->pieces)) {
        c->failed = true;
        return;
    }
    centre_piece p = {.along = {(b[0] - a[0]) / length, (b[1] - a[1]) / length}, .join = join, .middle = middle};
    if (p.along[0] < -1e-6 || (fabs(p.along[0]) <= 1e-6 && p.along[1] < 0)) {
        p.along[0] = -p.along[0];
        p.along[1] = -p.along[1];
    }
    double t[2] = {a[0] * p.along[0] + a[1] * p.along[1], b[0] * p.along[0] + b[1] * p.along[1]};
    p.offset = a[1] * p.along[0] - a[0] * p.along[1];
    p.from = fmin(t[0], t[1]);
    p.to = fmax(t[0], t[1]);
    c->pieces[c->piece_count++] = p;
}

/* Of circles around one place the largest counts. */
static void put_round(centres *c, const double at[2], double radius, int32_t pitch)
{
    for (size_t i = 0; i < c->round_count; i++) {
        round_mark *other = &c->rounds[i];
        if (hypot(other->at[0] - at[0], other->at[1] - at[1]) < same_place) {
            other->radius = fmax(other->radius, radius);
            other->pitch = other->pitch < 0 ? pitch : other->pitch;
            return;
        }
    }
    if (c->failed || !mem_grow((void **)&c->rounds, &c->round_capacity, c->round_count + 1, sizeof *c->rounds)) {
        c->failed = true;
        return;
    }
    c->rounds[c->round_count++] = (round_mark){{at[0], at[1]}, radius, pitch};
}

static void take_cylinder(centres *c, const draft_cylinder *cylinder, int32_t pitch)
{
    double axis[3], ends[2][2], radius = cylinder->radius * draft_scale(c->v);
    draft_turn(c->v, cylinder->axis, axis);
    for (int k = 0; k < 2; k++)
        draft_project(c->v, cylinder->ends[k], ends[k]);
    if (radius < least / 2)
        return;
    if (hypot(axis[0], axis[1]) < leaning)
        put_round(c, ends[0], radius, pitch);
    else if (fabs(axis[2]) < leaning && hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]) > same_place)
        put_piece(c, (const double *)ends[0], (const double *)ends[1], joined, false);
}

/* A cross, or on a pitch circle a line through its middle. */
static void cross(centres *c, const round_mark *r, const draft_pitches *pitches)
{
    double reach = r->radius + beyond * c->v->narrow, ways[2][2] = {{1, 0}, {0, 1}};
    int    count = 2;
    if (r->pitch >= 0) {
        double middle[2];
        draft_project(c->v, pitches->items[r->pitch].centre, middle);
        double length = hypot(r->at[0] - middle[0], r->at[1] - middle[1]);
        if (length > same_place) {
            ways[0][0] = (r->at[0] - middle[0]) / length;
            ways[0][1] = (r->at[1] - middle[1]) / length;
            count = 1;
        }
    }
    for (int i = 0; i < count; i++) {
        double ends[2][2];
        for (int k = 0; k < 2; k++)
            for (int n = 0; n < 2; n++)
                ends[k][n] = r->at[n] + (k ? reach : -reach) * ways[i][n];
        put_piece(c, (const double *)ends[0], (const double *)ends[1], 0, true);
    }
}

static int compare_pieces(const void *a, const void *b)
{
    const centre_piece *x = a, *y = b;
    const double        one[4] = {x->along[0], x->along[1], x->offset, x->from},
                 other[4] = {y->along[0], y->along[1], y->offset, y->from};
    for (int k = 0; k < 4; k++)
        if (one[k] != other[k])
            return one[k] < other[k] ? -1 : 1;
    return 0;
}

static bool are_one_line(const centre_piece *a, const centre_piece *b)
{
    double apart = fmax(a->from, b->from) - fmin(a->to, b->to);
    return fabs(a->along[0] * b->along[1] - a->along[1] * b->along[0]) < leaning &&
           fabs(a->offset - b->offset) < same_place && apart <= fmin(a->join, b->join);
}

/* Pieces that lie on each other, or behind one another on one axis, become one. */
static void join_pieces(centres *c)
{
    if (c->piece_count)
        qsort(c->pieces, c->piece_count, sizeof *c->pieces, compare_pieces);
    for (bool again = true; again;) {
        again = false;
        for (size_t i = 0; i < c->piece_count; i++)
            for (size_t k = i + 1; k < c->piece_count;) {
                centre_piece *a = &c->pieces[i], *b = &c->pieces[k];
                if (!are_one_line(a, b)) {
                    k++;
                    continue;
                }
                bool alike = fabs(a->from + a->to - b->from - b->to) < same_place;
                a->middle = alike && a->middle && b->middle;
                a->from = fmin(a->from, b->from);
                a->to = fmax(a->to, b->to);
                a->join = fmax(a->join, b->join);
                *b = c->pieces[--c->piece_count];
                again = true;
            }
    }
}

static void draw_piece(const centres *c, const centre_piece *p, double from, double to, bool middle, uint64_t *count)
{
    const double reach[2] = {from, to};
    double       ends[2][2];
    for (int k = 0; k < 2; k++) {
        ends[k][0] = reach[k] * p->along[0] - p->offset * p->along[1];
        ends[k][1] = reach[k] * p->along[1] + p->offset * p->along[0];
    }
    draft_chain_line(c->v, (const double(*)[2])ends, 2, c->v->narrow, middle);
    ++*count;
}

/* How far a segment covers a piece's line; false: it does not lie on it. */
static bool covers(const centre_piece *p, const double segment[2][2], double *from, double *to)
{
    double t[2];
    for (int k = 0; k < 2; k++) {
        if (fabs(segment[k][1] * p->along[0] - segment[k][0] * p->along[1] - p->offset) > same_place)
            return false;
        t[k] = segment[k][0] * p->along[0] + segment[k][1] * p->along[1];
    }
    *from = fmin(t[0], t[1]);
    *to = fmax(t[0], t[1]);
    return true;
}

/* What is left of each beside lines that come before it, in one piece on either side. */
static void draw_pieces(const centres *c, draft_segments before, uint64_t *count)
{
    for (size_t i = 0; i < c->piece_count; i++) {
        const centre_piece *p = &c->pieces[i];
        double longer = p->join > 0 ? beyond * c->v->narrow : 0, from = p->from - longer, to = p->to + longer;
        double covered[2] = {INFINITY, -INFINITY}, low, high, shortest = 2 * beyond * c->v->narrow;
        for (size_t k = 0; k < before.count; k++)
            if (covers(p, before.items[k], &low, &high) && low < to && high > from) {
                covered[0] = fmin(covered[0], low);
                covered[1] = fmax(covered[1], high);
            }
        if (!(covered[0] < covered[1])) {
            draw_piece(c, p, from, to, p->middle, count);
            continue;
        }
        if (covered[0] - from > shortest)
            draw_piece(c, p, from, covered[0], false, count);
        if (to - covered[1] > shortest)
            draw_piece(c, p, covered[1], to, false, count);
    }
}

/* Where the cylinders of a pitch circle are, as angles of the sheet. */
static void draw_part(const draft_view *v, const draft_pitch *p)
{
    enum { STEPS = 64 };
    double step = 2 * pi / (double)p->steps, points[STEPS + 1][2];
    for (int i = 0; i <= STEPS; i++) {
        double angle = p->from - step / 4 + (p->sweep + step / 2) * i / STEPS, world[3];
        vector3_add(world, p->centre, p->radius * cos(angle), p->across[0]);
        vector3_add(world, world, p->radius * sin(angle), p->across[1]);
        draft_project(v, world, points[i]);
    }
    draft_chain_line(v, (const double(*)[2])points, STEPS + 1, v->narrow, false);
}

static bool is_drawn_already(const draft_view *v, const draft_pitches *pitches, const bool *wanted, size_t index)
{
    double at[2], other[2];
    draft_project(v, pitches->items[index].centre, at);
    for (size_t i = 0; i < index; i++) {
        const draft_pitch *a = &pitches->items[i], *b = &pitches->items[index];
        draft_project(v, a->centre, other);
        if (wanted[i] && hypot(at[0] - other[0], at[1] - other[1]) < same_place && a->count >= b->count &&
            fabs(a->radius - b->radius) * draft_scale(v) < same_place &&
            (a->count == a->steps || fabs(remainder(a->from - b->from, 2 * pi)) < 1e-3))
            return true;
    }
    return false;
}

static void draw_pitches(const draft_view *v, const draft_pitches *pitches, const bool *wanted, uint64_t *count)
{
    for (size_t i = 0; i < pitches->count; i++) {
        const draft_pitch *p = &pitches->items[i];
        double             axis[3], centre[2];
        draft_turn(v, p->axis, axis);
        if (!wanted[i] || hypot(axis[0], axis[1]) > leaning || is_drawn_already(v, pitches, wanted, i))
            continue;
        draft_project(v, p->centre, centre);
        if (p->count == p->steps)
            draft_chain_circle(v, centre, p->radius * draft_scale(v), v->narrow);
        else
            draw_part(v, p);
        ++*count;
    }
}

lmn_status draft_centres(const draft_view *v, const draft_cylinders *cylinders, const draft_pitches *pitches,
                         const bool *shown, draft_segments before, uint64_t *count, lmn_error *error)
{
    centres c = {.v = v};
    bool   *wanted = mem_calloc(pitches->count + 1, sizeof *wanted);
    if (!wanted)
        return error_memory(error);
    for (size_t i = 0; i < cylinders->count; i++) {
        if (!shown[i])
            continue;
        take_cylinder(&c, &cylinders->items[i], pitches->of_cylinder[i]);
        if (pitches->of_cylinder[i] >= 0)
            wanted[pitches->of_cylinder[i]] = true;
    }
    for (size_t i = 0; i < c.round_count; i++)
        cross(&c, &c.rounds[i], pitches);
    join_pieces(&c);
    draw_pitches(v, pitches, wanted, count);
    draw_pieces(&c, before, count);
    mem_free(wanted);
    mem_free(c.pieces);
    mem_free(c.rounds);
    return c.failed ? error_memory(error) : LMN_OK;
}
