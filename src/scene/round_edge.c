/* One edge of a coarse mesh as a curve: a cubic through its ends with the tangents that the surface has there. */
#include <math.h>

#include "base/smooth_step.h"
#include "base/vector3.h"
#include "scene/round.h"

/* Normals far from the face's own were not made for a surface that bends: boxes that are shaded smooth would become
 * balls. Between 40 and 52 degrees the surface turns flat. */
static double trust_of(const round_side *side, int end)
{
    return smooth_step(0.616, 0.766, vector3_dot(side->normals[end], side->face));
}

/* Nor were those of a wide face beside a narrow bevel, at which they lean all the same. */
static double reach_of(const round_side *side, int end)
{
    return smooth_step(0.2, 0.45, fmin(side->beyond[end], 1));
}

/* The edge as it leaves an end: in the surface there, or along the crease if its two sides have normals of their own.
 */
static void tangent_at(double out[3], int end, const double edge[3], const round_side *one, const round_side *other)
{
    /* Sines of the angle between two normals: below the first they are one, above the second there is a crease. */
    const double SAME = 0.05, CREASE = 0.2;
    double       n[3], line[3] = {0, 0, 0}, trust = fmin(trust_of(one, end), reach_of(one, end));
    vector3_copy(n, one->normals[end]);
    if (other) {
        trust = fmin(trust, fmin(trust_of(other, end), reach_of(other, end)));
        vector3_cross(line, n, other->normals[end]);
        vector3_add(n, n, 1, other->normals[end]);
        if (!vector3_normalise(n))
            vector3_copy(n, one->normals[end]);
    }
    vector3_add(out, edge, -vector3_dot(edge, n), n);
    double sharp = smooth_step(SAME, CREASE, vector3_length(line)), square = vector3_dot(edge, edge);
    if (sharp > 0 && vector3_normalise(line)) {
        double along = vector3_dot(edge, line);
        vector3_set(line, along * line[0], along * line[1], along * line[2]);
        vector3_mix(out, out, line, sharp);
    }
    for (int k = 0; k < 2; k++) {
        const round_side *side = k ? other : one;
        if (side && side->plane)
            vector3_add(out, out, -vector3_dot(out, side->face), side->face);
    }
    /* An edge that would leave nearly across itself is not what the normals were made for. */
    trust *= smooth_step(0.3, 0.55, square > 0 ? vector3_dot(out, edge) / square : 0);
    vector3_mix(out, edge, out, trust);
}

round_edge round_edge_of(const double ends[2][3], const round_side *one, const round_side *other)
{
    double     edge[3], begin[3], end[3], bend[3];
    round_edge out;
    vector3_add(edge, ends[1], -1, ends[0]);
    tangent_at(begin, 0, edge, one, other);
    tangent_at(end, 1, edge, one, other);
    vector3_add(bend, begin, -1, end);
    vector3_mix(out.middle, ends[0], ends[1], 0.5);
    vector3_add(out.middle, out.middle, 1.0 / 8, bend);
    /* Of an arc of a circle: its height. */
    out.distance = fmax(vector3_distance(edge, begin), vector3_distance(edge, end)) / 4;
    return out;
}
