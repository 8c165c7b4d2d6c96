/* How much room a bend leaves that lines go over: round an edge light changes within less than lines are apart, and
 * what lines would make of that are ticks across the edge, a comb. So whoever draws leaves such an edge bare. */
#include <math.h>

#include "marks/streamlines.h"

static const double WINDOW = 0.5; /* distances of the closest lines to either side over which a bend is measured */
static const double ROOM = 1.15;  /* of a bend's radius: a quarter of a turn is little longer */

typedef struct bend_end {
    d3     at, normal;
    double arc;
} bend_end;

/* The line at an arc, between its points. */
static bend_end line_at(const flow_point *p, uint32_t count, double arc)
{
    uint32_t low = 0, high = count - 1;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        *((double)p[middle].arc <= arc ? &low : &high) = middle;
    }
    double   length = (double)p[high].arc - (double)p[low].arc;
    double   part = length > 0 ? fmin(fmax((arc - (double)p[low].arc) / length, 0), 1) : 0;
    bend_end e = {.at = d3_along(of(p[low].at), minus(of(p[high].at), of(p[low].at)), part),
                  .normal = d3_along(of(p[low].normal), minus(of(p[high].normal), of(p[low].normal)), part),
                  .arc = (double)p[low].arc + part * length};
    return e;
}

double flow_bend_room(const flow_point *p, uint32_t count, double arc, double apart)
{
    if (count < 2)
        return INFINITY;
    bend_end a = line_at(p, count, arc - WINDOW * apart), b = line_at(p, count, arc + WINDOW * apart);
    d3       m = d3_unit(a.normal), n = d3_unit(b.normal);
    double turn = atan2(d3_length(cross(m, n)), dot(m, n)), length = fmax(b.arc - a.arc, d3_length(minus(b.at, a.at)));
    bool   outwards = dot(minus(n, m), minus(b.at, a.at)) > 0;
    return outwards && turn > 0 && length > 0 ? ROOM * length / turn : INFINITY;
}
