/* The buildings of a town: what stands on each lot, and the pieces that it is put together from. Everything follows
 * from the lot's number. */
#ifndef EXAMPLES_BLOCKS_H
#define EXAMPLES_BLOCKS_H

#include "solid.h"

/* Blocks lie in rows along a street that runs to −z, one on either side; each has four lots on the street, three
 * behind them, and three across the lane behind those. */
enum {
    ROWS = 5,
    SIDES = 2,
    FRONT_LOTS = 4,
    BACK_LOTS = 3,
    OUTER_LOTS = 3,
    LOTS = FRONT_LOTS + BACK_LOTS + OUTER_LOTS,
    BUILDINGS = ROWS * SIDES * LOTS
};

#define BLOCK_LENGTH 46.0
#define CROSS_STREET 10.0
#define STREET_HALF  8.0 /* to the fronts */
#define BLOCK_DEPTH  28.0
#define LANE         9.0
#define OUTER_DEPTH  18.0

typedef enum roof_shape { ROOF_FLAT, ROOF_EAVES, ROOF_GABLE, ROOF_STEPPED, ROOF_MANSARD, ROOF_TOWER } roof_shape;

/* In its own frame a building's front stands on z = 0 and looks to +z, from x = 0 to x = width. */
typedef struct building {
    double     x, z, degrees; /* where that frame lies in the town */
    double     width, depth;
    int        floors, detail;        /* 2: drawn from near by, 0: from afar */
    bool       left_free, right_free; /* sides that are seen */
    roof_shape roof;
    uint32_t   seed;
} building;

building building_of(int index);
double   row_start(int row); /* z of a block's near end */

void build_walls(mesh *m, int index);
void build_roofs(mesh *m, int block); /* of all buildings of a row on one side */
void build_windows(mesh *m, int block);

#endif
