/* MBTiles: a pyramid in one SQLite file. */
#ifndef LIMNER_CLI_MBTILES_H
#define LIMNER_CLI_MBTILES_H

#include <jansson.h>

#include "pyramid.h"

/* Can this build of the command write them? */
bool mbtiles_possible(void);
bool mbtiles_is_name(const char *path);

/* Packs the tiles of a folder, which must all be there; `facts` is what tiles.json says. The file appears whole or not
 * at all. Prints what goes wrong; exit status. */
int mbtiles_pack(const char *path, const pyramid *p, const json_t *facts);

#endif
