/* Which strokes run near a place of the page. */
#ifndef LIMNER_STROKE_PIECES_H
#define LIMNER_STROKE_PIECES_H

#include "stroke/stroke_private.h"

#define PIECES_CELL PAPER_UNITS_PER_MM /* what is nearer than this lies in one of nine cells */

/* A piece of a drawn stroke, in each cell that it runs through. */
typedef struct piece {
    uint32_t stroke, point; /* the first of its two points */
    uint32_t next;          /* of its cell, + 1 */
} piece;

typedef struct page_pieces {
    const stroke_set *set;
    double            low[2];
    int               columns, rows;
    uint32_t         *heads; /* per cell: a piece + 1 */
    piece            *items;
    size_t            count, capacity;
} page_pieces;

/* An empty grid over all points of a set. False: out of memory; to be closed all the same. */
bool page_pieces_open(page_pieces *p, const stroke_set *set);
void page_pieces_close(page_pieces *p);
bool page_pieces_put(page_pieces *p, size_t stroke); /* of its set; false: out of memory */

/* A walk over the pieces in the cells around a place; each may come several times. */
typedef struct pieces_walk {
    const page_pieces *pieces;
    int                row, column, cell;
    uint32_t           next;
} pieces_walk;

pieces_walk  pieces_around(const page_pieces *p, const stroke_point *at);
const piece *pieces_walk_next(pieces_walk *w); /* NULL: that was all */

bool piece_is_near(const stroke_point *at, const stroke_point *a, double most); /* … a straight piece from a on */

#endif
