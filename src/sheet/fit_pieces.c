/* One piece through a run of points: straight lines and arcs of circles, whose distance from the lines between the
 * points is known in closed form, and what all kinds share. */
#include <math.h>

#include "sheet/fit_private.h"

#define PI 3.14159265358979323846

static double cross(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[2], const double b[2])
{
    return a[0] * b[0] + a[1] * b[1];
}

static double length_between(const double a[2], const double b[2])
{
    return fit_distance(b[0] - a[0], b[1] - a[1]);
}

/* How far a position is from a straight piece. */
static double distance_from(const double p[2], const double a[2], const double b[2])
{
    double way[2] = {b[0] - a[0], b[1] - a[1]}, to[2] = {p[0] - a[0], p[1] - a[1]}, square = dot(way, way);
    double at = square > 0 ? fmin(fmax(dot(to, way) / square, 0), 1) : 0;
    return fit_distance(to[0] - at * way[0], to[1] - at * way[1]);
}

/* Half the way to both neighbours. */
static double weight_of(const fit_run *r, size_t i)
{
    return 0.5 * (r->arcs[i + 1] - r->arcs[i - 1]);
}

bool fit_line(sheet_piece *out, const fit_run *r, double *square)
{
    const double *a = r->points[0], *b = r->points[r->count - 1];
    double        sum = 0;
    for (size_t i = 1; i + 1 < r->count; i++) {
        double off = distance_from(r->points[i], a, b);
        if (off > r->most)
            return false;
        sum += off * off * weight_of(r, i);
    }
    if (square)
        *square = sum;
    *out = (sheet_piece){.kind = SHEET_LINE, .end = {b[0], b[1]}};
    return true;
}

/* --- circles -------------------------------------------------------------------------------------------- */

/* Are all points seen from the centre between the first one and what is `sweep` farther on? None may go back by more
 * than `slack`, radians. */
static bool keeps_to_sweep(const fit_run *r, const double centre[2], double radius, double sweep, double slack)
{
    double direction = sweep > 0 ? 1 : -1, turned = 0, whole = fabs(sweep) + 1e-6, back = -slack * radius * radius,
           first[2] = {r->points[0][0] - centre[0], r->points[0][1] - centre[1]}, a[2] = {first[0], first[1]},
           last[2] = {r->points[r->count - 1][0] - centre[0], r->points[r->count - 1][1] - centre[1]},
           least = -1e-6 * radius * radius;
    bool narrow = whole < 3; /* then signs of areas say it all */
    for (size_t i = 1; i < r->count; i++) {
        double b[2] = {r->points[i][0] - centre[0], r->points[i][1] - centre[1]}, step = direction * cross(a, b);
        if (step < back || (narrow && (direction * cross(first, b) < least || direction * cross(b, last) < least)))
            return false;
        if (!narrow) {
            turned += direction * atan2(cross(a, b), dot(a, b));
            if (turned < -1e-6 || turned > whole)
                return false;
        }
        a[0] = b[0];
        a[1] = b[1];
    }
    return narrow || turned > whole - 2e-6;
}

/* Do lines between points keep to a ring around a circle, from the angle of the first one on by `sweep` and not beyond,
 * without turning back far? Then each point of one has one of the other at its own angle, no farther off. `sum` gets
 * the squares of what points are off. */
static bool keeps_to_ring(const fit_run *r, const double centre[2], double radius, double sweep, double *sum)
{
    double inner = radius - r->most;
    *sum = 0;
    for (size_t i = 0; i < r->count; i++) {
        double b[2] = {r->points[i][0] - centre[0], r->points[i][1] - centre[1]},
               off = fit_distance(b[0], b[1]) - radius;
        if (fabs(off) > r->most)
            return false;
        if (i > 0) { /* a chord is nearest to the centre in its middle, or nearly so */
            const double *p = r->points[i - 1];
            double        a[2] = {p[0] - centre[0], p[1] - centre[1]}, way[2] = {b[0] - a[0], b[1] - a[1]},
                   square = dot(way, way), along = -dot(a, way), side = cross(a, way);
            if (inner > 0 && along > 0 && along < square && side * side < inner * inner * square)
                return false;
            if (i + 1 < r->count)
                *sum += off * off * weight_of(r, i);
        }
    }
    return keeps_to_sweep(r, centre, radius, sweep, r->most / radius);
}

/* Seen from a point of an arc, its chord is the same angle everywhere: the turn there from one end to the other is half
 * of what the whole arc turns. So each point has its own opinion, which counts by how far it would move. */
static double half_sweep(const fit_run *r)
{
    const double *a = r->points[0], *b = r->points[r->count - 1];
    double        x = 0, y = 0;
    for (size_t i = 1; i + 1 < r->count; i++) {
        const double *p = r->points[i];
        double        in[2] = {p[0] - a[0], p[1] - a[1]}, on[2] = {b[0] - p[0], b[1] - p[1]};
        double        weight = sqrt(dot(in, in) * dot(on, on)) * weight_of(r, i);
        x += weight * dot(in, on);
        y += weight * cross(in, on);
    }
    return x != 0 || y != 0 ? atan2(y, x) : 0;
}

bool fit_arc(sheet_piece *out, const fit_run *r, double *square)
{
    const double *a = r->points[0], *b = r->points[r->count - 1];
    double        chord = length_between(a, b), half = half_sweep(r), sum;
    if (r->count < 3 || !(fabs(half) > 1e-7) || !(fabs(half) < 0.98 * PI) || !(chord > r->most))
        return false;
    double signed_radius = chord / (2 * sin(half)), radius = fabs(signed_radius),
           apart = signed_radius * cos(half) / chord; /* of the centre from the chord, to its left */
    double centre[2] = {0.5 * (a[0] + b[0]) - apart * (b[1] - a[1]), 0.5 * (a[1] + b[1]) + apart * (b[0] - a[0])};
    if (radius > 1e5 || !keeps_to_ring(r, centre, radius, 2 * half, &sum))
        return false;
    if (square)
        *square = sum;
    *out = (sheet_piece){.kind = SHEET_ARC,
                         .end = {b[0], b[1]},
                         .centre = {centre[0], centre[1]},
                         .radii = {radius, radius},
                         .from = atan2(a[1] - centre[1], a[0] - centre[0]),
                         .sweep = 2 * half};
    return true;
}

bool fit_circle(sheet_piece *out, const fit_run *r)
{
    /* Least squares of x² + y² = 2 c · p + k, around the mean. */
    double mean[2] = {0, 0}, xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, z = 0, area = 0;
    size_t count = r->count - 1;
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++)
            mean[k] += r->points[i][k] / (double)count;
    for (size_t i = 0; i < count; i++) {
        double x = r->points[i][0] - mean[0], y = r->points[i][1] - mean[1], s = x * x + y * y;
        xx += x * x, xy += x * y, yy += y * y, xz += x * s, yz += y * s, z += s;
        area += cross(r->points[i], r->points[i + 1]);
    }
    double whole = xx * yy - xy * xy, sum;
    if (count < 5 || !(whole > 1e-9 * xx * yy))
        return false;
    double x = 0.5 * (xz * yy - yz * xy) / whole, y = 0.5 * (yz * xx - xz * xy) / whole;
    double radius = sqrt(z / (double)count + x * x + y * y), centre[2] = {mean[0] + x, mean[1] + y},
           direction = area > 0 ? 1 : -1;
    /* It begins at the first point, which is put on it. */
    double away[2] = {r->points[0][0] - centre[0], r->points[0][1] - centre[1]},
           off = fit_distance(away[0], away[1]) - radius;
    fit_run nearer = *r;
    nearer.most -= fabs(off);
    for (int k = 0; k < 2; k++)
        centre[k] += away[k] / (radius + off) * off;
    if (!(nearer.most > 0) || !keeps_to_ring(&nearer, centre, radius, direction * 2 * PI, &sum))
        return false;
    *out = (sheet_piece){.kind = SHEET_ARC,
                         .end = {r->points[0][0], r->points[0][1]},
                         .centre = {centre[0], centre[1]},
                         .radii = {radius, radius},
                         .from = atan2(away[1], away[0]),
                         .sweep = direction * 2 * PI};
    return true;
}

/* --- all kinds ------------------------------------------------------------------------------------------ */

void sheet_arc_at(const sheet_piece *arc, double angle, double out[2])
{
    double x = arc->radii[0] * cos(angle), y = arc->radii[1] * sin(angle), c = cos(arc->turn), s = sin(arc->turn);
    out[0] = arc->centre[0] + c * x - s * y;
    out[1] = arc->centre[1] + s * x + c * y;
}

bool fit_direction(const sheet_piece *piece, const double from[2], bool at_end, double out[2])
{
    double way[2] = {piece->end[0] - from[0], piece->end[1] - from[1]};
    if (piece->kind == SHEET_ARC) {
        double angle = piece->from + (at_end ? piece->sweep : 0), c = cos(piece->turn), s = sin(piece->turn);
        double sign = piece->sweep > 0 ? 1 : -1, x = -piece->radii[0] * sin(angle) * sign,
               y = piece->radii[1] * cos(angle) * sign;
        way[0] = c * x - s * y;
        way[1] = s * x + c * y;
    } else if (piece->kind == SHEET_CUBIC) {
        for (int k = 0; k < 2; k++)
            way[k] = at_end ? piece->end[k] - piece->controls[1][k] : piece->controls[0][k] - from[k];
    }
    double length = fit_distance(way[0], way[1]);
    if (!(length > 1e-9))
        return false;
    out[0] = way[0] / length;
    out[1] = way[1] / length;
    return true;
}

/* How far a position is from the lines, near the one that was nearest to the position before. */
static double walk(const double (*lines)[2], size_t count, size_t *at, const double p[2])
{
    double best = distance_from(p, lines[*at], lines[*at + 1]);
    for (size_t next = *at + 1, waited = 0; next + 1 < count && waited < 3; next++) {
        double own = distance_from(p, lines[next], lines[next + 1]);
        waited = own <= best ? 0 : waited + 1;
        if (own <= best) {
            best = own;
            *at = next;
        }
    }
    return best;
}

enum { LOOKED_AT_MOST = 512 };

bool fit_follows(const sheet_piece *piece, fit_curve_fn at, int pieces, const fit_run *r)
{
    double curve[LOOKED_AT_MOST + 1][2], most = 0.95 * r->most;
    size_t nearest = 0;
    if (pieces > LOOKED_AT_MOST)
        return false;
    for (int i = 0; i <= pieces; i++) {
        at(piece, r->points[0], (double)i / pieces, curve[i]);
        if (walk(r->points, r->count, &nearest, curve[i]) > most)
            return false;
    }
    nearest = 0;
    for (size_t i = 0; i + 1 < r->count; i++) {
        const double *a = r->points[i], *b = r->points[i + 1];
        int           looks = length_between(a, b) > 4 * most ? 4 : 1;
        for (int k = 0; k < looks; k++) {
            double part = (double)k / looks, p[2] = {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])};
            if (walk((const double(*)[2])curve, (size_t)pieces + 1, &nearest, p) > most)
                return false;
        }
    }
    return true;
}
