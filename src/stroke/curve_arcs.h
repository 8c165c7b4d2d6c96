/* Polylines that stand for curves, as curves: each line becomes an arc over its chord, and arcs meet without a corner.
 * Circles of few corners become round, what is straight stays straight. */
#ifndef LIMNER_STROKE_CURVE_ARCS_H
#define LIMNER_STROKE_CURVE_ARCS_H

#include <stdbool.h>
#include <stddef.h>

/* How a polyline may turn at a point. */
typedef enum arc_point_kind {
    ARC_POINT_SMOOTH, /* on a surface that is smooth: any turn but a sharp one is a curve's */
    ARC_POINT_STEP,   /* between sharp edges: a curve's only where three turns or more in a row are alike */
    ARC_POINT_CORNER
} arc_point_kind;

typedef struct arc_point {
    double x, y;           /* smooth ones are moved by curve_arcs */
    double home_x, home_y; /* made by curve_arcs: where it was */
    double aside;          /* of curve_arcs alone */
    double turn;           /* made by curve_arcs: from the line before to the line behind, radians; 0 at corners */
    double length;         /* made by curve_arcs: of the line that begins here */
    int    kind;           /* arc_point_kind; curve_arcs makes more of them corners */
} arc_point;

/* How an arc leaves its chord: slopes against it where it begins and where it ends. The arc is the graph
 * `begin · u (1 − u)² + end · u² (1 − u)` over the chord, both in lengths of the chord, to the left of its way. */
typedef struct arc {
    double begin, end;
} arc;

/* Arcs of all lines between `count` points, or of `count` lines when the polyline is closed. The first and the last
 * point of an open one are corners. No arc leaves its chord, as it was, by more than `most`. Points at the same
 * position are corners. */
void curve_arcs(arc *out, arc_point *points, size_t count, bool closed, double most);

/* How far an arc is from its chord at a fraction of it, in lengths of the chord. */
static inline double arc_height(arc a, double fraction)
{
    return fraction * (1 - fraction) * (a.begin * (1 - fraction) + a.end * fraction);
}

#endif
