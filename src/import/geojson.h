/* Inside the import folder: what the properties of a GeoJSON feature say that it is. */
#ifndef LIMNER_IMPORT_GEOJSON_H
#define LIMNER_IMPORT_GEOJSON_H

#include "import/footprint.h"
#include "import/json_scan.h"
#include "import/props.h"

typedef struct geojson_thing {
    const char *type;                             /* class of CityGML: "Building", "Road" … */
    bool        is_building, is_nothing, guessed; /* guessed: nobody says how high it is */
    bool        limited;                          /* a height is more than anything's, and was cut off */
    bool        other_roof;                       /* its roof's form is none that is drawn, and another one is */
    double      rise;                             /* of roads: as much over the others that they cross, m */
    double      width;                            /* of lines, m */
    bool        is_part;                          /* of a building, which another feature is the outline of */
    bool        cars;                             /* of roads: they are for cars */
    prop_kind   prop;                             /* of points */
    double      heading;                          /* of points: radians from east, anticlockwise */
    footprint   body;                             /* heights over the ground; of trees `ridge` */
} geojson_thing;

/* The bytes of the first of these properties (NULL at the end) that is there, without quotes; at NULL: none is. */
json_span geojson_property(json_span properties, const char *const *keys);

void geojson_understand(geojson_thing *out, json_span properties, bool point, bool line);

#endif
