/* Maps of space through which an ordinary camera sees what no camera does. Lorenz, Trapp, Döllner and Jobst 2008,
 * "Interactive multi-perspective views of virtual 3D landscape and city models": the ground is bent along a curve. */
#ifndef LIMNER_PLAN_PROJECTION_H
#define LIMNER_PLAN_PROJECTION_H

#include "limner/projection.h"
#include "plan/camera.h"

typedef struct projection_row projection_row;

enum { PROJECTION_PLANES_MOST = 512, PROJECTION_NO_PLANE = -1 };
/* Where in its piece a place is: between its planes, or on one of them. */
typedef enum projection_where { PROJECTION_BETWEEN, PROJECTION_ON_LOW, PROJECTION_ON_HIGH } projection_where;

/* In a frame of its own, right, ahead and up, level with the ground, from an origin. Upright planes part space into
 * pieces, in each of which the map is as good as affine, so that what is flat there stays flat. */
typedef struct projection_map {
    const projection_row *row;
    double                origin[3], axes[3][3];
    double from, radius, angle; /* of the curve: where it begins, how tight and how long it is, radians */
    double lean;                /* how far the ground leans in the middle of the view, radians */
    int    pieces, plane_count;
    double planes[PROJECTION_PLANES_MOST][3]; /* right · [0] + ahead · [1] − [2]: 0 on the plane, below before it */
} projection_map;

struct projection_row {
    const char *name;
    bool        round; /* pieces lie around the origin, and the last one's high plane is the first one's low one */
    /* The map between an eye that `c` has been placed for and the scene; changes the view that is drawn with. */
    lmn_status (*lay)(projection_map *m, const view_camera *c, box3 box, int up, const lmn_projection_desc *how,
                      lmn_draw_desc *desc, lmn_error *error);
    /* A place in a piece. On a plane it comes from both pieces to the same place, to the bit; but for that between a
     * round one's first and last. */
    void (*bend)(const projection_map *m, int piece, projection_where where, const double at[3], double out[3]);
};

/* The planes of a piece: numbers of `planes`, or PROJECTION_NO_PLANE. */
void projection_planes(const projection_map *m, int piece, int *low, int *high);
/* How far behind a plane a place is. */
double projection_behind(const projection_map *m, int plane, const double at[3]);

/* NULL: there is none with this number. */
const projection_row *projection_row_of(int projection);

/* Places of the world, as they are and in the map's frame. */
void projection_to_frame(const projection_map *m, const double world[3], double out[3]);
void projection_to_world(const projection_map *m, const double frame[3], double out[3]);
/* What a direction of the world becomes on the ground in the middle of the view. */
void projection_lean(const projection_map *m, const double way[3], double out[3]);

#endif
