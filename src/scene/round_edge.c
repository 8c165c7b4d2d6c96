/* One edge of a coarse mesh as a curve: a cubic through its ends with the tangents that the surface has there. */
#include <math.h>

#include "scene/round.h"

static round_point add(round_point a, round_point b)
{
    return (round_point){a.x + b.x, a.y + b.y, a.z + b.z};
}

static round_point scaled(round_point a, double by)
{
    return (round_point){a.x * by, a.y * by, a.z * by};
}

static round_point from_to(round_point a, round_point b)
{
    return (round_point){b.x - a.x, b.y - a.y, b.z - a.z};
}

static double dot(round_point a, round_point b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double length(round_point a)
{
    return sqrt(dot(a, a));
}

static round_point unit_or(round_point a, round_point otherwise)
{
    double l = length(a);
    return l > 0 ? scaled(a, 1 / l) : otherwise;
}

static round_point cross(round_point a, round_point b)
{
    return (round_point){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static round_point mixed(round_point a, round_point b, double share)
{
    return add(scaled(a, 1 - share), scaled(b, share));
}

static double smooth_step(double from, double to, double at)
{
    double t = (at - from) / (to - from);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return t * t * (3 - 2 * t);
}

/* Normals far from the face's own were not made for a surface that bends: boxes that are shaded smooth would become
 * balls. Between 40 and 52 degrees the surface turns flat. */
static double trust_of(round_point normal, round_point face)
{
    return smooth_step(0.616, 0.766, dot(normal, face));
}

/* Nor were those of a wide face beside a narrow bevel, at which they lean all the same. */
static double reach_of(const round_side *side, int end)
{
    return smooth_step(0.2, 0.45, fmin(side->beyond[end], 1));
}

/* The edge as it leaves an end: in the surface there, or along the crease if its two sides have normals of their own.
 */
static round_point tangent_at(int end, round_point edge, const round_side *one, const round_side *other)
{
    /* Sines of the angle between two normals: below the first they are one, above the second there is a crease. */
    const double SAME = 0.05, CREASE = 0.2;
    round_point  n = one->normals[end];
    double       trust = fmin(trust_of(n, one->face), reach_of(one, end));
    if (other) {
        trust = fmin(trust, fmin(trust_of(other->normals[end], other->face), reach_of(other, end)));
        n = unit_or(add(n, other->normals[end]), n);
    }
    round_point tangent = add(edge, scaled(n, -dot(edge, n)));
    round_point line = other ? cross(one->normals[end], other->normals[end]) : (round_point){0, 0, 0};
    double      turn = length(line), sharp = smooth_step(SAME, CREASE, turn);
    if (sharp > 0) {
        line = scaled(line, 1 / turn);
        tangent = mixed(tangent, scaled(line, dot(edge, line)), sharp);
    }
    /* An edge that would leave nearly across itself is not what the normals were made for. */
    double straight = dot(edge, edge) > 0 ? dot(tangent, edge) / dot(edge, edge) : 0;
    trust *= smooth_step(0.3, 0.55, straight);
    return mixed(edge, tangent, trust);
}

round_edge round_edge_of(const round_point ends[2], const round_side *one, const round_side *other)
{
    round_point edge = from_to(ends[0], ends[1]);
    round_point begin = tangent_at(0, edge, one, other), end = tangent_at(1, edge, one, other);
    round_point bend = scaled(from_to(end, begin), 1.0 / 8);
    double      off = fmax(length(from_to(edge, begin)), length(from_to(edge, end)));
    return (round_edge){.middle = add(scaled(add(ends[0], ends[1]), 0.5), bend),
                        .distance = off / 4}; /* of an arc of a circle: its height */
}
