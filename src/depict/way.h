/* Where a node is at any time, without posing the scene that it is in: the product of what it hangs on, each with the
 * channels that move it. Nienhaus 2005, sections 7.4.1 to 7.4.3: P(node), and the trajectory sampled from it. */
#ifndef LIMNER_DEPICT_WAY_H
#define LIMNER_DEPICT_WAY_H

#include "base/vector3.h"
#include "behaviour/trajectory.h"
#include "pose/moment.h"
#include "scene/scene.h"

/* A node of the path from the root, and what moves it. NULL: it stays as it is. */
typedef struct way_step {
    int32_t                  node;
    const animation_channel *translation, *rotation, *scale;
} way_step;

typedef struct way {
    const lmn_scene *scene; /* lent */
    way_step        *steps; /* from the root to the node */
    size_t           count;
    double           end; /* seconds: the last key of anything on the path; 0: nothing moves it */
} way;

/* Errors: LMN_MEMORY. Release it also after one. */
lmn_status way_open(way *out, const lmn_scene *scene, int32_t node, const moment *clips, lmn_error *error);
void       way_release(way *w);

/* From the node to the world, at a time in seconds. */
mat4 way_world(const way *w, double seconds);
/* Where a point of the node's own axes is. */
void way_point(const way *w, const double local[3], double seconds, double out[3]);
/* By central differences over at most `span` seconds; units a second. Where something bounces, before and after. */
void way_velocity(const way *w, const double local[3], double seconds, double span, double out[3]);

/* A point's trajectory: all keys between the two times are samples, since there things bounce. Two samples at least.
 * Errors: as of trajectory_create. Release it also after one. */
lmn_status way_trajectory(trajectory *out, const way *w, const double local[3], double from, double to,
                          double tolerance, lmn_error *error);

#endif
