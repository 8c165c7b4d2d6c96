/* Inside the import folder: what can be said of a coordinate system by its name alone. */
#ifndef LIMNER_IMPORT_CITY_CRS_H
#define LIMNER_IMPORT_CITY_CRS_H

#include "scene/city.h"

/* What positions of this system (EPSG:4326, urn:ogc:def:crs:EPSG::2263 …; NULL: unknown) are: of degrees, as these
 * bounds may be; in feet; Mercator's of the web. Bounds of degrees are turned to longitude first. *latitude_first: the
 * first coordinate is the latitude, as EPSG has it; NULL: it never is. */
void city_crs_understand(city_facts *facts, const char *name, double low[3], double high[3], bool *latitude_first);

/* A position of the file as the scene has it: metres from the origin. Degrees are projected by Gauss and Krüger's
 * transverse Mercator on the nearest third meridian: within a two thousandth of true lengths, and one plane for
 * all files whose origins have the same one. */
void city_crs_local(const city_facts *facts, bool latitude_first, double p[3]);

/* What PROJ may call the system of the plane: "EPSG:28992" of "urn:ogc:def:crs,crs:EPSG::28992,crs:EPSG::5709"; "":
 * unknown. */
void city_crs_plane_name(const char *name, char *out, size_t size);

/* Can what is called like this be a system of EPSG's register, or is it CRS84? */
bool city_crs_is_known(const char *name);

#endif
