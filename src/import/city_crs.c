#include "import/city_crs.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Codes of EPSG's register whose coordinates are latitude and longitude; between 4000 and 4999 nearly all are. */
static bool is_geographic_code(long code)
{
    static const long others[] = {6318, 6319, 6667, 6668, 6696, 6697, 6706, 6783,
                                  7843, 7844, 7911, 7912, 9000, 9057, 9518};
    static const long geocentric[] = {4328, 4936, 4978, 4896, 4919, 4920, 4556, 4882, 4884, 4906, 4920};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (others[i] == code)
            return true;
    for (size_t i = 0; i < sizeof geocentric / sizeof *geocentric; i++)
        if (geocentric[i] == code)
            return false;
    return code >= 4000 && code < 5000;
}

/* The number at the end of "urn:ogc:def:crs:EPSG::6697", "…/EPSG/0/7415", "EPSG:28992"; compound ones name the plane
 * first: "urn:ogc:def:crs,crs:EPSG::4326,crs:EPSG::5773". */
static long epsg_code(const char *name)
{
    const char *at = strstr(name, "EPSG");
    if (!at)
        at = strstr(name, "epsg");
    if (!at)
        return 0;
    at += 4;
    long found = 0;
    while (*at && *at != ',' && *at != '+') {
        if (isdigit((unsigned char)*at)) {
            char *behind;
            found = strtol(at, &behind, 10);
            at = behind;
        } else {
            at++;
        }
    }
    return found;
}

bool city_crs_is_geographic(const char *name, const double low[3], const double high[3], bool *latitude_first)
{
    *latitude_first = false;
    if (!name)
        return false;
    bool crs84 = strstr(name, "CRS84") != NULL;
    if (!crs84 && !is_geographic_code(epsg_code(name)))
        return false;
    bool degrees = true, latitude = true;
    for (int k = 0; k < 2; k++)
        degrees = degrees && low[k] >= -360 && high[k] <= 360;
    latitude = low[0] >= -90 && high[0] <= 90;
    bool longitude_first = low[1] >= -90 && high[1] <= 90;
    *latitude_first = latitude && (!crs84 || !longitude_first);
    return degrees && (latitude || longitude_first);
}

void city_crs_local(const city_facts *facts, bool latitude_first, double p[3])
{
    if (facts->geographic) {
        double scale[2], longitude = latitude_first ? p[1] : p[0], latitude = latitude_first ? p[0] : p[1];
        city_degree(facts->origin[1], scale);
        p[0] = (longitude - facts->origin[0]) * scale[0];
        p[1] = (latitude - facts->origin[1]) * scale[1];
        p[2] -= facts->origin[2];
        return;
    }
    for (int k = 0; k < 3; k++)
        p[k] -= facts->origin[k];
}
