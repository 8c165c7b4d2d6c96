/* The torn outline of a patch, and how triangles lie to it. */
#include "field/lapped_private.h"

/* Outlines are held a little smaller here than they are drawn, since a shader computes them with less precision. */
static const double spare = 0.02;

double lapped_outline(uint32_t patch, double angle)
{
    return 0.7 + 0.2 * sin(3 * angle + 2.4 * patch) + 0.1 * sin(7 * angle + 1.7 * patch);
}

/* Nothing here is so large or small that it would need the care, and the time, of hypot. */
static double length_of(double x, double y)
{
    return sqrt(x * x + y * y);
}

outline outline_of(uint32_t patch, double radius)
{
    return (outline){radius, {cos(2.4 * patch), sin(2.4 * patch)}, {cos(1.7 * patch), sin(1.7 * patch)}};
}

static flat_position turn(flat_position a, flat_position b)
{
    return (flat_position){a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
}

/* How far beyond the outline, in radii; negative inside. The same as by lapped_outline, with multiples of the angle
 * from powers: this is asked a hundred million times. */
static double beyond(const outline *o, flat_position p)
{
    double length = length_of(p.x, p.y);
    if (!(length > 0))
        return -0.4;
    flat_position once = {p.x / length, p.y / length}, cube = turn(turn(once, once), once);
    double        third = turn(cube, o->third).y, seventh = turn(turn(turn(cube, cube), once), o->seventh).y;
    return length / o->radius - (0.7 + 0.2 * third + 0.1 * seventh);
}

/* Away from the middle, `beyond` changes by no more than this for each radius travelled: the outline's slope is at
 * most 1.3, and its least distance 0.4. */
static const double steepest = 3.4;
static const double finest = 0.004; /* radii; shorter pieces are not divided further */

static bool segment_inside(const outline *o, flat_position a, flat_position b)
{
    flat_position middle = {(a.x + b.x) / 2, (a.y + b.y) / 2};
    double half = length_of(b.x - a.x, b.y - a.y) / 2 / o->radius, from = length_of(middle.x, middle.y) / o->radius;
    if (from + half < 0.4 - spare)
        return true;
    if (from > 1)
        return false;
    double out = beyond(o, middle);
    if (from - half > 0.35 && out <= -steepest * half - spare)
        return true;
    if (out > -spare || half < finest)
        return false;
    return segment_inside(o, a, middle) && segment_inside(o, middle, b);
}

static bool segment_touches(const outline *o, flat_position a, flat_position b)
{
    flat_position middle = {(a.x + b.x) / 2, (a.y + b.y) / 2};
    double half = length_of(b.x - a.x, b.y - a.y) / 2 / o->radius, from = length_of(middle.x, middle.y) / o->radius;
    if (from - half > 1 + spare)
        return false;
    double out = beyond(o, middle);
    if (out <= spare || half < 4 * finest)
        return out <= spare + steepest * half;
    if ((from - half > 0.35 && out > steepest * half + spare))
        return false;
    return segment_touches(o, a, middle) || segment_touches(o, middle, b);
}

/* What lies outside an outline hangs together and has no end, so that a triangle whose border is inside has no part
 * of it. */
bool outline_holds(const outline *o, const flat_position corners[3])
{
    return segment_inside(o, corners[0], corners[1]) && segment_inside(o, corners[1], corners[2]) &&
           segment_inside(o, corners[2], corners[0]);
}

bool outline_touches(const outline *o, const flat_position c[3])
{
    double a = c[0].x * c[1].y - c[0].y * c[1].x, b = c[1].x * c[2].y - c[1].y * c[2].x,
           d = c[2].x * c[0].y - c[2].y * c[0].x;
    if ((a >= 0 && b >= 0 && d >= 0) || (a <= 0 && b <= 0 && d <= 0))
        return true;
    return segment_touches(o, c[0], c[1]) || segment_touches(o, c[1], c[2]) || segment_touches(o, c[2], c[0]);
}
