#include "pieces.h"

#include <math.h>
#include <stddef.h>

enum { ROUND_MAX = 64 };

void box(mesh *m, double left, double bottom, double back, double right, double top, double front)
{
    outline o = rectangle(left, bottom, right, top);
    extrude(m, &o, NULL, 0, back, front);
}

/* --- prisms --------------------------------------------------------------------------------------------- */

static outline reversed(const outline *o)
{
    outline r = {.count = o->count};
    for (int i = 0; i < o->count; i++)
        for (int k = 0; k < 3; k++)
            r.at[i][k] = o->at[o->count - 1 - i][k];
    return r;
}

static outline counter_clockwise(const outline *o)
{
    double area = 0;
    for (int i = 0; i < o->count; i++) {
        const double *a = o->at[i], *b = o->at[(i + 1) % o->count];
        area += a[0] * b[1] - a[1] * b[0];
    }
    return area < 0 ? reversed(o) : *o;
}

/* Sections and plans are told as (z, y) and (x, z), the frames want (y, z) and (z, x). */
static outline exchanged(const outline *o)
{
    outline e = {.count = o->count};
    for (int i = 0; i < o->count; i++) {
        e.at[i][0] = o->at[i][1];
        e.at[i][1] = o->at[i][0];
        e.at[i][2] = o->at[i][2];
    }
    return counter_clockwise(&e);
}

void elevation(mesh *m, const outline *o, const outline *holes, int hole_count, double from, double to)
{
    outline outer = counter_clockwise(o), inner[HOLES_MAX];
    for (int h = 0; h < hole_count; h++)
        inner[h] = counter_clockwise(&holes[h]);
    extrude(m, &outer, inner, hole_count, from, to);
}

void section(mesh *m, const outline *o, double from, double to)
{
    outline outer = exchanged(o);
    extrude_along(m, &(frame){.along = RIGHT}, &outer, NULL, 0, from, to);
}

void plan(mesh *m, const outline *o, const outline *holes, int hole_count, double from, double to)
{
    outline outer = exchanged(o), inner[HOLES_MAX];
    for (int h = 0; h < hole_count; h++)
        inner[h] = exchanged(&holes[h]);
    extrude_along(m, &(frame){.along = UP}, &outer, inner, hole_count, from, to);
}

void mitred_section(mesh *m, const outline *o, const double from[2], const double to[2])
{
    const frame f = {.along = RIGHT};
    outline     ends[2] = {exchanged(o), exchanged(o)};
    for (int i = 0; i < o->count; i++) {
        ends[0].at[i][2] = from[1] * ends[0].at[i][1];
        ends[1].at[i][2] = to[1] * ends[1].at[i][1];
    }
    ring low = put_ring(m, &f, &ends[0], from[0]), high = put_ring(m, &f, &ends[1], to[0]);
    sew(m, &low, &high);
    cap(m, LEFT, &low, NULL, 0);
    cap(m, RIGHT, &high, NULL, 0);
}

/* --- bars and foliage ----------------------------------------------------------------------------------- */

static void fan(mesh *m, const ring *r, bool back)
{
    for (int i = 2; i < r->count; i++)
        put_triangle(m, r->at[0], r->at[back ? i : i - 1], r->at[back ? i - 1 : i]);
}

/* Two directions across d that make a right-handed system with it. */
static void across(const double d[3], double p[3], double q[3])
{
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    double e[3] = {d[0] / length, d[1] / length, d[2] / length};
    int    least = fabs(e[1]) < 0.9 ? 1 : 0; /* the axis that p is upright to */
    double s[3] = {least == 0, least == 1, 0};
    p[0] = s[1] * e[2] - s[2] * e[1];
    p[1] = s[2] * e[0] - s[0] * e[2];
    p[2] = s[0] * e[1] - s[1] * e[0];
    double size = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (int k = 0; k < 3; k++)
        p[k] /= size;
    q[0] = e[1] * p[2] - e[2] * p[1];
    q[1] = e[2] * p[0] - e[0] * p[2];
    q[2] = e[0] * p[1] - e[1] * p[0];
}

void bar(mesh *m, const double from[3], const double to[3], double from_radius, double to_radius, int sides)
{
    const frame f = {.along = FRONT};
    double      d[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, p[3], q[3];
    ring        ends[2] = {{.count = sides}, {.count = sides}};
    across(d, p, q);
    for (int e = 0; e < 2; e++)
        for (int i = 0; i < sides; i++) {
            double angle = 2 * PI * (i + 0.5) / sides, radius = e ? to_radius : from_radius, at[3];
            for (int k = 0; k < 3; k++)
                at[k] = (e ? to : from)[k] + radius * (cos(angle) * p[k] + sin(angle) * q[k]);
            ends[e].at[i] = put_point(m, &f, at[0], at[1], at[2]);
        }
    sew(m, &ends[0], &ends[1]);
    fan(m, &ends[0], true);
    fan(m, &ends[1], false);
}

void hoop(mesh *m, const double middle[3], double radius, double thickness, int segments, int sides)
{
    double profile[ROUND_MAX][2];
    ring   first, last;
    for (int i = 0; i <= sides; i++) {
        double angle = 2 * PI * i / sides;
        profile[i][0] = thickness * sin(angle);
        profile[i][1] = radius + thickness * cos(angle);
    }
    lathe(m, &(frame){{middle[0], middle[1], middle[2]}, UP}, (const double(*)[2])profile, sides, segments, &first,
          &last);
    sew(m, &last, &first);
}

double chance(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

void foliage(mesh *m, const double middle[3], double radius, double height, uint32_t seed)
{
    enum { STACKS = 9, AROUND = 16 };
    const frame f = {.along = FRONT};
    double      turns[3];
    for (int k = 0; k < 3; k++)
        turns[k] = 2 * PI * chance(&seed);
    ring     before = {0};
    uint32_t tips[2];
    for (int e = 0; e < 2; e++)
        tips[e] = put_point(m, &f, middle[0], middle[1] + (e ? height : -height), middle[2]);
    for (int j = 1; j < STACKS; j++) {
        ring   here = {.count = AROUND};
        double up = -cos(PI * j / STACKS), out = sin(PI * j / STACKS);
        for (int i = 0; i < AROUND; i++) {
            double angle = 2 * PI * i / AROUND;
            double lump = 1 + 0.04 * out * (sin(2 * angle + turns[0] + 2 * up) + sin(3 * angle + turns[1] - 3 * up)) +
                          0.03 * sin(4 * up + turns[2]);
            here.at[i] = put_point(m, &f, middle[0] + radius * out * lump * sin(angle), middle[1] + height * up * lump,
                                   middle[2] + radius * out * lump * cos(angle));
        }
        for (int i = 0; i < AROUND && j == 1; i++)
            put_triangle(m, tips[0], here.at[(i + 1) % AROUND], here.at[i]);
        for (int i = 0; i < AROUND && j == STACKS - 1; i++)
            put_triangle(m, tips[1], here.at[i], here.at[(i + 1) % AROUND]);
        if (j > 1)
            sew(m, &before, &here);
        before = here;
    }
}

/* A limb and what grows from it. It bends upwards, the more the higher its order is. */
static void limb(mesh *m, const double from[3], const double direction[3], double length, double radius, int order,
                 uint32_t *seed)
{
    double to[3], p[3], q[3];
    for (int k = 0; k < 3; k++)
        to[k] = from[k] + length * direction[k];
    bar(m, from, to, radius, radius * (order ? 0.62 : 0.3), order > 1 ? 9 : order > 0 ? 6 : 4);
    if (order == 0)
        return;
    across(direction, p, q);
    int    twigs = order > 2 ? 5 : 3;
    double begin = 2 * PI * chance(seed);
    for (int i = 0; i < twigs; i++) {
        double angle = begin + 2.4 * i, spread = i == twigs - 1 ? 0.12 : 0.62 + 0.3 * chance(seed);
        double fraction = i == twigs - 1 ? 1 : 0.5 + 0.5 * i / (twigs - 1), next[3], start[3], size = 0;
        for (int k = 0; k < 3; k++) {
            next[k] = direction[k] * cos(spread) + (p[k] * cos(angle) + q[k] * sin(angle)) * sin(spread) +
                      (k == 1 ? 0.18 : 0);
            size += next[k] * next[k];
            start[k] = from[k] + (fraction - 0.02) * length * direction[k];
        }
        for (int k = 0; k < 3; k++)
            next[k] /= sqrt(size);
        limb(m, start, next, length * (0.62 + 0.16 * chance(seed)),
             radius * (i == twigs - 1 ? 0.61 : 0.72 - 0.29 * fraction), order - 1, seed);
    }
}

void tree(mesh *m, const double foot[3], double height, uint32_t seed)
{
    const double up[3] = {0.03, 1, 0.02};
    limb(m, foot, up, height * 0.4, height * 0.028, 3, &seed);
}

void position(mesh *m, uint32_t kept, double degrees, double x, double y, double z)
{
    double c = cos(degrees * PI / 180), s = sin(degrees * PI / 180);
    for (uint32_t i = kept; i < m->point_count; i++) {
        int32_t *at = m->points[i].at;
        double   u = at[0], v = at[2];
        at[0] = (int32_t)lround(c * u + s * v + x * GRID);
        at[1] = (int32_t)lround(at[1] + y * GRID);
        at[2] = (int32_t)lround(c * v - s * u + z * GRID);
    }
}

/* --- outlines ------------------------------------------------------------------------------------------- */

outline round_headed(double middle, double sill, double springing, double radius, int segments)
{
    outline o = {0};
    add_point(&o, middle - radius, sill);
    add_point(&o, middle + radius, sill);
    add_arc(&o, middle, springing, radius, 0, 180, segments);
    return o;
}

outline round_headed_frame(double middle, double sill, double springing, double radius, double width, int segments)
{
    outline o = {0};
    bool    jambs = sill < springing;
    if (jambs)
        add_point(&o, middle + radius + width, sill);
    add_arc(&o, middle, springing, radius + width, 0, 180, segments);
    if (jambs) {
        add_point(&o, middle - radius - width, sill);
        add_point(&o, middle - radius, sill);
    }
    add_arc(&o, middle, springing, radius, 180, 0, segments);
    if (jambs)
        add_point(&o, middle + radius, sill);
    return o;
}

outline smooth(const double (*points)[2], int count, int between)
{
    outline o = {0};
    for (int i = 0; i < count; i++)
        for (int j = 0; j < between; j++) {
            double t = (double)j / between, at[2];
            for (int k = 0; k < 2; k++) {
                double a = points[(i + count - 1) % count][k], b = points[i][k], c = points[(i + 1) % count][k],
                       d = points[(i + 2) % count][k];
                at[k] = b + t / 2 * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
            }
            add_point(&o, at[0], at[1]);
        }
    return o;
}
