/* Groups of strokes, as a hand hatches: patch by patch. Patches are the cells around points strewn through space, one
 * in each cube of a grid (Worley 1996), measured along the lines by another length than across: so neighbouring lines
 * are cut at nearly the same places, and groups belong to the surface. */
#include <math.h>

#include "base/random.h"
#include "marks/streamlines.h"

enum { AROUND_MOST = 3 };

static const double BROAD = 2.5; /* groups over which hatching gets closer or opener */

static random_source cell_random(const long cell[3], uint32_t seed)
{
    uint32_t h = (uint32_t)cell[0] * 73856093u ^ (uint32_t)cell[1] * 19349663u ^ (uint32_t)cell[2] * 83492791u ^
                 seed * 2654435761u;
    return random_start(h, 0x6A0);
}

/* Random numbers at the corners of cubes with side 1, 0 … 1, smoothly in between. */
static double smooth_noise(d3 at, uint32_t seed)
{
    const double where[3] = {at.x, at.y, at.z};
    double       parts[3], sum = 0;
    long         low[3];
    for (int k = 0; k < 3; k++) {
        double t = where[k] - floor(where[k]);
        low[k] = lrint(floor(where[k]));
        parts[k] = t * t * (3 - 2 * t);
    }
    for (int corner = 0; corner < 8; corner++) {
        const long    cell[3] = {low[0] + (corner & 1), low[1] + (corner >> 1 & 1), low[2] + (corner >> 2)};
        random_source r = cell_random(cell, seed + 1000003);
        double        weight = 1;
        for (int k = 0; k < 3; k++)
            weight *= (corner >> k & 1) ? parts[k] : 1 - parts[k];
        sum += weight * random_unit(&r);
    }
    return sum;
}

void flow_group_find(flow_group *out, d3 at, d3 direction, double length, double breadth, uint32_t seed)
{
    d3     middle = at;
    double side = cbrt(length * breadth * breadth), best = INFINITY;
    int    around = (int)fmin(ceil(1.2 * fmax(length, breadth) / side), AROUND_MOST);
    long   own[3] = {lrint(floor(at.x / side)), lrint(floor(at.y / side)), lrint(floor(at.z / side))};
    for (long x = own[0] - around; x <= own[0] + around; x++)
        for (long y = own[1] - around; y <= own[1] + around; y++)
            for (long z = own[2] - around; z <= own[2] + around; z++) {
                const long    cell[3] = {x, y, z};
                random_source r = cell_random(cell, seed);
                d3            to = {((double)x + random_unit(&r)) * side - at.x, 0, 0};
                to.y = ((double)y + random_unit(&r)) * side - at.y;
                to.z = ((double)z + random_unit(&r)) * side - at.z;
                double along = dot(to, direction);
                double far =
                    along * along / (length * length) + fmax(dot(to, to) - along * along, 0) / (breadth * breadth);
                if (far >= best)
                    continue;
                best = far;
                out->number = random_bits(&r);
                out->tone = random_unit(&r);
                middle = (d3){at.x + to.x, at.y + to.y, at.z + to.z};
                out->tilt = random_signed(&r);
                /* A hand draws towards itself, mostly. */
                out->toward = (d3){-0.35 + 0.5 * random_signed(&r), -1 + 0.5 * random_signed(&r), 0};
                out->toward.z = 0.25 + 0.5 * random_signed(&r);
            }
    /* Hatching is closer here and opener there, over some groups; and a little from group to group. */
    double broad = BROAD * fmax(length, breadth);
    d3     scaled = {middle.x / broad, middle.y / broad, middle.z / broad};
    double tone = 0.5 + 0.9 * (smooth_noise(scaled, seed) - 0.5) + 0.4 * (out->tone - 0.5);
    out->tone = fmin(fmax(tone, 0), 1);
}
