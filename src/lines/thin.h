/* Thinning: ink of any width becomes lines of one pixel that are connected as the ink was. No GL, only arrays. */
#ifndef LIMNER_LINES_THIN_H
#define LIMNER_LINES_THIN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CELL_INK = 1, CELL_THIN = 2 }; /* flags of a cell; whoever has the grid may use others, from 8 on */

/* A picture with a border of one empty cell. */
typedef struct thin_grid {
    uint8_t  *cells;  /* (width + 2) · (height + 2) */
    uint32_t *pixels; /* cells that are CELL_THIN, by rows */
    size_t    count;
    int       width, height, stride;
    int       around[8]; /* distances to the eight neighbours in `cells`, once around */
} thin_grid;

/* How many of the eight are CELL_THIN. */
int thin_degree(const thin_grid *g, uint32_t cell);

/* Ink (not 0 = ink), not thinned yet. False when memory is gone. */
bool thin_create(thin_grid *out, const uint8_t *ink, int width, int height);
void thin_release(thin_grid *g);

/* Removes cells from the outside in, as long as no line breaks and no end gets shorter. May be called again after
 * cells have been removed by hand. False when memory is gone. */
bool thin_run(thin_grid *g);

#endif
