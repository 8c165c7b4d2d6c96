/* Is there room on the GPU for pictures of a size? The driver is asked, by making them. */
#ifndef LIMNER_FRAME_CAPACITY_H
#define LIMNER_FRAME_CAPACITY_H

#include "plan/plan.h"
#include "gpu/gpu.h"

typedef struct capacity_options {
    int  width, height; /* of the picture */
    int  side;          /* samples a pixel along each axis */
    bool maps;          /* its maps are drawn, too */
} capacity_options;

/* The sides alone, which need no plan. Errors: LMN_LIMIT. */
lmn_status capacity_check_sides(gpu *g, int width, int height, int side, lmn_error *error);

/* The pictures that the plan needs at least, in the formats that it needs; those that were made stay in the pool.
 * Errors: LMN_LIMIT, with the largest size that there is room for at these samples. */
lmn_status capacity_check(gpu *g, const plan *p, const capacity_options *options, lmn_error *error);

#endif
