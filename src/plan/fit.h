/* How far what is drawn reaches to the four sides of a view: what pictures are fitted to. Vertices decide, not boxes,
 * so that a ball fills the picture as a cube does. */
#ifndef LIMNER_PLAN_FIT_H
#define LIMNER_PLAN_FIT_H

#include "look/look.h"
#include "pose/pose.h"

/* Rays that fall by less than this see the ground edge on: 1 degree. */
#define GROUND_EDGE_ON 0.0175

/* The ground that what is fitted stands on. */
typedef struct fit_ground {
    bool   there, shadowed; /* shadowed: a light's shadow on it is drawn, and fitted with what throws it */
    int    up;              /* axis of the world: 1 or 2 */
    double level;           /* along it */
    double spread;          /* how far the ground is darker, to be seen, around what it is touched by; 0: it is not */
} fit_ground;

/* What is fitted. Lent. */
typedef struct fit_body {
    const pose     *pose;
    const lmn_look *look; /* whose light throws the shadow; NULL: there is none */
    fit_ground      ground;
    const bool     *fitted;      /* per part, ghosts behind; NULL: nothing */
    const box3     *ghost_boxes; /* per part: of ghosts, what of them counts */
    size_t          part_count;
    box3            box; /* of all that, world axes */
} fit_body;

/* A view's axes, and the slopes of its outermost rays across and up, 0 with parallel rays. */
typedef struct fit_view {
    double      right[3], up[3], forward[3], middle[3]; /* reaches are measured from the middle */
    double      slope[2];
    const mat4 *shadow; /* what takes a position to where its shadow lies; NULL: shadows do not count */
} fit_view;

/* Along one axis of the picture, for steps of slope s from 0 to the view's: the most of x − s·z over all points, and of
 * −x − s·z, where z is the depth. */
enum { FIT_STEPS = 6 };
typedef struct fit_reach {
    double plus[FIT_STEPS + 1], minus[FIT_STEPS + 1];
} fit_reach;

/* Across and up. Without points all of it is −INFINITY. Meshes count by their vertices, in their pose; solids, and what
 * is fitted to all times, by their boxes; each with its shadow. Seen from above the ground counts, too, as far as
 * it is dark around what touches it. */
void fit_measure(fit_reach out[2], const fit_body *body, const fit_view *view);

/* The reaches at a slope from 0 to `most`: between steps they are at most this. */
double fit_plus(const fit_reach *r, double slope, double most);
double fit_minus(const fit_reach *r, double slope, double most);

#endif
