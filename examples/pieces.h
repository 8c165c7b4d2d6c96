/* What buildings are put together from. Lengths are metres, +y is up; every piece is one closed shell that is added
 * to a mesh. Pieces of one mesh reach into each other by a centimetre or more, so that no two faces lie in one
 * plane. */
#ifndef EXAMPLES_PIECES_H
#define EXAMPLES_PIECES_H

#include "solid.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

void box(mesh *m, double left, double bottom, double back, double right, double top, double front);

/* Prisms over an outline, which may run either way: over an elevation (x, y) between two z, over a section (z, y)
 * between two x, over a plan (x, z) between two heights. */
void elevation(mesh *m, const outline *o, const outline *holes, int hole_count, double from, double to);
void section(mesh *m, const outline *o, double from, double to);
void plan(mesh *m, const outline *o, const outline *holes, int hole_count, double from, double to);

/* A section whose ends lie on the slanted planes x = end[0] + end[1] · z. */
void mitred_section(mesh *m, const outline *o, const double from[2], const double to[2]);

/* A solid of revolution that stands at a position; the profile's rows are {y, radius}. It ends at radius 0. */
#define TURNED(mesh, x, y, z, segments, ...) LATHE(mesh, (&(frame){{x, y, z}, UP}), segments, NULL, NULL, __VA_ARGS__)

/* A round bar with `sides` sides between two points, tapered. */
void bar(mesh *m, const double from[3], const double to[3], double from_radius, double to_radius, int sides);

/* A round hoop of `sides` sides about y. */
void hoop(mesh *m, const double middle[3], double radius, double thickness, int segments, int sides);

/* A foliage ball, lumpy the way its seed says. */
void foliage(mesh *m, const double middle[3], double radius, double height, uint32_t seed);

/* A bare tree of tapered limbs. */
void tree(mesh *m, const double foot[3], double height, uint32_t seed);

/* Turns everything after the first `kept` points about y, counter-clockwise from above, then moves it. */
void position(mesh *m, uint32_t kept, double degrees, double x, double y, double z);

/* Round-headed openings: a sill, jambs and an arch of some radius from the springing. */
outline round_headed(double middle, double sill, double springing, double radius, int segments);

/* What frames such an opening: outwards by `width`, without a bottom. */
outline round_headed_frame(double middle, double sill, double springing, double radius, double width, int segments);

/* A smooth closed curve through points, each way between two of them in so many steps; for silhouettes. */
outline smooth(const double (*points)[2], int count, int between);

/* A number from 0 to 1 that depends on nothing but the seed, which moves on. */
double chance(uint32_t *seed);

#endif
