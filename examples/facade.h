/* Walls of stone with round-headed doors and windows. Each is told as standing between two z, looking to the front;
 * lengths are metres. A wall, its frames, its doors and its panes are put into meshes of their own, as they are of
 * different materials. */
#ifndef EXAMPLES_FACADE_H
#define EXAMPLES_FACADE_H

#include "solid.h"

enum { WINDOW_ROUND = 10 }; /* how many segments an arch has */

typedef enum filling { OPEN, PANE, DOOR } filling;

typedef struct opening {
    double  x, sill, springing, radius;
    filling filling;
} opening;

typedef struct facade {
    double         left, right, bottom, top, back, front;
    const opening *openings;
    int            count;
} facade;

void facade_wall(mesh *m, const facade *f);

/* Frames around the openings, proud of the wall, with sills under windows; the outer ones are at its back. */
void facade_frames(mesh *m, const facade *f);
void facade_outer_frames(mesh *m, const facade *f);

void facade_doors(mesh *m, const facade *f);
void facade_panes(mesh *m, const facade *f);

/* Here and there some stones of a wall, at its front or its back and between two heights, the way one hints at
 * them. They stand out of the wall by less than its frames do. */
void facade_stones(mesh *m, const facade *f, bool front, double from, double to, int clusters, uint32_t seed);

/* Stones of a corner, the long side now this way, now that. The wall lies towards (toward_x, toward_z). */
void quoins(mesh *m, double x, double z, int toward_x, int toward_z, double from, double to);

#endif
