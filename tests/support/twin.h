/* The edge operators once more, on the CPU, straight from the formulas and on the raw maps of a drawing; with the
 * printed errors repaired as the notes say. Nothing here is taken from the shaders. */
#ifndef TRUTH_TWIN_H
#define TRUTH_TWIN_H

#include "shot.h"

/* A raw map: unit normal and depth, 0 at the near plane, 1 at the far plane and where nothing is. Empty pixels look
 * at the viewer: their normal is (0, 0, 1). Row 0 on top. */
typedef struct twin_map {
    int     width, height;
    dvec   *normal;
    double *depth;
} twin_map;

typedef struct twin_value {
    double profile, inner; /* R and G of the edge map before clamping */
    bool   doubtful;       /* a decision hung on a comparison that rounding to 16-bit floats can turn */
} twin_value;

void twin_map_make(twin_map *out, const shot *s);
void twin_map_release(twin_map *m);

/* Pre-filter: centre 1 + 8·amount, each of the eight neighbours −amount; normals are not made unit again. */
void twin_sharpen(twin_map *m, double amount);

/* Neighbours are numbered A B C / D X E / F G H from the upper left; pixels beyond the border repeat it. */
twin_value twin_four_tap(const twin_map *m, int x, int y, double offset, bool squared);
twin_value twin_sobel_nine(const twin_map *m, int x, int y);           /* textbook 3x3 kernels */
twin_value twin_sobel_eight(const twin_map *m, int x, int y);          /* four bilinear samples a direction */
twin_value twin_sobel_five(const twin_map *m, int x, int y);           /* four corner samples for both */
twin_value twin_saito(const twin_map *m, int x, int y);                /* I0 and I1 */
twin_value twin_pencil(const twin_map *m, int x, int y, double scale); /* equation 3 times scale, and I1 */
twin_value twin_saito_normalised(const twin_map *m, int x, int y, double jump, double floor_value);
twin_value twin_denormal(const twin_map *m, int x, int y, double tolerance, bool with_depth);

/* Bilinear sample of the map at a position in pixels (centres at .5); the normal is not made unit. */
void twin_bilinear(const twin_map *m, double x, double y, dvec *normal, double *depth);

/* What an 8-bit edge map holds for an intensity at gain 1. */
double twin_byte(double intensity);

#endif
