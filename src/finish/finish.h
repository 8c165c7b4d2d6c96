/* The kind "finish": the sheet the drawing is on. */
#ifndef LIMNER_FINISH_FINISH_H
#define LIMNER_FINISH_FINISH_H

#include "technique/technique.h"

extern const kind kind_finish;

typedef enum sheet_motion { SHEET_FIXED, SHEET_FOLLOWING, SHEET_ZOOMING } sheet_motion;

/* The parameters, read by src/draw when it lays out the page. */
typedef struct sheet_values {
    colour  ground;
    int32_t paper, motion, paper_seed;
    float   grain, grain_size, pressure, relief;
} sheet_values;

/* How the model stands to the viewer, as far as a paper that goes with it wants to know. */
typedef struct sheet_view {
    double anchor[2];  /* where its middle is on the page, pixels from the bottom left */
    double scale;      /* pixels of a unit there */
    double fitted;     /* the same when the model fills the page */
    double radius;     /* of the ball that turns as the model does, units */
    double azimuth, elevation; /* of the viewer around the model, radians */
    double roll;       /* of the upright on the page against the picture's, counterclockwise */
} sheet_view;

/* From pixels (x, y) to a paper that repeats: (a x − b y + u, b x + a y + v). */
typedef struct sheet_place {
    float a, b, u, v;
} sheet_place;

/* Where the paper lies: a function of the view alone. Papers that zoom are two, of one octave each; the share of the finer one is returned, else 0. */
float sheet_lay(const sheet_values *values, const sheet_view *view, sheet_place out[2]);

#endif
