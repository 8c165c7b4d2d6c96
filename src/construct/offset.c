/* Offsets of regions. Each edge moves out along its normal; a corner that opens is joined by a mitre, a chamfer or
 * an arc, one that closes goes through the corner itself, so that the loop there runs the other way round and is
 * dropped. */
#include <math.h>

#include "base/memory.h"
#include "construct/construct_private.h"

typedef struct offsetting {
    double         distance;
    bool           rounded, chamfer;
    double         step; /* radians of an arc between two points */
    region_builder b;
} offsetting;

static double grid_nearest(double value)
{
    return round(value / GRID) * GRID;
}

static void put_point(offsetting *o, point2 at, double x, double y)
{
    builder_set_position(&o->b, grid_nearest(at.x + o->distance * x), grid_nearest(at.y + o->distance * y));
}

/* Unit and to the right of the edge: outwards. */
static point2 normal_of(point2 a, point2 b)
{
    double x = b.x - a.x, y = b.y - a.y, length = hypot(x, y);
    return (point2){y / length, -x / length};
}

/* Whole steps from the first normal on, as OpenSCAD has them: the last one may be shorter or longer. */
static void join_arc(offsetting *o, point2 at, point2 n, point2 m, double angle)
{
    double step = copysign(o->step, angle), count = fmax(round(fabs(angle) / o->step), 1);
    for (int i = 0; i < (int)count; i++) {
        double c = cos(step * i), s = sin(step * i);
        put_point(o, at, n.x * c - n.y * s, n.x * s + n.y * c);
    }
    put_point(o, at, m.x, m.y);
}

/* Cut where it is as far out as the edges are. */
static void join_chamfer(offsetting *o, point2 at, point2 n, point2 m, double angle)
{
    double t = tan(angle / 4);
    put_point(o, at, n.x - n.y * t, n.y + n.x * t);
    put_point(o, at, m.x + m.y * t, m.y - m.x * t);
}

/* The corner between an edge with normal n and one with normal m. */
static void join(offsetting *o, point2 at, point2 n, point2 m)
{
    double sine = n.x * m.y - n.y * m.x, cosine = n.x * m.x + n.y * m.y;
    sine = fmax(-1, fmin(1, sine));
    /* So straight that both ends are at the same position of the grid. */
    if (fabs(sine * o->distance) < GRID && cosine > 0) {
        put_point(o, at, n.x, n.y);
        return;
    }
    double angle = atan2(sine, cosine);
    if (sine * o->distance < 0) {
        put_point(o, at, n.x, n.y);
        put_point(o, at, 0, 0);
        put_point(o, at, m.x, m.y);
    } else if (o->rounded) {
        join_arc(o, at, n, m, angle);
    } else if (o->chamfer ||
               1 + cosine < 2e-12) { /* a mitre that would run out a million times as far is cut as well */
        join_chamfer(o, at, n, m, angle);
    } else {
        put_point(o, at, (n.x + m.x) / (1 + cosine), (n.y + m.y) / (1 + cosine));
    }
}

/* The contour's points on the grid, without those repeated in a row; `points` has room for all. */
static size_t grid_points(const contour *c, point2 *points)
{
    size_t count = 0;
    for (size_t i = 0; i < c->count; i++) {
        point2 p = {grid_position(c->points[i].x), grid_position(c->points[i].y)};
        if (count == 0 || p.x != points[count - 1].x || p.y != points[count - 1].y)
            points[count++] = p;
    }
    while (count > 1 && points[0].x == points[count - 1].x && points[0].y == points[count - 1].y)
        count--;
    return count;
}

static void offset_contour(offsetting *o, const contour *c)
{
    point2 *points = mem_calloc(c->count, sizeof *points);
    if (!points) {
        o->b.failed = true;
        return;
    }
    size_t count = grid_points(c, points);
    if (count >= 3) {
        builder_contour(&o->b);
        for (size_t i = 0; i < count; i++) {
            point2 before = points[i > 0 ? i - 1 : count - 1], after = points[i + 1 < count ? i + 1 : 0];
            join(o, points[i], normal_of(before, points[i]), normal_of(points[i], after));
        }
        builder_end_contour(&o->b);
    }
    mem_free(points);
}

/* Radians between two points of an arc; never more than that of a sagitta of a quarter of the radius, nor finer
 * than the grid. */
static double arc_step(double distance, int facets)
{
    double step = fmin(2 * PI / facets, 2 * acos(0.75));
    return fmax(step, 2 * GRID / distance);
}

lmn_status region_offset(region *out, const region *r, double distance, bool rounded, bool chamfer, facets f,
                         lmn_error *error)
{
    *out = (region){0};
    int        facets = facets_of_circle(fabs(distance), f);
    lmn_status status = check_numbers("offset", &distance, 1, error);
    if (status == LMN_OK)
        status = check_region("offset", r, error);
    /* An arc at each corner, none more than half a circle. */
    if (status == LMN_OK && rounded)
        status = check_point_count("offset", (double)region_point_count(r) * (facets / 2.0 + 3), error);
    if (status != LMN_OK)
        return status;
    if (fabs(distance) < GRID)
        return region_copy(out, r, error);
    offsetting o = {distance, rounded, chamfer, arc_step(fabs(distance), facets), {0}};
    for (size_t i = 0; i < r->count; i++)
        offset_contour(&o, &r->contours[i]);
    region moved;
    status = region_builder_finish(&o.b, &moved, error);
    if (status == LMN_OK)
        status = region_cover(out, &moved, 1, COVER_POSITIVE, error);
    region_release(&moved);
    return status;
}
