/* Outlines of what was drawn, from a depth map of the same view at a higher resolution, and how a drawing in ink
 * covers them. */
#ifndef TRUTH_OUTLINE_TRUTH_H
#define TRUTH_OUTLINE_TRUTH_H

#include <stdint.h>

typedef struct outline_score {
    double length, covered; /* of the outlines: pixels of the drawing */
    double longest_gap;     /* pixels of the drawing */
    double gap_at[2];       /* where it is */
    long   ink, stray;      /* pixels with ink; those of them far from any step of depth */
    double stray_at[2];     /* one of them */
} outline_score;

/* `picture`: RGBA8, ink on a light ground. `depth`: eye depth, infinite where nothing is, `finer` times as wide and as
 * high. An outline is a step in depth by more than a fiftieth of the depth range, and of more than what the surface
 * does beside it; it is covered when there is ink within 1.5 pixels. Ink is stray when no step of depth at all lies
 * within 4 pixels. */
void outline_measure(outline_score *out, const uint8_t *picture, int width, int height, const float *depth, int finer);

#endif
