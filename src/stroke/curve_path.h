/* Chains of lines drawn as curves: what lies between the ends of their lines bends with what is before and behind. By
 * four-point subdivision (Freudenberg 2003, section 7.3.3; rows OE-12, OE-13), or else by arcs (curve_arcs.h). */
#ifndef LIMNER_STROKE_CURVE_PATH_H
#define LIMNER_STROKE_CURVE_PATH_H

#include "stroke/curve_arcs.h"
#include "stroke/stroke_private.h"

enum { CURVE_STEPS_MAX = 4 };

/* The curve of one chain at a time. */
typedef struct curve_path {
    const stroke_view *v;
    const view_lines  *lines;
    const uint32_t    *path;  /* of the chain, borrowed while it is the one */
    size_t             count; /* of its lines */
    int                steps; /* of subdivision; 0: arcs */
    double             most;  /* that arcs leave their lines by, window; 0: none */
    uint8_t           *sharp; /* per vertex of the view: how many sharp lines it has, 3 for more */
    double (*positions)[3];   /* of the subdivision, in the window; 2^steps to a line of the chain */
    double (*coarse)[3];
    arc_point *points; /* of the arcs */
    arc       *arcs;
    size_t     position_capacity, coarse_capacity, point_capacity, arc_capacity;
} curve_path;

/* Errors: false when memory is gone. End with curve_path_close. */
bool curve_path_open(curve_path *c, const stroke_view *v, const view_lines *lines, const stroke_options *options);
void curve_path_close(curve_path *c);

/* Are lines of this kind drawn as curves? Those along the mesh are; where pieces run through each other lines are
 * exact as they are. */
bool curve_path_bends(const curve_path *c, stroke_class kind);

/* Takes a chain: half-lines 2 · line + end that they begin at, which stay with the caller. The curve ends, and begins
 * anew, at corners: where three sharp edges meet, two that turn by more than 75° (arcs: 40°), and where a smooth
 * outline comes to a sharp one. */
bool curve_path_take(curve_path *c, const uint32_t *path, size_t count, bool closed);

/* Straight pieces that the chain's i-th line is drawn in, in the chain's direction, and where piece k begins: the
 * fraction of the line beside which that lies. */
size_t curve_path_pieces(const curve_path *c, size_t i);
double curve_path_stop(const curve_path *c, size_t i, size_t k);
/* The position beside a fraction of the chain's i-th line, counted in the chain's direction. So what is known of the
 * line at a fraction, such as what hides it, is true of the curve beside it. */
void curve_path_at(const curve_path *c, size_t i, double fraction, double out[3]);

#endif
