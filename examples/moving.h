/* What machines that move are put together from, and their clips. */
#ifndef EXAMPLES_MOVING_H
#define EXAMPLES_MOVING_H

#include "model.h"

/* A round tube through points that lie in a plane with this normal; its ends are closed. */
void tube(mesh *m, const double (*points)[3], int count, const double normal[3], double radius, int sides);

/* A corner of a path in a plane, rounded: points of an arc that is walked from one angle to the other. */
int arc_points(double (*points)[3], int had, const double middle[3], int u, int v, double radius, double from,
               double to, int segments);

/* A plate over an elevation whose edges are bevelled; `inset` is the outline drawn in by `bevel`. */
void bevelled_plate(mesh *m, const outline *whole, const outline *inset, double from, double to, double bevel);

/* A link between two round ends, from (0, 0) to (length, 0), bevelled. */
void link_plate(mesh *m, double length, double from_radius, double to_radius, double from, double to, double bevel);

/* A polygon with rounded corners; the rows are {u, v, radius of the corner}. */
outline rounded(const double (*corners)[3], int count);

/* Turns everything after the first `kept` points about an axis (0, 1 or 2), then moves it. */
void turn_about(mesh *m, uint32_t kept, int axis, double degrees, double x, double y, double z);

/* --- clips ---------------------------------------------------------------------------------------------- */

enum { KEYS_MAX = 128, TRACKS_MAX = 16 };

/* What moves one group or part: values of the path "translation" (3 numbers) or "rotation" (4) at times. */
typedef struct track {
    int         node;
    const char *path;
    bool        cubic; /* each key has three values then: the tangent before, the value, the tangent after */
    int         count;
    float       times[KEYS_MAX], values[KEYS_MAX * 4];
} track;

typedef struct clip {
    const char *name;
    int         count;
    track       tracks[TRACKS_MAX];
} clip;

track *clip_add(clip *c, int node, const char *path);
void   track_translation(track *t, double time, double x, double y, double z);
void   track_rotation(track *t, double time, const double quaternion[4]);
void   track_angle(track *t, double time, int axis, double angle); /* radians */
void   put_clips(glb *g, FILE *json, const clip *clips, int count);

#endif
