#include "scene/city.h"

#include "scene/scene.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

const char *city_group_name(city_group group)
{
    static const char *const names[] = {"objects", "lods", "surfaces", "skipped", "repaired"};
    return (unsigned)group < CITY_GROUPS ? names[group] : "";
}

static city_count *find(const city_facts *f, city_group group, const char *name)
{
    for (size_t i = 0; i < f->count_count; i++)
        if (f->counts[i].group == group && strcmp(f->counts[i].name, name) == 0)
            return &f->counts[i];
    return NULL;
}

/* Files may invent as many types as they have objects. */
enum { COUNTS_MAX = 512 };

bool city_add(city_facts *f, city_group group, const char *name, uint64_t count)
{
    city_count *there = find(f, group, name);
    if (!there && f->count_count >= COUNTS_MAX)
        return true;
    if (!there) {
        if (!mem_grow((void **)&f->counts, &f->count_capacity, f->count_count + 1, sizeof *f->counts))
            return false;
        there = &f->counts[f->count_count];
        *there = (city_count){.group = group, .name = mem_copy_text(name)};
        if (!there->name)
            return false;
        f->count_count++;
    }
    there->count += count;
    return true;
}

uint64_t city_counted(const city_facts *f, city_group group, const char *name)
{
    const city_count *there = find(f, group, name);
    return there ? there->count : 0;
}

void city_release(city_facts *f)
{
    for (size_t i = 0; i < f->count_count; i++)
        mem_free(f->counts[i].name);
    mem_free(f->counts);
    mem_free(f->crs);
    memset(f, 0, sizeof *f);
}

void city_merge(city_facts *into, city_facts *from)
{
    for (size_t i = 0; i < from->count_count; i++)
        city_add(into, from->counts[i].group, from->counts[i].name, from->counts[i].count);
    if (from->known && !into->known) {
        into->known = true;
        into->geographic = from->geographic;
        into->web = from->web;
        memcpy(into->metres, from->metres, sizeof into->metres);
        memcpy(into->origin, from->origin, sizeof into->origin);
        into->crs = from->crs;
        from->crs = NULL;
    }
}

double city_meridian(double longitude)
{
    return 3 * round(longitude / 3);
}

void city_web_degrees(double p[2])
{
    const double radius = 6378137, degree = 3.14159265358979323846 / 180;
    p[0] = p[0] / radius / degree;
    p[1] = atan(sinh(p[1] / radius)) / degree;
}

/* Krüger 1912, to the fourth order: within a tenth of a millimetre for hundreds of kilometres. */
void city_plane(double longitude, double latitude, double meridian, double out[2])
{
    const double degree = 3.14159265358979323846 / 180, a = 6378137, f = 1 / 298.257223563;
    const double n = f / (2 - f), n2 = n * n, n3 = n2 * n, n4 = n2 * n2;
    const double alpha[] = {n / 2 - 2 * n2 / 3 + 5 * n3 / 16 + 41 * n4 / 180,
                            13 * n2 / 48 - 3 * n3 / 5 + 557 * n4 / 1440, 61 * n3 / 240 - 103 * n4 / 140,
                            49561 * n4 / 161280};
    const double mean = a / (1 + n) * (1 + n2 / 4 + n4 / 64), root = 2 * sqrt(n) / (1 + n);
    /* What lies on the other side of the earth has no place here. */
    double across = fmax(-60, fmin(60, remainder(longitude - meridian, 360))) * degree;
    double sine = sin(fmax(-89.9, fmin(89.9, latitude)) * degree);
    double t = sinh(atanh(sine) - root * atanh(root * sine));
    double north = atan2(t, cos(across)), east = atanh(sin(across) / sqrt(1 + t * t));
    out[0] = east;
    out[1] = north;
    for (int k = 0; k < 4; k++) {
        out[0] += alpha[k] * cos(2 * (k + 1) * north) * sinh(2 * (k + 1) * east);
        out[1] += alpha[k] * sin(2 * (k + 1) * north) * cosh(2 * (k + 1) * east);
    }
    out[0] *= mean;
    out[1] *= mean;
}

bool city_offset(const city_facts *into, const city_facts *from, double out[3])
{
    out[0] = out[1] = out[2] = 0;
    bool alike = into->known && from->known && into->geographic == from->geographic && into->web == from->web &&
                 (!into->crs || !from->crs || strcmp(into->crs, from->crs) == 0);
    if (!alike)
        return false;
    for (int k = 0; k < 3; k++)
        out[k] = (from->origin[k] - into->origin[k]) * city_metres(into, k == 2);
    if (into->geographic) {
        double zero[2], meridian = city_meridian(into->origin[0]);
        city_plane(into->origin[0], into->origin[1], meridian, zero);
        city_plane(from->origin[0], from->origin[1], meridian, out);
        out[0] -= zero[0];
        out[1] -= zero[1];
    }
    return true;
}

/* --- words ---------------------------------------------------------------------------------------------- */

typedef enum word {
    ROOF,
    WALL,
    GROUND,
    CLOSURE,
    CEILING,
    FLOOR,
    WINDOW,
    DOOR,
    INTERIOR,
    WATER,
    ROAD,
    RAIL,
    VERGE,
    PLANT,
    LAND,
    TERRAIN,
    FURNITURE,
    PERSON,
    VEHICLE,
    BRIDGE,
    TUNNEL,
    WORDS
} word;

/* What surfaces are, and what they are called. */
#define WORD_LIST(DO)                                                                                                  \
    DO(ROOF, "roof")                                                                                                   \
    DO(WALL, "wall")                                                                                                   \
    DO(GROUND, "ground")                                                                                               \
    DO(CLOSURE, "closure")                                                                                             \
    DO(CEILING, "ceiling")                                                                                             \
    DO(FLOOR, "floor")                                                                                                 \
    DO(WINDOW, "window")                                                                                               \
    DO(DOOR, "door")                                                                                                   \
    DO(INTERIOR, "interior")                                                                                           \
    DO(WATER, "water")                                                                                                 \
    DO(ROAD, "road")                                                                                                   \
    DO(RAIL, "rail")                                                                                                   \
    DO(VERGE, "verge")                                                                                                 \
    DO(PLANT, "plant")                                                                                                 \
    DO(LAND, "land")                                                                                                   \
    DO(TERRAIN, "terrain")                                                                                             \
    DO(FURNITURE, "furniture")                                                                                         \
    DO(PERSON, "person")                                                                                               \
    DO(VEHICLE, "vehicle")                                                                                             \
    DO(BRIDGE, "bridge")                                                                                               \
    DO(TUNNEL, "tunnel")

#define NAMED(word, name) [word] = name,
const char *const city_words[] = {WORD_LIST(NAMED)[WORDS] = NULL};
#undef NAMED

const size_t city_word_count = WORDS;

static const struct {
    const char *name;
    uint8_t     word;
} classes[] = {
    {"RoofSurface", ROOF},
    {"WallSurface", WALL},
    {"GroundSurface", GROUND},
    {"ClosureSurface", CLOSURE},
    {"OuterCeilingSurface", CEILING},
    {"OuterFloorSurface", FLOOR},
    {"Window", WINDOW},
    {"WindowSurface", WINDOW},
    {"Door", DOOR},
    {"DoorSurface", DOOR},
    {"InteriorWallSurface", INTERIOR},
    {"CeilingSurface", INTERIOR},
    {"FloorSurface", INTERIOR},
    {"WaterSurface", WATER},
    {"WaterGroundSurface", WATER},
    {"WaterClosureSurface", CLOSURE},
    {"WaterBody", WATER},
    {"Waterway", WATER},
    {"TrafficArea", ROAD},
    {"TrafficSpace", ROAD},
    {"TransportationMarking", ROAD},
    {"Road", ROAD},
    {"TransportSquare", ROAD},
    {"Square", ROAD},
    {"Track", ROAD},
    {"TransportationComplex", ROAD},
    {"TransportationHole", ROAD},
    {"AuxiliaryTrafficArea", VERGE},
    {"AuxiliaryTrafficSpace", VERGE},
    {"Railway", RAIL},
    {"PlantCover", PLANT},
    {"SolitaryVegetationObject", PLANT},
    {"LandUse", LAND},
    {"TINRelief", TERRAIN},
    {"ReliefFeature", TERRAIN},
    {"MassPointRelief", TERRAIN},
    {"BreaklineRelief", TERRAIN},
    {"RasterRelief", TERRAIN},
    {"CityFurniture", FURNITURE},
    {"Person", PERSON},
    {"Vehicle", VEHICLE},
    {"Bridge", BRIDGE},
    {"BridgePart", BRIDGE},
    {"BridgeInstallation", BRIDGE},
    {"BridgeConstructiveElement", BRIDGE},
    {"BridgeConstructionElement", BRIDGE},
    {"Tunnel", TUNNEL},
    {"TunnelPart", TUNNEL},
    {"TunnelInstallation", TUNNEL},
};

uint8_t city_word_of_class(const char *name, size_t size)
{
    if (size && *name == '+') { /* of an extension of CityJSON, which builds on the class it is called like */
        name++;
        size--;
    }
    for (size_t i = 0; i < sizeof classes / sizeof *classes; i++)
        if (strlen(classes[i].name) == size && memcmp(classes[i].name, name, size) == 0)
            return classes[i].word;
    return CITY_NO_WORD;
}

/* A list for each word, for all nodes of surfaces that there ever are. */
#define FACT(word, name) [word] = {CITY_SURFACE_KEY, name},
static const attribute surface_facts[] = {WORD_LIST(FACT)[WORDS] = {CITY_SURFACE_KEY, "other"}};
#undef FACT

void city_lend_facts(node *n, uint8_t word)
{
    const bool known = word < WORDS;
    n->name = surface_facts[known ? word : WORDS].value;
    n->attributes = known ? (attribute *)&surface_facts[word] : NULL;
    n->attribute_count = known;
    n->lent = true;
}

bool node_is_surface(const node *n)
{
    for (size_t i = 0; i < n->attribute_count; i++)
        if (strcmp(n->attributes[i].key, CITY_SURFACE_KEY) == 0 && n->attributes[i].value && n->name)
            return strcmp(n->attributes[i].value, n->name) == 0;
    return false;
}
