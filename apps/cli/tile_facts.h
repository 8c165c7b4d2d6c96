/* What a folder of tiles says about itself: tiles.json (TileJSON 3), which also tells whether a run goes on with the
 * drawing that is there; and a page to look at it with. */
#ifndef LIMNER_CLI_TILE_FACTS_H
#define LIMNER_CLI_TILE_FACTS_H

#include <jansson.h>

#include "options.h"
#include "pyramid.h"

/* All that makes the tiles what they are. */
typedef struct tile_drawing {
    const lmn_look      *look;
    const lmn_draw_desc *desc;
    const word_list     *inputs, *defines;
    int                  up_axis;
} tile_drawing;

/* Prints what goes wrong; exit status. The caller gives the object back. */
int tile_facts_make(json_t **out, const pyramid *p, const tile_drawing *drawing);
/* Refuses a folder that holds tiles of another drawing; else writes tiles.json, which keeps the zooms that are there,
 * and with `page` index.html. */
int tile_facts_store(json_t *facts, const pyramid *p, bool page);
/* Removes the tiles, tiles.json, and the folders that are empty then. */
void tile_folder_remove(const pyramid *p);

extern const char tile_page[];

#endif
