/* What the files of fitting share: pieces through a run of points. Positions are in mm, doubles. */
#ifndef LIMNER_SHEET_FIT_PRIVATE_H
#define LIMNER_SHEET_FIT_PRIVATE_H

#include <math.h>

#include "sheet/fit.h"

/* Numbers on a sheet are far from what squares overflow at. */
static inline double fit_distance(double x, double y)
{
    return sqrt(x * x + y * y);
}

/* Points that one piece is to go through, from the first to the last. */
typedef struct fit_run {
    const double (*points)[2];
    const double *arcs; /* along the lines up to each point, mm */
    size_t        count;
    double        most; /* that piece and lines are apart */
} fit_run;

/* Each says whether such a piece lies near enough all along, and makes it. `square` (may be NULL) gets the sum of the
 * squares of what points are off, weighted by the lengths beside them. */
bool fit_line(sheet_piece *out, const fit_run *r, double *square);
bool fit_arc(sheet_piece *out, const fit_run *r, double *square);
/* A whole circle, a whole ellipse: the run's last point is its first once more. */
bool fit_circle(sheet_piece *out, const fit_run *r);
bool fit_whole_ellipse(sheet_piece *out, const fit_run *r);
bool fit_ellipse(sheet_piece *out, const fit_run *r);
/* `begin`, `end`: unit directions that it has there; NULL: any. `parameters` has room for one number a point. */
bool fit_cubic(sheet_piece *out, const fit_run *r, const double *begin, const double *end, double *parameters);

/* How long a piece is. */
double fit_length(const sheet_piece *piece, const double from[2]);
/* The unit direction of a piece where it begins and ends; `from`: where it begins. False: it has none. */
bool fit_direction(const sheet_piece *piece, const double from[2], bool at_end, double out[2]);

/* Does a curve lie along the lines of a run, neither farther from the other than the run's `most`? `at` gives the
 * curve at 0 … 1; `pieces`: how many straight ones it is looked at in. May say no where the answer is yes. */
typedef void (*fit_curve_fn)(const sheet_piece *piece, const double from[2], double fraction, double out[2]);
bool fit_follows(const sheet_piece *piece, fit_curve_fn at, int pieces, const fit_run *r);

#endif
