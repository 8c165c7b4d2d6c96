/* Inside the import folder: units of coordinate systems. */
#ifndef LIMNER_IMPORT_CITY_UNITS_H
#define LIMNER_IMPORT_CITY_UNITS_H

#include <stddef.h>
#include <stdint.h>

/* Metres of the unit that positions in the plane, and heights, have in EPSG's system of this code: 1 where it is not in
 * feet, or not known. */
void city_units(long code, double metres[2]);

#endif
