/* From one corner to the next, the piece that reaches farthest for what it costs; then the next one. Where two lines or
 * arcs meet, the point between them is moved to where both fit best: the longest piece within an error would run on
 * into what is another one's, and take its radius with it. */
#include "sheet/fit.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "sheet/fit_private.h"

/* Numbers that a writer of coordinates needs for a piece, more or less. */
static const double cost_of_line = 1, cost_of_arc = 2, cost_of_ellipse = 3, cost_of_cubic = 3;
#define PI 3.14159265358979323846
static const double nothing = 1e-6; /* mm: points that are one */
/* Outlines of strokes have two sides, and what both are off is a part of a width that may be small. */
static const double outline_part = 0.3;
enum { ELLIPSE_LEAST = 8, CUBIC_POINTS_MOST = 600 };

typedef struct fitter {
    sheet *s;
    double most;
    double (*points)[2]; /* of the path at hand */
    double      *arcs;
    size_t       count, point_capacity, arc_capacity;
    double      *parameters;
    size_t       parameter_capacity;
    sheet_piece *pieces;
    size_t      *ends; /* of each piece: its last point */
    size_t       piece_count, piece_capacity, end_capacity;
    bool         failed;
} fitter;

static fit_run run_of(const fitter *f, size_t first, size_t last)
{
    return (fit_run){(const double(*)[2])f->points + first, f->arcs + first, last - first + 1, f->most};
}

static void put_piece(fitter *f, const sheet_piece *piece, size_t last)
{
    if (f->failed || !mem_grow((void **)&f->pieces, &f->piece_capacity, f->piece_count + 1, sizeof *f->pieces) ||
        !mem_grow((void **)&f->ends, &f->end_capacity, f->piece_count + 1, sizeof *f->ends)) {
        f->failed = true;
        return;
    }
    f->pieces[f->piece_count] = *piece;
    f->ends[f->piece_count++] = last;
}

/* --- one piece ------------------------------------------------------------------------------------------ */

typedef struct try_out {
    fitter       *f;
    const double *begin; /* the direction that a cubic has to begin in; NULL: any */
} try_out;
typedef bool (*try_fn)(const try_out *t, size_t first, size_t last, sheet_piece *out);

static bool try_line(const try_out *t, size_t first, size_t last, sheet_piece *out)
{
    fit_run r = run_of(t->f, first, last);
    return fit_line(out, &r, NULL);
}

static bool try_arc(const try_out *t, size_t first, size_t last, sheet_piece *out)
{
    fit_run r = run_of(t->f, first, last);
    return fit_arc(out, &r, NULL);
}

static bool try_ellipse(const try_out *t, size_t first, size_t last, sheet_piece *out)
{
    fit_run r = run_of(t->f, first, last);
    return fit_ellipse(out, &r);
}

static bool try_cubic(const try_out *t, size_t first, size_t last, sheet_piece *out)
{
    fit_run r = run_of(t->f, first, last);
    if (r.count > CUBIC_POINTS_MOST ||
        !mem_grow((void **)&t->f->parameters, &t->f->parameter_capacity, r.count, sizeof *t->f->parameters))
        return false;
    return fit_cubic(out, &r, t->begin, NULL, t->f->parameters);
}

/* The farthest point that a kind of piece reaches from one; `first` when it reaches none. */
static size_t reach(try_fn fits, const try_out *t, size_t first, size_t least, size_t last, sheet_piece *out)
{
    sheet_piece piece;
    size_t      good = first, bad = last + 1;
    if (first + least > last)
        return first;
    if (fits(t, first, last, &piece)) {
        *out = piece;
        return last;
    }
    bad = last;
    for (size_t step = least; good + step < bad; step *= 2) {
        if (!fits(t, first, first + step, &piece)) {
            bad = first + step;
            break;
        }
        good = first + step;
        *out = piece;
    }
    if (good == first)
        return first;
    while (good + 1 < bad) {
        size_t middle = good + (bad - good) / 2;
        if (fits(t, first, middle, &piece)) {
            good = middle;
            *out = piece;
        } else {
            bad = middle;
        }
    }
    return good;
}

static double length_of(const fitter *f, size_t first, size_t last)
{
    return f->arcs[last] - f->arcs[first];
}

/* After how many points a kind of piece is worth more than what there is, whose length this is; at least so many. 0:
 * not before the last one. */
static size_t worth_from(const fitter *f, size_t first, size_t last, double length, size_t least)
{
    if (first + least > last || length_of(f, first, last) <= length)
        return 0;
    while (length_of(f, first, first + least) <= length)
        least++;
    return least;
}

/* The piece from one point on that is worth most, and its end. */
static size_t best_piece(fitter *f, size_t first, size_t last, const double *begin, sheet_piece *out)
{
    static const struct {
        try_fn        fits;
        const double *cost;
        size_t        least;
    } kinds[] = {{try_line, &cost_of_line, 1},
                 {try_arc, &cost_of_arc, 3},
                 {try_ellipse, &cost_of_ellipse, ELLIPSE_LEAST},
                 {try_cubic, &cost_of_cubic, 4}};
    const try_out t = {f, begin};
    double        best = -1;
    size_t        end = first;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        sheet_piece piece;
        size_t      least = worth_from(f, first, last, best * *kinds[k].cost, kinds[k].least);
        size_t      own = least ? reach(kinds[k].fits, &t, first, least, last, &piece) : first;
        double      worth = own > first ? length_of(f, first, own) / *kinds[k].cost : 0;
        if (own > first && worth > best) {
            best = worth;
            end = own;
            *out = piece;
        }
        if (own == last)
            break; /* what comes behind costs more */
    }
    return end;
}

/* --- where two pieces meet ------------------------------------------------------------------------------ */

/* Lines and arcs again, between other points; the sum of squares that they are off. */
static bool fit_again(const fitter *f, sheet_piece_kind kind, size_t first, size_t last, sheet_piece *out,
                      double *square)
{
    fit_run r = run_of(f, first, last);
    return kind == SHEET_LINE ? fit_line(out, &r, square) : fit_arc(out, &r, square);
}

/* The last two pieces meet at the point where both are nearest to theirs. */
static void relax(fitter *f)
{
    size_t       n = f->piece_count, first = n > 2 ? f->ends[n - 3] : 0, last = f->ends[n - 1], at = f->ends[n - 2];
    sheet_piece *before = &f->pieces[n - 2], *behind = &f->pieces[n - 1], a, b;
    double       one, other, best;
    if (before->kind == SHEET_CUBIC || behind->kind == SHEET_CUBIC || before->radii[0] != before->radii[1] ||
        behind->radii[0] != behind->radii[1] || !fit_again(f, before->kind, first, at, &a, &one) ||
        !fit_again(f, behind->kind, at, last, &b, &other))
        return;
    best = one + other;
    for (size_t step = (at - first) / 2 + 1; step > 0; step /= 2)
        for (int way = -1; way <= 1; way += 2) {
            size_t to = way < 0 ? (at > first + step ? at - step : first) : at + step;
            if (to <= first || to >= last || !fit_again(f, before->kind, first, to, &a, &one) ||
                !fit_again(f, behind->kind, to, last, &b, &other) || one + other >= best)
                continue;
            best = one + other;
            at = to;
            *before = a;
            *behind = b;
            f->ends[n - 2] = to;
        }
}

/* --- one path ------------------------------------------------------------------------------------------- */

/* Can nothing bent pass here within the error? A circle through corners so far apart that turn so far leaves its chords
 * by an eighth of both. */
static bool is_corner(const fitter *f, const double *a, const double *p, const double *b)
{
    double in[2] = {p[0] - a[0], p[1] - a[1]}, on[2] = {b[0] - p[0], b[1] - p[1]},
           along = in[0] * on[0] + in[1] * on[1],
           square = fmin(in[0] * in[0] + in[1] * in[1], on[0] * on[0] + on[1] * on[1]), least = 64 * f->most * f->most;
    if (square * (PI * PI) < least)
        return false; /* however far it turns */
    double across = fabs(in[0] * on[1] - in[1] * on[0]), whole = across * across + along * along;
    if (along > 0 && square * across * across * 2.5 < least * whole) /* the angle is at most 1.571 times its sine */
        return false;
    double turn = atan2(across, along);
    return square * turn * turn > least;
}

/* From one corner to the next. */
static void fit_smooth(fitter *f, size_t first, size_t last)
{
    size_t begun = f->piece_count;
    for (size_t at = first; at < last && !f->failed;) {
        sheet_piece   piece;
        double        direction[2];
        const double *from = f->piece_count > begun + 1 ? f->pieces[f->piece_count - 2].end : f->points[first];
        bool   known = f->piece_count > begun && fit_direction(&f->pieces[f->piece_count - 1], from, true, direction);
        size_t end = best_piece(f, at, last, known ? direction : NULL, &piece);
        put_piece(f, &piece, end);
        if (f->piece_count > begun + 1 && !f->failed)
            relax(f);
        at = end;
    }
}

/* Copies the points of a path, those that are one once, the first one behind the last of a closed path. */
static bool take_points(fitter *f, const sheet_path *path)
{
    if (!mem_grow((void **)&f->points, &f->point_capacity, (size_t)path->count + 1, sizeof *f->points))
        return false;
    if (!mem_grow((void **)&f->arcs, &f->arc_capacity, (size_t)path->count + 1, sizeof *f->arcs))
        return false;
    f->count = 0;
    for (uint32_t i = 0; i <= path->count; i++) {
        if (i == path->count && !path->closed && !path->filled)
            break;
        const float  *p = f->s->points[path->first + (i < path->count ? i : 0)];
        const double *before = f->count ? f->points[f->count - 1] : NULL;
        f->points[f->count][0] = (double)p[0];
        f->points[f->count][1] = (double)p[1];
        double step = before ? fit_distance((double)p[0] - before[0], (double)p[1] - before[1]) : 0;
        f->arcs[f->count] = before ? f->arcs[f->count - 1] + step : 0;
        if (!before || step > nothing)
            f->count++;
    }
    return true;
}

/* A closed path begins at a corner, so that none is where it happens to begin. */
static void begin_at_corner(fitter *f, const sheet_path *path)
{
    size_t n = f->count - 1, corner = 0;
    while (corner < n &&
           !is_corner(f, f->points[corner ? corner - 1 : n - 1], f->points[corner], f->points[corner + 1]))
        corner++;
    if (corner == 0 || corner == n || path->dash_count)
        return;
    float(*points)[2] = f->s->points + path->first;
    for (uint32_t i = 0; i < path->count; i++) {
        const double *p = f->points[corner];
        if ((double)points[i][0] != p[0] || (double)points[i][1] != p[1])
            continue;
        for (uint32_t k = 0; k < path->count; k++) {
            const float *from = points[(i + k) % path->count];
            f->points[k][0] = (double)from[0];
            f->points[k][1] = (double)from[1];
        }
        for (uint32_t k = 0; k < path->count; k++) {
            points[k][0] = (float)f->points[k][0];
            points[k][1] = (float)f->points[k][1];
        }
        break;
    }
    take_points(f, path);
}

static bool fit_round(fitter *f)
{
    sheet_piece piece;
    fit_run     r = run_of(f, 0, f->count - 1);
    if (!fit_circle(&piece, &r) && !fit_whole_ellipse(&piece, &r))
        return false;
    put_piece(f, &piece, f->count - 1);
    return true;
}

static void fit_path(fitter *f, const sheet_path *path)
{
    bool closed = path->closed || path->filled;
    f->piece_count = 0;
    if (!take_points(f, path)) {
        f->failed = true;
        return;
    }
    if (closed && f->count > 2)
        begin_at_corner(f, path);
    if (f->count < 2 || (closed && f->count > ELLIPSE_LEAST && fit_round(f)))
        return;
    for (size_t first = 0, i = 1; i < f->count; i++)
        if (i + 1 == f->count || is_corner(f, f->points[i - 1], f->points[i], f->points[i + 1])) {
            fit_smooth(f, first, i);
            first = i;
        }
}

/* Dashes end with the line that they are of: a curve is longer than its chords. */
static void stretch_dashes(const fitter *f, sheet_path *path)
{
    double        length = 0, before = length_of(f, 0, f->count - 1);
    const double *from = f->points[0];
    for (size_t i = 0; i < f->piece_count; from = f->pieces[i++].end)
        length += fit_length(&f->pieces[i], from);
    float by = before > 0 ? (float)(length / before) : 1;
    for (uint32_t i = 0; i < path->dash_count; i++)
        f->s->dashes[path->first_dash + i] *= by;
    path->phase *= by;
}

static void keep_pieces(fitter *f, sheet_path *path)
{
    sheet *s = f->s;
    if (f->failed || s->piece_count + f->piece_count > UINT32_MAX ||
        !mem_grow((void **)&s->pieces, &s->piece_capacity, s->piece_count + f->piece_count, sizeof *s->pieces)) {
        f->failed = true;
        return;
    }
    if (path->dash_count && f->piece_count)
        stretch_dashes(f, path);
    if (f->piece_count)
        memcpy(s->pieces + s->piece_count, f->pieces, f->piece_count * sizeof *s->pieces);
    path->first_piece = (uint32_t)s->piece_count;
    path->piece_count = (uint32_t)f->piece_count;
    s->piece_count += f->piece_count;
}

void sheet_fit(sheet *s, double most)
{
    fitter f = {.s = s, .most = most};
    if (!(most > 0) || s->failed)
        return;
    for (size_t i = 0; i < s->path_count && !f.failed; i++) {
        if (!s->paths[i].curved)
            continue;
        f.most = s->paths[i].filled ? outline_part * most : most;
        fit_path(&f, &s->paths[i]);
        keep_pieces(&f, &s->paths[i]);
    }
    s->failed = s->failed || f.failed;
    mem_free(f.points);
    mem_free(f.arcs);
    mem_free(f.parameters);
    mem_free(f.pieces);
    mem_free(f.ends);
}
