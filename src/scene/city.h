/* What is known of a scene that came from city data: where it lies, what it consists of, what had to be left out. And
 * the words for what surfaces of a city are, which the formats' class names become and selectors ask for: @roof. */
#ifndef LIMNER_SCENE_CITY_H
#define LIMNER_SCENE_CITY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum city_group { CITY_OBJECTS, CITY_LODS, CITY_SURFACES, CITY_SKIPPED, CITY_REPAIRED, CITY_GROUPS } city_group;

typedef struct city_count {
    city_group group;
    char      *name;
    uint64_t   count;
} city_count;

/* Coordinates of the scene are metres east, north and up from `origin`, which is in the file's unit; of a geographic
 * system (degrees) it is longitude, latitude and height. */
typedef struct city_facts {
    bool        known; /* the scene has a place on earth */
    bool        geographic;
    bool        web;       /* geographic, but the file has Mercator's projection of it */
    double      metres[2]; /* of the file's unit in the plane, and of its heights; 0: one */
    double      origin[3];
    double      low[2], high[2]; /* of what the file has, in coordinates of the scene */
    char       *crs;             /* as the file calls it; NULL: it does not say */
    city_count *counts;
    size_t      count_count, count_capacity;
} city_facts;

/* Adds to a count; false when memory is gone. */
bool city_add(city_facts *f, city_group group, const char *name, uint64_t count);
/* What was counted; 0: nothing. */
uint64_t    city_counted(const city_facts *f, city_group group, const char *name);
const char *city_group_name(city_group group);
void        city_release(city_facts *f);

/* Takes what `from` counted, and its place where `into` has none. A count for which there is no memory is dropped, as a
 * warning is. */
void city_merge(city_facts *into, city_facts *from);
/* Where the origin of `from` lies in coordinates of `into`: x, y, z with z up. False: nobody knows, or their systems
 * differ; then all 0. */
bool city_offset(const city_facts *into, const city_facts *from, double out[3]);
/* Metres east of a meridian and north of the equator (transverse Mercator, true on the meridian, on the ellipsoid of
 * WGS 84), of a longitude and latitude in degrees; and the meridian that is taken around a longitude. */
void   city_plane(double longitude, double latitude, double meridian, double out[2]);
double city_meridian(double longitude);
/* Mercator's projection of the web to longitude and latitude. */
void                 city_web_degrees(double p[2]);
static inline double city_metres(const city_facts *f, int of_heights)
{
    return f->metres[of_heights] > 0 ? f->metres[of_heights] : 1;
}

/* "roof", "wall" …, NULL at the end. */
extern const char *const city_words[];
extern const size_t      city_word_count;
enum { CITY_NO_WORD = 0xFF };
/* The number of a class name, such as "RoofSurface" or "WaterBody", in city_words; CITY_NO_WORD: none. */
uint8_t city_word_of_class(const char *name, size_t size);

/* The attribute that holds the word. */
#define CITY_SURFACE_KEY "surface"

/* Names a node after a kind of surface and says that it is one; CITY_NO_WORD: "other". The node has neither a name nor
 * attributes yet, and they are lent. */
struct node;
void city_lend_facts(struct node *n, uint8_t word);

#endif
