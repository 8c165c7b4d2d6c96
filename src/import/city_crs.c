#include "import/city_crs.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "import/city_units.h"

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

/* Of a compound system that is named by its parts the last one, which is of heights; 0: there is none. */
static long height_code(const char *name)
{
    const char *at = name ? strpbrk(name, ",+") : NULL;
    long        found = 0;
    for (; at; at = strpbrk(at + 1, ",+"))
        found = epsg_code(at + 1);
    return found;
}

/* Mercator's of the web, whose metres are none: EPSG:3857 and what it was called before. */
static bool is_web_code(long code)
{
    return code == 3857 || code == 3785 || code == 900913 || code == 102100 || code == 102113;
}

/* EPSG gives its systems numbers from 1024 on, and has none beyond 32767; 900913 and 102100 are others' for 3857. */
bool city_crs_is_known(const char *name)
{
    const long code = epsg_code(name);
    return strstr(name, "CRS84") != NULL || (code >= 1024 && code <= 32767) || is_web_code(code);
}

static bool is_geographic(const char *name, const double low[3], const double high[3], bool *latitude_first)
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

void city_crs_understand(city_facts *facts, const char *name, double low[3], double high[3], bool *latitude_first)
{
    long code = name ? epsg_code(name) : 0, height = height_code(name);
    bool turned;
    facts->geographic = is_geographic(name, low, high, &turned);
    turned = turned && latitude_first;
    if (latitude_first)
        *latitude_first = turned;
    facts->web = !facts->geographic && is_web_code(code);
    if (facts->geographic) {
        facts->metres[0] = facts->metres[1] = 1;
    } else {
        city_units(code, facts->metres);
    }
    if (height) {
        double other[2];
        city_units(height, other);
        facts->metres[1] = other[1];
    }
    double *ends[] = {low, high};
    for (int i = 0; i < 2 && (facts->web || turned); i++) {
        if (facts->web) {
            city_web_degrees(ends[i]);
        } else {
            double kept = ends[i][0];
            ends[i][0] = ends[i][1];
            ends[i][1] = kept;
        }
    }
    facts->geographic = facts->geographic || facts->web;
}

void city_crs_plane_name(const char *name, char *out, size_t size)
{
    long code = name ? epsg_code(name) : 0;
    if (code > 0)
        snprintf(out, size, "EPSG:%ld", code);
    else
        snprintf(out, size, "%s", name ? name : "");
}

void city_crs_local(const city_facts *facts, bool latitude_first, double p[3])
{
    if (facts->geographic) {
        double at[2] = {latitude_first ? p[1] : p[0], latitude_first ? p[0] : p[1]}, zero[2], here[2];
        if (facts->web)
            city_web_degrees(at);
        city_plane(facts->origin[0], facts->origin[1], city_meridian(facts->origin[0]), zero);
        city_plane(at[0], at[1], city_meridian(facts->origin[0]), here);
        p[0] = here[0] - zero[0];
        p[1] = here[1] - zero[1];
        p[2] = (p[2] - facts->origin[2]) * city_metres(facts, 1);
        return;
    }
    for (int k = 0; k < 3; k++)
        p[k] = (p[k] - facts->origin[k]) * city_metres(facts, k == 2);
}
