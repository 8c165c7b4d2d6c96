/* Chains of lines drawn as curves: what lies between the ends of their lines bends with what is before and behind.
 * Freudenberg 2003, section 7.3.3; rows OE-12, OE-13. */
#ifndef LIMNER_STROKE_CURVE_PATH_H
#define LIMNER_STROKE_CURVE_PATH_H

#include "stroke/stroke_private.h"

enum { CURVE_STEPS_MAX = 4 };

/* The curve of one chain at a time. */
typedef struct curve_path {
    const stroke_view *v;
    const view_lines  *lines;
    int                steps; /* 0: chains stay as they are */
    uint8_t           *sharp; /* per vertex of the view: how many sharp lines it has, 3 for more */
    double (*positions)[3];   /* in the window; 2^steps to a line of the chain */
    double (*coarse)[3];
    size_t position_count, position_capacity, coarse_capacity;
} curve_path;

/* Errors: false when memory is gone. End with curve_path_close. */
bool curve_path_open(curve_path *c, const stroke_view *v, const view_lines *lines, int steps);
void curve_path_close(curve_path *c);

/* Are lines of this kind drawn as curves? Those along the mesh are; where pieces run through each other lines are
 * exact as they are. */
bool curve_path_bends(const curve_path *c, stroke_class kind);

/* Takes a chain: half-lines 2 · line + end that they begin at. The curve ends, and begins anew, at corners: where
 * three sharp edges meet, two that turn by more than 75°, and where a smooth outline comes to a sharp one. */
bool curve_path_take(curve_path *c, const uint32_t *path, size_t count, bool closed);

/* The position at a fraction of the chain's i-th line, counted in the chain's direction. */
void curve_path_at(const curve_path *c, size_t i, double fraction, double out[3]);

#endif
