/* Scenes of boxes that move along straight lines, as .glb files: what they do is known without any renderer. */
#ifndef LIMNER_TESTS_BOXES_H
#define LIMNER_TESTS_BOXES_H

#include <stdbool.h>

#include "limner/limner.h"

typedef struct moving_box {
    const char *name;
    double      middle[3], half[3]; /* at 1 s, in its parent's axes */
    double      colour[3];          /* linear; unlit */
    double      moved[3];           /* from 0 s to 1 s */
    double      turn;               /* about z, degrees */
    int         parent;             /* one of those before, or −1 */
    bool        open;               /* only the face towards +z */
} moving_box;

void boxes_write(const char *path, const moving_box *boxes, int count);

/* A view of 20 units in height and width around the origin, from +z. */
void boxes_view(lmn_draw_desc *desc, int side);

#endif
