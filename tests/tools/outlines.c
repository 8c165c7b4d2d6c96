/* How well a drawing covers outlines: `outlines DRAWING.png DEPTH.pfm`, the map a whole number of times as large.
 * Prints covered percent, longest gap and where, stray ink percent and where. */
#include <stdio.h>
#include <stdlib.h>

#include "outline_truth.h"
#include "picture.h"

int main(int argc, char **argv)
{
    int width, height, wide, high;
    if (argc != 3) {
        fprintf(stderr, "usage: outlines DRAWING.png DEPTH.pfm\n");
        return 1;
    }
    uint8_t *picture = picture_read_rgba(argv[1], &width, &height);
    float   *depth = picture_read_pfm(argv[2], 1, &wide, &high);
    if (!picture || !depth || wide % width || wide / width != high / height) {
        fprintf(stderr, "outlines: cannot read these, or the map is not a whole number of times as large\n");
        return 2;
    }
    outline_score s;
    outline_measure(&s, picture, width, height, depth, wide / width);
    printf("covered %6.2f %% of %6.0f px, longest gap %5.1f px at %4.0f,%4.0f, stray %5.2f %% of %6ld at %4.0f,%4.0f\n",
           100 * s.covered / s.length, s.length, s.longest_gap, s.gap_at[0], s.gap_at[1],
           s.ink ? 100.0 * (double)s.stray / (double)s.ink : 0, s.ink, s.stray_at[0], s.stray_at[1]);
    free(picture);
    free(depth);
    return 0;
}
