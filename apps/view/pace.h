/* How much of a picture is drawn while something moves: as much as can be drawn in time. */
#ifndef LIMNER_VIEW_PACE_H
#define LIMNER_VIEW_PACE_H

#include <stdbool.h>

typedef struct pace {
    int    level;   /* 0: the whole picture; each further one is smaller */
    double mean_ms; /* of pictures at this level, smoothed; 0: none yet */
    bool   warm;    /* the first picture of a look compiles: its time says nothing */
} pace;

/* The side of a moving picture, as a fraction of the whole one. */
double pace_scale(const pace *p);

/* A moving picture took so long. */
void pace_told(pace *p, double ms);

#endif
