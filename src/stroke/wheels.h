/* Triangles around a point of the page that very many share, by direction: a line that begins there meets few of them,
 * while all of them are in the point's cell, however fine the grid is. */
#ifndef LIMNER_STROKE_WHEELS_H
#define LIMNER_STROKE_WHEELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct stroke_view;

/* A triangle from one direction on, radians from 0 to 2 π, counter-clockwise in x and y. */
typedef struct wheel_spoke {
    uint32_t wheel, level, triangle; /* level: of about the same width */
    float    from, width;
} wheel_spoke;

typedef struct window_wheels {
    uint32_t    *of_points, *of_triangles; /* a wheel, from 1 on; 0: none; NULL: there are no wheels */
    wheel_spoke *spokes;                   /* by wheel, level and direction */
    size_t       count;
} window_wheels;

bool wheels_make(window_wheels *out, const struct stroke_view *v);
void wheels_release(window_wheels *w);
/* All triangles of the wheel that a line from its middle in a direction may meet, or run along. */
typedef void (*wheel_visit)(void *user, uint32_t triangle);
void wheel_walk(const window_wheels *w, uint32_t wheel, double x, double y, wheel_visit visit, void *user);

#endif
