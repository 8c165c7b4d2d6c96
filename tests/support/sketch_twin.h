/* Perturbed drawings once more, on the CPU, straight from the formulas, out of the unperturbed maps and the field
 * of uncertainty that the drawing used. Positions count pixels from the picture's lower left, integers are the centres
 * of pixels; maps have row 0 on top. */
#ifndef TRUTH_SKETCH_TWIN_H
#define TRUTH_SKETCH_TWIN_H

#include "shot.h"

typedef struct sketch_position {
    double x, y;
} sketch_position;

/* As shown, premultiplied. */
typedef struct sketch_paint {
    double r, g, b, a;
} sketch_paint;

/* A 2x2 matrix: to the right from n.x and n.y, up from n.x and n.y. */
typedef struct sketch_degree {
    double xx, xy, yx, yy;
} sketch_degree;

/* What a rule of a look says; all classes of its lines have one colour. */
typedef struct sketch_style {
    double        amount;
    sketch_degree edges, shades;
    sketch_paint  ink, fallback, ground;
    bool          without_lines, without_fill;
    int           repeat; /* 0 is 1 */
    double        repeat_degree;
    sketch_paint  repeat_inks[8]; /* of the copies from the second on */
    double        pressure;       /* of thin lines */
} sketch_style;

/* The maps of a figure or of one of its layers. */
typedef struct sketch_maps {
    int            width, height;
    const float   *depth;
    const uint8_t *edge, *shade;
    const float (*uncertainty)[3];
} sketch_maps;

sketch_maps sketch_maps_of(const shot *s);
sketch_maps sketch_maps_of_layer(const shot *s, int layer); /* with the drawing's one field */

sketch_degree sketch_scaled(double degree);                   /* degree in both directions alike */
sketch_degree sketch_times(sketch_degree a, sketch_degree b); /* a · b */
sketch_degree sketch_turn(double degrees);                    /* anticlockwise */

/* The degree of the i-th copy of the lines, and its ink at its position; the depth is infinite where it has neither
 * ink nor surface. */
sketch_degree sketch_copy(const sketch_style *style, int i);
sketch_paint  sketch_copy_ink(const sketch_maps *m, const sketch_style *style, int i, int x, int y, double *depth);

sketch_position sketch_moved(const sketch_maps *m, int x, int y, double amount, sketch_degree degree);
bool            sketch_inside(const sketch_maps *m, sketch_position p);
double          sketch_depth(const sketch_maps *m, sketch_position p);        /* of the nearest texel */
double          sketch_depth_around(const sketch_maps *m, sketch_position p); /* the least that filtering mixes there */
double          sketch_reach(const sketch_maps *m, sketch_position p, int reach);    /* the least within a square */
double          sketch_field(const sketch_maps *m, double x, double y, int channel); /* between texels */
void            sketch_edge(const sketch_maps *m, sketch_position p, double out[4]);
sketch_paint    sketch_shade(const sketch_maps *m, sketch_position p);

sketch_paint sketch_colour(const uint8_t srgb[3], double alpha);
sketch_paint sketch_over(sketch_paint front, sketch_paint back);
sketch_paint sketch_fraction(sketch_paint p, double fraction);
sketch_paint sketch_ink(const double edge[4], sketch_paint colour);

/* Colour and depth of an opaque figure at a pixel (x to the right, y up); alpha 0 and an infinite depth where it is
 * not. */
sketch_paint sketch_opaque(const sketch_maps *m, const sketch_style *style, int x, int y, double *depth);

const uint8_t *sketch_pixel(const shot *s, int x, int y);                    /* y up */
double         sketch_levels_off(const uint8_t *drawn, sketch_paint wanted); /* the largest of the three channels */

typedef struct sketch_tally {
    int    pixels, right, x, y;
    double worst;
} sketch_tally;

void sketch_judge(sketch_tally *t, const shot *s, int x, int y, sketch_paint wanted, double levels);
bool sketch_check(const char *row, const sketch_tally *t, const shot *s, double fraction, const char *what);

/* The whole picture of one opaque figure against its twin. */
bool sketch_check_opaque(const char *row, const shot *s, const sketch_style *style, double levels, double fraction,
                         const char *what);

#endif
