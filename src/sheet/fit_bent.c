/* One piece through a run of points: arcs of ellipses and cubic Béziers. Both are found by least squares and then held
 * against the lines. */
#include <math.h>
#include <string.h>

#include "sheet/fit_private.h"

#define PI 3.14159265358979323846
/* Straight pieces that a curve is looked at in are so much nearer to it than it has to be to the lines. */
#define LOOK_ERROR 0.03
/* Errors by which points are off their place on a cubic, at which better parameters are not looked for. */
#define HOPELESS 5

/* --- ellipses ------------------------------------------------------------------------------------------- */

static void ellipse_at(const sheet_piece *piece, const double from[2], double fraction, double out[2])
{
    (void)from;
    sheet_arc_at(piece, piece->from + fraction * piece->sweep, out);
}

static int looks_at_arc(const sheet_piece *arc, double most)
{
    double step = sqrt(8 * LOOK_ERROR * most / fmax(arc->radii[0], arc->radii[1]));
    double pieces = ceil(fabs(arc->sweep) / fmin(fmax(step, 1e-3), 0.5));
    return (int)fmax(pieces, 8);
}

/* Solves `count` linear equations in place; the matrix has a row of `count` + 1 numbers each. */
static bool solve(double *rows, int count, double *out)
{
    int width = count + 1;
    for (int k = 0; k < count; k++) {
        int best = k;
        for (int i = k + 1; i < count; i++)
            best = fabs(rows[i * width + k]) > fabs(rows[best * width + k]) ? i : best;
        if (!(fabs(rows[best * width + k]) > 1e-12))
            return false;
        for (int j = 0; j < width && best != k; j++) {
            double kept = rows[k * width + j];
            rows[k * width + j] = rows[best * width + j];
            rows[best * width + j] = kept;
        }
        for (int i = k + 1; i < count; i++) {
            double part = rows[i * width + k] / rows[k * width + k];
            for (int j = k; j < width; j++)
                rows[i * width + j] -= part * rows[k * width + j];
        }
    }
    for (int k = count; k-- > 0;) {
        out[k] = rows[k * width + count];
        for (int j = k + 1; j < count; j++)
            out[k] -= rows[k * width + j] * out[j];
        out[k] /= rows[k * width + k];
    }
    return true;
}

/* What makes numbers about 1. */
typedef struct frame {
    double middle[2], scale;
} frame;

static frame frame_of(const fit_run *r)
{
    frame  f = {{0, 0}, 0};
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < r->count; i++)
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], r->points[i][k]);
            high[k] = fmax(high[k], r->points[i][k]);
        }
    for (int k = 0; k < 2; k++)
        f.middle[k] = 0.5 * (low[k] + high[k]);
    f.scale = 0.5 * fmax(high[0] - low[0], high[1] - low[1]);
    return f;
}

/* Centre, radii and turn of the ellipse a x² + b xy + c y² + d x + e y = 1; false: it is none. */
static bool take_ellipse(sheet_piece *out, const double conic[5], const frame *f)
{
    double a = conic[0], b = conic[1], c = conic[2], d = conic[3], e = conic[4], whole = 4 * a * c - b * b;
    if (!(whole > 1e-9))
        return false;
    double x = (b * e - 2 * c * d) / whole, y = (b * d - 2 * a * e) / whole;
    double rest = 1 - (a * x * x + b * x * y + c * y * y + d * x + e * y);
    double mean = 0.5 * (a + c), apart = fit_distance(0.5 * (a - c), 0.5 * b), least = rest / (mean + apart),
           most = rest / (mean - apart);
    if (!(least > 0) || !(most > 0) || !(most < 1e6))
        return false;
    *out = (sheet_piece){.kind = SHEET_ARC,
                         .centre = {f->middle[0] + f->scale * x, f->middle[1] + f->scale * y},
                         .radii = {f->scale * sqrt(most), f->scale * sqrt(least)},
                         .turn = 0.5 * atan2(-b, c - a)};
    return true;
}

/* Least squares of the conic's equation, whose constant is fixed: points are not near the middle of their frame, or a
 * small part of the ellipse alone. */
static bool find_ellipse(sheet_piece *out, const fit_run *r, size_t count)
{
    frame  f = frame_of(r);
    double rows[5 * 6], conic[5];
    memset(rows, 0, sizeof rows);
    if (count < 6 || !(f.scale > 0))
        return false;
    for (size_t i = 0; i < count; i++) {
        double x = (r->points[i][0] - f.middle[0]) / f.scale, y = (r->points[i][1] - f.middle[1]) / f.scale;
        double terms[6] = {x * x, x * y, y * y, x, y, 1};
        for (int k = 0; k < 5; k++)
            for (int j = 0; j < 6; j++)
                rows[6 * k + j] += terms[k] * terms[j];
    }
    return solve(rows, 5, conic) && take_ellipse(out, conic, &f);
}

/* A position where the ellipse is the unit circle around the origin. */
static void to_unit(const sheet_piece *e, const double p[2], double out[2])
{
    double c = cos(e->turn), s = sin(e->turn);
    out[0] = (c * p[0] + s * p[1]) / e->radii[0];
    out[1] = (c * p[1] - s * p[0]) / e->radii[1];
}

/* Twice the area to the left of the way round, of the chord too. */
static double area_of(const fit_run *r)
{
    double sum = 0;
    for (size_t i = 0; i < r->count; i++) {
        const double *a = r->points[i], *b = r->points[i + 1 < r->count ? i + 1 : 0];
        sum += a[0] * b[1] - a[1] * b[0];
    }
    return sum;
}

bool fit_whole_ellipse(sheet_piece *out, const fit_run *r)
{
    if (!find_ellipse(out, r, r->count - 1))
        return false;
    double first[2] = {r->points[0][0] - out->centre[0], r->points[0][1] - out->centre[1]}, unit[2], on[2];
    to_unit(out, first, unit);
    out->from = atan2(unit[1], unit[0]);
    out->sweep = area_of(r) > 0 ? 2 * PI : -2 * PI;
    sheet_arc_at(out, out->from, on);
    for (int k = 0; k < 2; k++) { /* the first point is put on it */
        out->centre[k] += r->points[0][k] - on[k];
        out->end[k] = r->points[0][k];
    }
    return fit_follows(out, ellipse_at, looks_at_arc(out, r->most), r);
}

/* Both ends are put on it: of the two ellipses of these radii through them, the nearer one. */
static bool put_ends_on(sheet_piece *e, const double a[2], const double b[2], double direction)
{
    double ua[2], ub[2], centre[2], mid[2], unit[2];
    to_unit(e, a, ua);
    to_unit(e, b, ub);
    to_unit(e, e->centre, centre);
    double way[2] = {ub[0] - ua[0], ub[1] - ua[1]}, chord = fit_distance(way[0], way[1]), half = 0.5 * chord;
    if (!(chord > 1e-6) || !(half < 1))
        return false;
    for (int k = 0; k < 2; k++)
        mid[k] = 0.5 * (ua[k] + ub[k]);
    double apart = sqrt(1 - half * half) / chord;
    double side = (centre[0] - mid[0]) * -way[1] + (centre[1] - mid[1]) * way[0] > 0 ? apart : -apart;
    unit[0] = mid[0] - side * way[1];
    unit[1] = mid[1] + side * way[0];
    e->from = atan2(ua[1] - unit[1], ua[0] - unit[0]);
    double to = atan2(ub[1] - unit[1], ub[0] - unit[0]), sweep = direction * (to - e->from);
    e->sweep = direction * (sweep > 0 ? sweep : sweep + 2 * PI);
    double x = unit[0] * e->radii[0], y = unit[1] * e->radii[1], c = cos(e->turn), s = sin(e->turn);
    e->centre[0] = c * x - s * y;
    e->centre[1] = s * x + c * y;
    e->end[0] = b[0];
    e->end[1] = b[1];
    return true;
}

bool fit_ellipse(sheet_piece *out, const fit_run *r)
{
    return find_ellipse(out, r, r->count) && out->radii[1] > 2 * r->most &&
           put_ends_on(out, r->points[0], r->points[r->count - 1], area_of(r) > 0 ? 1 : -1) && fabs(out->sweep) > 0.3 &&
           fit_follows(out, ellipse_at, looks_at_arc(out, r->most), r);
}

/* --- cubics --------------------------------------------------------------------------------------------- */

static void cubic_at(const sheet_piece *piece, const double from[2], double u, double out[2])
{
    double v = 1 - u, w[4] = {v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
    for (int k = 0; k < 2; k++)
        out[k] = w[0] * from[k] + w[1] * piece->controls[0][k] + w[2] * piece->controls[1][k] + w[3] * piece->end[k];
}

static int looks_at_cubic(const sheet_piece *c, const double from[2], double most)
{
    double bent = 0;
    for (int k = 0; k < 2; k++) {
        double one = from[k] - 2 * c->controls[0][k] + c->controls[1][k],
               two = c->controls[0][k] - 2 * c->controls[1][k] + c->end[k];
        bent += fmax(one * one, two * two);
    }
    /* Off by less than a second derivative, 6 of these, over 8 by the square of the number. */
    return (int)fmax(ceil(sqrt(0.75 * sqrt(bent) / (LOOK_ERROR * most))), 8);
}

/* One step towards the parameter at which the curve is nearest to each point (Schneider 1990). */
static void come_nearer(const sheet_piece *c, const fit_run *r, double *parameters)
{
    const double *from = r->points[0];
    for (size_t i = 1; i + 1 < r->count; i++) {
        double u = parameters[i], v = 1 - u, at[2], slope[2], bend[2], along = 0, across = 0;
        cubic_at(c, from, u, at);
        for (int k = 0; k < 2; k++) {
            double a = c->controls[0][k] - from[k], b = c->controls[1][k] - c->controls[0][k],
                   d = c->end[k] - c->controls[1][k];
            slope[k] = 3 * (v * v * a + 2 * u * v * b + u * u * d);
            bend[k] = 6 * (v * (b - a) + u * (d - b));
            double off = at[k] - r->points[i][k];
            along += off * slope[k];
            across += slope[k] * slope[k] + off * bend[k];
        }
        if (across > 0)
            parameters[i] = fmin(fmax(u - along / across, parameters[i - 1]), 1);
    }
}

/* What the unknowns are: along a direction from an end, or x and y of a control point. */
typedef struct unknowns {
    int    count, control[4];
    double way[4][2];
} unknowns;

static void add_unknowns(unknowns *u, int control, const double *direction, double sign)
{
    static const double axes[2][2] = {{1, 0}, {0, 1}};
    for (int k = 0; k < (direction ? 1 : 2); k++, u->count++) {
        u->control[u->count] = control;
        for (int n = 0; n < 2; n++)
            u->way[u->count][n] = direction ? sign * direction[n] : axes[k][n];
    }
}

/* Where the control points lie best for these parameters. */
static bool find_controls(sheet_piece *out, const fit_run *r, const unknowns *q, const double *parameters)
{
    const double *from = r->points[0], *end = r->points[r->count - 1];
    double        rows[4 * 5], found[4];
    int           width = q->count + 1;
    memset(rows, 0, sizeof rows);
    for (size_t i = 1; i + 1 < r->count; i++) {
        double u = parameters[i], v = 1 - u, first = 3 * u * v * v, second = 3 * u * u * v, share[2] = {first, second},
               weight = parameters[i + 1] - parameters[i - 1];
        for (int k = 0; k < q->count; k++) {
            const double *way = q->way[k];
            double        own = weight * share[q->control[k]];
            for (int j = 0; j < q->count; j++)
                rows[k * width + j] += own * share[q->control[j]] * (way[0] * q->way[j][0] + way[1] * q->way[j][1]);
            for (int n = 0; n < 2; n++)
                rows[k * width + q->count] +=
                    own * way[n] * (r->points[i][n] - from[n] * (v * v * v + first) - end[n] * (second + u * u * u));
        }
    }
    if (!solve(rows, q->count, found))
        return false;
    *out =
        (sheet_piece){.kind = SHEET_CUBIC, .end = {end[0], end[1]}, .controls = {{from[0], from[1]}, {end[0], end[1]}}};
    for (int k = 0; k < q->count; k++)
        for (int n = 0; n < 2; n++)
            out->controls[q->control[k]][n] += found[k] * q->way[k][n];
    return true;
}

double fit_length(const sheet_piece *piece, const double from[2])
{
    enum { STEPS = 64 };
    double sum = 0, before[2] = {from[0], from[1]}, at[2];
    if (piece->kind == SHEET_LINE)
        return fit_distance(piece->end[0] - from[0], piece->end[1] - from[1]);
    if (piece->kind == SHEET_ARC && piece->radii[0] == piece->radii[1])
        return piece->radii[0] * fabs(piece->sweep);
    for (int i = 1; i <= STEPS; i++, memcpy(before, at, sizeof before)) {
        if (piece->kind == SHEET_ARC)
            ellipse_at(piece, from, (double)i / STEPS, at);
        else
            cubic_at(piece, from, (double)i / STEPS, at);
        sum += fit_distance(at[0] - before[0], at[1] - before[1]);
    }
    return sum;
}

/* Are points so far from where their parameters are that no better ones will help? */
static bool is_hopeless(const sheet_piece *c, const fit_run *r, const double *parameters)
{
    double most = HOPELESS * r->most, at[2];
    for (size_t i = 1; i + 1 < r->count; i++) {
        cubic_at(c, r->points[0], parameters[i], at);
        if (fabs(at[0] - r->points[i][0]) > most || fabs(at[1] - r->points[i][1]) > most)
            return true;
    }
    return false;
}

/* Handles that point backwards, or are longer than what they bend, make loops. */
static bool is_sound(const sheet_piece *c, const double from[2], double length)
{
    for (int k = 0; k < 2; k++) {
        const double *end = k ? c->end : from, *handle = c->controls[k];
        if (!(fit_distance(handle[0] - end[0], handle[1] - end[1]) < 1.5 * length))
            return false;
    }
    return true;
}

bool fit_cubic(sheet_piece *out, const fit_run *r, const double *begin, const double *end, double *parameters)
{
    enum { ROUNDS = 4 };
    unknowns q = {.count = 0};
    double   length = r->arcs[r->count - 1] - r->arcs[0];
    add_unknowns(&q, 0, begin, 1);
    add_unknowns(&q, 1, end, -1);
    if (r->count < 5 || !(length > 0))
        return false;
    for (size_t i = 0; i < r->count; i++)
        parameters[i] = (r->arcs[i] - r->arcs[0]) / length;
    for (int round = 0; round < ROUNDS; round++) {
        if (!find_controls(out, r, &q, parameters) || !is_sound(out, r->points[0], length) ||
            is_hopeless(out, r, parameters))
            return false;
        double there[2];
        bool   forward =
            (!begin ||
             (fit_direction(out, r->points[0], false, there) && there[0] * begin[0] + there[1] * begin[1] > 0)) &&
            (!end || (fit_direction(out, r->points[0], true, there) && there[0] * end[0] + there[1] * end[1] > 0));
        if (forward && fit_follows(out, cubic_at, looks_at_cubic(out, r->points[0], r->most), r))
            return true;
        come_nearer(out, r, parameters);
    }
    return false;
}
