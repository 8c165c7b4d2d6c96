/* A pyramid of tiles: at zoom z the picture is a square of 2^z by 2^z tiles, numbered from its upper left corner. It is
 * drawn in blocks, windows of that picture which hold many tiles. */
#ifndef LIMNER_CLI_PYRAMID_H
#define LIMNER_CLI_PYRAMID_H

#include <stdbool.h>

#include "limner/limner.h"

enum { ZOOM_MOST = 20, TILE_PATH = 4096, BLOCK_SIDE = 2048 };

typedef struct pyramid {
    const char *folder;
    int         tile;        /* pixels a side */
    int         first, last; /* zooms */
} pyramid;

/* A square of tiles of one zoom. */
typedef struct tile_block {
    int zoom, x, y; /* of its first tile */
    int side;       /* tiles */
} tile_block;

/* "A:B" or "A". Prints what is wrong; exit status. */
int pyramid_parse_zoom(const char *text, pyramid *out);
/* Pixels a side of the whole picture. */
long pyramid_page(const pyramid *p, int zoom);

/* Blocks by number, the finest zoom first, so that a picture too large for the driver is told at once. */
long       pyramid_block_count(const pyramid *p);
tile_block pyramid_block_at(const pyramid *p, long index);
long       pyramid_tile_count(const pyramid *p);

/* FOLDER/z/x/y.png. False when the path is too long. */
bool pyramid_path(const pyramid *p, int zoom, int x, int y, char out[TILE_PATH]);
/* Is the tile there, whole? */
bool pyramid_has(const pyramid *p, int zoom, int x, int y);
bool pyramid_has_block(const pyramid *p, const tile_block *b);

/* Writes the tiles of a block that is drawn; those that are there already only where `again`. Prints what goes wrong;
 * exit status. */
int pyramid_store(const pyramid *p, const tile_block *b, const lmn_drawing *drawing, bool again);

/* Makes a folder and those above it. Prints what goes wrong; exit status. */
int make_folders(const char *path);

#endif
