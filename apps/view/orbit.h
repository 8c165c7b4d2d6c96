/* Where the viewer stands: a camera that turns around what it looks at. Angles in radians, lengths in the scene's unit,
 * positions on the picture in its pixels from the top left corner. */
#ifndef LIMNER_VIEW_ORBIT_H
#define LIMNER_VIEW_ORBIT_H

#include "limner/limner.h"

typedef struct orbit {
    double target[3];    /* what it turns around */
    double yaw, pitch;   /* of the direction from the target to the eye: 0, 0 is the view from the front */
    double distance;     /* from the eye to the target */
    double fov_deg;      /* vertical angle of view */
    bool   orthographic; /* parallel rays that show at the target what the perspective would */
    char   up;           /* the scene's up axis, 'y' or 'z' */
} orbit;

/* The view "iso" of a scene with this up axis; fit it before it is used. */
orbit orbit_make(char up);

/* Turns to a named view; what it looks at stays. */
void orbit_turn_to(orbit *o, lmn_view view);

/* Moves so that the box fills nine tenths of a picture of this size. An empty box is taken for one of size 1. */
void orbit_fit(orbit *o, const double box_min[3], const double box_max[3], int width, int height);

/* Turns as if the pointer held the model: by `dx`, `dy` pixels of a picture that is `height` high. */
void orbit_turn(orbit *o, double dx, double dy, int height);

/* Moves eye and target so that what lies in the target's depth follows the pointer. */
void orbit_pan(orbit *o, double dx, double dy, int height);

/* Comes nearer by `factor` (0.5: half the distance), so that what is at x, y in the target's depth stays there. */
void orbit_zoom(orbit *o, double factor, double x, double y, int width, int height);

/* Walks: moves eye and target along the view, to the right and upwards. */
void orbit_walk(orbit *o, double forward, double right, double up);

/* Looks around: turns the view with the eye in its place. */
void orbit_look(orbit *o, double dx, double dy, int height);

/* Takes over a camera with this eye, target and up vector as well as an orbit can; roll is lost. */
void orbit_place(orbit *o, const double eye[3], const double target[3]);

/* The camera's axes in the scene: to the right, up, and into the picture. */
void orbit_axes(const orbit *o, double right[3], double up[3], double forward[3]);

void orbit_eye(const orbit *o, double eye[3]);

/* Where a point of the scene is on the picture; false when it is behind the eye. */
bool orbit_project(const orbit *o, const double point[3], int width, int height, double pixel[2]);

/* The ray through a position of the picture. */
void orbit_ray(const orbit *o, double x, double y, int width, int height, double origin[3], double direction[3]);

/* What lmn_draw needs of it. */
void orbit_describe(const orbit *o, lmn_draw_desc *desc);

#endif
