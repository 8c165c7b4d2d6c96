/* Inside the import folder: what stands in streets and gives them scale: people, cars, lamps, benches, trees. Made
 * here, in metres; row C03, C14. */
#ifndef LIMNER_IMPORT_PROPS_H
#define LIMNER_IMPORT_PROPS_H

#include "import/footprint.h"

typedef enum prop_kind {
    PROP_PERSON,
    PROP_WALKER,
    PROP_CHILD,
    PROP_CAR,
    PROP_VAN,
    PROP_BUS,
    PROP_CYCLIST,
    PROP_LAMP,
    PROP_BENCH,
    PROP_BIN,
    PROP_BOLLARD,
    PROP_BROAD_TREE, /* trees are 1 high */
    PROP_NEEDLE_TREE,
    PROP_LINE_TREE, /* of lines alone: trunk, branches, twigs */
    PROPS
} prop_kind;

/* "Person", "Vehicle", "CityFurniture" or "SolitaryVegetationObject". */
const char *prop_class(prop_kind kind);
/* How much room it takes: circles of this radius, so many in a row along x, so far apart. */
typedef struct prop_room {
    double radius, apart;
    int    circles;
} prop_room;
prop_room prop_room_of(prop_kind kind);

/* Its mesh, on the ground at 0, looking along +x. */
lmn_status prop_make(city_builder *b, prop_kind kind, city_meshes *out);

#endif
