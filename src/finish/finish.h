/* The kind "finish": the sheet the drawing is on. */
#ifndef LIMNER_FINISH_FINISH_H
#define LIMNER_FINISH_FINISH_H

#include "technique/technique.h"

extern const kind kind_finish;

typedef enum sheet_motion { SHEET_FIXED, SHEET_FOLLOWING, SHEET_ZOOMING } sheet_motion;

/* The parameters, read by src/frame when it lays out the page. */
typedef struct sheet_values {
    colour  ground, ink;
    int32_t paper, motion, paper_seed;
    float   grain, grain_size, pressure, relief;
    /* src/annotate */
    param_words labels, labels_by;
    int32_t     labels_most;
    float       label_size;
    bool        legend, north_arrow, scale_bar;
} sheet_values;

/* How the model stands to the viewer, as far as a paper that goes with it wants to know. */
typedef struct sheet_view {
    double anchor[2];          /* where its middle is on the page, pixels from the bottom left */
    double scale;              /* pixels of a unit there */
    double fitted;             /* the same when the model fills the page */
    double radius;             /* of the ball that turns as the model does, units */
    double azimuth, elevation; /* of the viewer around the model, radians */
    double roll;               /* of the upright on the page against the picture's, counterclockwise */
} sheet_view;

/* From pixels (x, y) to a paper that repeats: (a x − b y + u, b x + a y + v). */
typedef struct sheet_position {
    float a, b, u, v;
} sheet_position;

/* How the paper lies. Papers that zoom are two, of one octave each. A paper that has rolled half around has come to
 * its end, and begins again: around there some of its pieces are where it ends and some where it begins. */
typedef struct sheet_lie {
    sheet_position octaves[2];
    float          finer;    /* fraction of the second octave; 0: there is one only */
    float          begin[2]; /* of each octave, what is to be added to u where it begins again */
    float          begun;    /* fraction of the pieces that do */
    sheet_position
        pieces; /* from pixels to what tells pieces apart: those begin whose contact there is less than the fraction */
} sheet_lie;

/* What the strongest ink differs by from a ground (premultiplied), where it takes away from it and where it
 * adds to it. */
void sheet_range(const sheet_values *values, const float ground[4], float less[4], float more[4]);

/* A function of the view alone. */
sheet_lie sheet_lay(const sheet_values *values, const sheet_view *view);

#endif
