/* Inside the import folder: streets that are populated: people on pavements, cars in lanes and at kerbs, lamps, trees.
 * By chance that depends on the file's order alone, so that a file always gives the same street; nothing stands in
 * anything else. */
#ifndef LIMNER_IMPORT_STREET_H
#define LIMNER_IMPORT_STREET_H

#include "import/props.h"
#include "import/terrain.h"

typedef struct street street;

street *street_new(void); /* NULL without memory */
void    street_free(street *s);

/* A line of a road, on which cars go or not. */
bool street_add_road(street *s, const double (*positions)[2], size_t count, double width, bool cars);
/* A closed ring that nothing stands in, of a building or of water. */
bool street_add_obstacle(street *s, const double (*ring)[2], size_t count);
/* Something that the file itself has put somewhere. */
bool street_add_thing(street *s, double x, double y, double radius);

/* Adds a node for each kind of thing, with all of them as its instances. */
lmn_status street_populate(street *s, city_builder *b, double density);

#endif
