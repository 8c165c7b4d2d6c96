/* Flat pieces of a surface: what hangs together in one plane. Triangles are collected into pieces by their normals. A
 * piece is a plane when what lies beside it without a crease is small, as bevels and roundings are: facets of what is
 * round have neighbours like themselves. */
#ifndef LIMNER_SCENE_FLAT_PIECES_H
#define LIMNER_SCENE_FLAT_PIECES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Triangles, half-edges 3 t … 3 t + 2 each. */
typedef struct flat_triangles {
    uint32_t count;
    const double (*normals)[3]; /* unit; 0: without an area, goes along with any */
    const double   *areas;
    const double   *lengths;  /* of half-edges */
    const uint32_t *opposite; /* of half-edges: the one on the other side, UINT32_MAX at creases and borders */
} flat_triangles;

typedef struct flat_piece {
    double   normal[3], area, rim, beside; /* beside: of the rim, beside neighbours that are alike */
    uint32_t first, count;                 /* triangles: members[first] … */
} flat_piece;

typedef struct flat_pieces {
    uint32_t   *of, *members; /* per triangle: its piece; triangles, piece by piece */
    flat_piece *items;
    size_t      count, capacity;
} flat_pieces;

/* False when memory is gone or work is to stop; release it in any case. */
bool flat_pieces_find(flat_pieces *out, const flat_triangles *t);
void flat_pieces_release(flat_pieces *p);
bool flat_piece_is_plane(const flat_piece *piece);

#endif
