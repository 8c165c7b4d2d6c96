/* Inside the import folder: what can be said of a coordinate system by its name alone. */
#ifndef LIMNER_IMPORT_CITY_CRS_H
#define LIMNER_IMPORT_CITY_CRS_H

#include "scene/city.h"

/* Is it one of degrees (EPSG:4326, EPSG:6697, CRS84 …), and can these bounds be degrees? *latitude_first: the first
 * coordinate is the latitude, as EPSG has it. `name` may be NULL. */
bool city_crs_is_geographic(const char *name, const double low[3], const double high[3], bool *latitude_first);

/* A position of the file as the scene has it: less the origin; degrees become metres east and north of the origin, by
 * the lengths that a degree has there (equirectangular: 1 km away it is 1 cm off at latitude 35). */
void city_crs_local(const city_facts *facts, bool latitude_first, double p[3]);

#endif
