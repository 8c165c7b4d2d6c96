/* Polygons as marks: shapes between a source and a target (EX-15), and triangles that are cut once and shrink as if
 * they had not been (EX-16). Freudenberg 2003, sections 5.1.8 and 5.3.3; what is printed there as length M1 Mp is
 * M2 Mp, the angle is that of atan2, and a corner that goes is replaced by two points where both its neighbours
 * stay. */
#include "marks/marks.h"

#include <math.h>
#include <string.h>

void mark_corner_at(const mark_corner *corners, size_t count, double tone, double (*out)[2])
{
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++)
            out[i][k] = (1 - tone) * corners[i].source[k] + tone * corners[i].target[k];
}

static double cross_of(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static double distance(const double a[2], const double b[2])
{
    return hypot(b[0] - a[0], b[1] - a[1]);
}

/* Angle between two directions from a corner, without a sign. */
static double angle_at(const double corner[2], const double a[2], const double b[2])
{
    double along = (a[0] - corner[0]) * (b[0] - corner[0]) + (a[1] - corner[1]) * (b[1] - corner[1]);
    return atan2(fabs(cross_of(corner, a, b)), along);
}

/* Keeps what lies on the left of the line from a to b. */
static int keep_left(double (*corners)[2], int count, const double a[2], const double b[2])
{
    double kept[2 * MARK_POLYGON_MAX][2];
    int    n = 0;
    for (int i = 0; i < count; i++) {
        const double *p = corners[i], *q = corners[(i + 1) % count];
        double        from = cross_of(a, b, p), to = cross_of(a, b, q);
        if (from >= 0) {
            memcpy(kept[n++], p, sizeof kept[0]);
        }
        if ((from > 0 && to < 0) || (from < 0 && to > 0)) {
            double t = from / (from - to);
            kept[n][0] = p[0] + t * (q[0] - p[0]);
            kept[n++][1] = p[1] + t * (q[1] - p[1]);
        }
    }
    memcpy(corners, kept, (size_t)n * sizeof kept[0]);
    return n;
}

void mark_cut_make(mark_cut *out, const double mark[3][2], const double onto[3][2])
{
    memset(out, 0, sizeof *out);
    memcpy(out->first, mark[0], sizeof out->first);
    out->side = distance(mark[0], mark[1]);
    out->base = distance(mark[1], mark[2]);
    out->angle = angle_at(mark[1], mark[0], mark[2]);
    double corners[2 * MARK_POLYGON_MAX][2];
    memcpy(corners, mark, 3 * sizeof corners[0]);
    int  count = 3;
    bool left = cross_of(onto[0], onto[1], onto[2]) >= 0;
    for (int i = 0; i < 3 && count > 0; i++) {
        const double *a = onto[i], *b = onto[(i + 1) % 3];
        count = left ? keep_left(corners, count, a, b) : keep_left(corners, count, b, a);
    }
    out->count = count <= MARK_POLYGON_MAX ? count : MARK_POLYGON_MAX;
    for (int i = 0; i < out->count; i++) {
        memcpy(out->corners[i], corners[i], sizeof corners[i]);
        out->turns[i] = angle_at(mark[0], mark[1], corners[i]);
    }
}

/* Where the edge from a corner that stays to one that goes meets the ray from M1 at an angle `turn`: by the sine
 * rule, in the triangle of M1, the corner that goes and the meeting position. */
static void meet(const mark_cut *c, int goes, int stays, double turn, double out[2])
{
    const double *from = c->corners[goes], *to = c->corners[stays];
    double        l = distance(c->first, from), more = c->turns[goes] - turn;
    double        at_corner = l > 0 ? angle_at(from, c->first, to) : 0;
    double        along = sin(at_corner + more), edge = distance(from, to);
    /* Length along the edge, from the corner that goes. */
    double fraction = along > 1e-300 && edge > 0 ? fmin(l * sin(more) / along / edge, 1) : 0;
    for (int k = 0; k < 2; k++)
        out[k] = from[k] + fraction * (to[k] - from[k]);
}

int mark_cut_at(const mark_cut *c, double p, double (*out)[2])
{
    double moved = p * c->base, turn = atan2(moved * sin(c->angle), c->side - moved * cos(c->angle));
    int    n = 0;
    for (int i = 0; i < c->count; i++) {
        int before = (i + c->count - 1) % c->count, after = (i + 1) % c->count;
        if (c->turns[i] <= turn) {
            memcpy(out[n++], c->corners[i], sizeof out[0]);
            continue;
        }
        if (c->turns[before] <= turn)
            meet(c, i, before, turn, out[n++]);
        if (c->turns[after] <= turn)
            meet(c, i, after, turn, out[n++]);
    }
    return n;
}
