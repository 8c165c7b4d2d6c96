/* What hatching should be, from its formulas (seed 001, section 6.7, with its defects E10 and E11 mended) and what
 * its parameters say, in double precision; and how drawings of it are measured. */
#ifndef TRUTH_HATCH_TRUTH_H
#define TRUTH_HATCH_TRUTH_H

#include "shape.h"
#include "shot.h"

/* Endless lines of one set without any unevenness. */
typedef struct hatch_rule {
    bool   by_width;
    double scale, width; /* px; the width matters by number */
} hatch_rule;

/* The octave of a position: lines lie at whole multiples of 2^-octave, and new ones come halfway between. */
typedef struct hatch_octave {
    double period;               /* px between old lines */
    double old_width, new_width; /* px */
    int    octave;
} hatch_octave;

hatch_octave hatch_octave_of(const hatch_rule *r, double rate, double darkness);

/* The fraction of a pixel that lines cover: `coordinate` at its middle, which changes by `rate` a pixel across the
 * lines. */
double hatch_cover(const hatch_rule *r, double coordinate, double rate, double darkness);

/* A look with one rule that hatches black on white without textures: further settings, the direction of the light,
 * further keys of the rule (or ""). Valid until the fourth next call. */
const char *hatch_look(const char *light, const char *rule, const char *settings, ...)
    __attribute__((format(printf, 3, 4)));

/* How much ink a pixel has, 0 … 1 (ink black, paper white), and the mean of a rectangle or of all that is not empty
 * (needs maps). */
double hatch_ink(const shot *s, int x, int y);
double hatch_mean(const shot *s, int x0, int y0, int x1, int y1);
double hatch_mean_inside(const shot *s);

/* Is every value of a picture a number, that is: are all of its pixels grey and solid? */
int hatch_odd_pixels(const shot *s);

/* Lines counted along rows or columns, whichever they cross more, their slant taken out. */
typedef struct hatch_count {
    double period;                /* px, median distance between those lines that are as wide as any */
    double all_period;            /* px, mean distance between lines of whatever width */
    double width;                 /* px, median of those as wide as any */
    double width_low, width_high; /* 5th and 95th of a hundred of them */
    double deviation;             /* px, standard deviation of the width of all as wide as half of the widest */
    double mean;                  /* ink */
    int    lines;
} hatch_count;

hatch_count hatch_count_lines(const shot *s);

/* Mean width of edges from a tenth to nine tenths of ink, px: the area between over the length (total variation). Of a
 * few edges it says little: one that is upright is in the same place on the grid in all rows. */
typedef struct hatch_edges {
    double area, variation;
} hatch_edges;
void   hatch_add_edges(const shot *s, int x0, int y0, int x1, int y1, hatch_edges *sum);
double hatch_edge_width(const shot *s, int x0, int y0, int x1, int y1);

/* Where a pixel of `to` was in `from`: false where it was hidden or out of the picture. Nothing moved but the
 * viewer. */
bool hatch_was_at(const shot *to, const shot *from, int x, int y, double *from_x, double *from_y);

/* What changed from one frame to the next where the same surface is seen, two pixels from its rims, and not too
 * steep (at most 66 degrees), ink smoothed over a pixel. */
typedef struct hatch_change {
    double changed; /* fraction of pixels that differ by more than a quarter */
    double mean;    /* mean absolute difference */
    double block;   /* largest change of the mean ink of 16·16 px that are whole */
    double correlation;
    int    pixels;
} hatch_change;

hatch_change hatch_compare(const shot *to, const shot *from);

/* A wall in the plane z = 0, turned about y by degrees, and a ball with bumps, a ring and two boxes around it. */
void hatch_wall(shape *s, double half, double degrees);
void hatch_model(shape *s);

/* Parallel view of a wall straight on, of which it shows this half height. */
shot_view hatch_front(int side, double half);

#endif
