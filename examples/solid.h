/* Solids that are sewn from rings of points: strips between rings, flat faces within them. A shell is closed when every
 * ring was used twice, where one strip or face ends and where the next begins; a hole that leads through is simply a
 * longer walk.
 *
 * Each model has its unit of length. Points lie on a grid of 1/10000 of it and flat faces are divided in whole numbers,
 * so that every machine makes the same triangles. Whatever fails ends the program: nothing that fails here can be
 * mended by whoever runs it. */
#ifndef EXAMPLES_SOLID_H
#define EXAMPLES_SOLID_H

#include <stdbool.h>
#include <stdint.h>

enum { RING_MAX = 640, HOLES_MAX = 16 };

#define GRID 10000.0 /* steps per unit of length */
#define PI   3.14159265358979323846

typedef struct point {
    int32_t at[3];
} point;

typedef struct mesh {
    point    *points;
    uint32_t *indices;
    uint32_t  point_count, index_count, point_space, index_space;
} mesh;

/* Directions that a ring can be stood up in, or a flat face look at. */
typedef enum direction { RIGHT, LEFT, UP, DOWN, FRONT, BACK } direction;

/* A closed plane curve, counter-clockwise. The third number is how far a point stands out of the plane. */
typedef struct outline {
    int    count;
    double at[RING_MAX][3];
} outline;

/* Points of a mesh, in order. */
typedef struct ring {
    int      count;
    uint32_t at[RING_MAX];
} ring;

/* Where outlines are placed: u, v and the way along `along` make a right-handed system. */
typedef struct frame {
    double    origin[3];
    direction along;
} frame;

_Noreturn void give_up(void);

uint32_t put_point(mesh *m, const frame *f, double u, double v, double t);
void     put_triangle(mesh *m, uint32_t a, uint32_t b, uint32_t c);
ring     put_ring(mesh *m, const frame *f, const outline *o, double t);

/* Strips between two rings of as many points, whole or the columns first … first + count − 1. Outer walls are
 * walked in the frame's direction, holes against it, and the faces at the far end inwards. */
void sew(mesh *m, const ring *a, const ring *b);
void sew_columns(mesh *m, const ring *a, const ring *b, int first, int count);

/* A flat face with holes. The rings may run either way. */
void cap(mesh *m, direction facing, const ring *outer, const ring *holes, int hole_count);

/* Strips through rings of radius r at t, each row of the profile being {t, r}. Radius 0 ends the shell, or begins
 * it, in a point. The first and the last ring are for whoever goes on from there; NULL when nobody does. */
void lathe(mesh *m, const frame *f, const double (*profile)[2], int count, int segments, ring *first, ring *last);

#define LATHE(mesh, frame, segments, first, last, ...)                                                                 \
    lathe(mesh, frame, (const double[][2]){__VA_ARGS__},                                                               \
          (int)(sizeof((const double[][2]){__VA_ARGS__}) / sizeof(double[2])), segments, first, last)

/* A plate with holes between two heights along f->along, or standing up to the front. */
void extrude_along(mesh *m, const frame *f, const outline *outer, const outline *holes, int hole_count, double from,
                   double to);
void extrude(mesh *m, const outline *outer, const outline *holes, int hole_count, double from, double to);

/* Removes points that no triangle uses. */
void drop_unused(mesh *m);

/* --- outlines; angles in degrees ------------------------------------------------------------------------ */

void add_point(outline *o, double u, double v);
void add_arc(outline *o, double u, double v, double radius, double from, double to, int segments); /* with both ends */
outline circle(double u, double v, double radius, int segments);
outline rectangle(double left, double bottom, double right, double top);

/* Two arcs, one over the other, joined by straight sides. The arcs begin at angle `from` below the horizontal.
 * Column `segments` is the left side, the last column the right one. */
outline double_round(double half_distance, double radius, double from, int segments);

#endif
