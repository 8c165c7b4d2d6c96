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
        memcpy(into->origin, from->origin, sizeof into->origin);
        into->crs = from->crs;
        from->crs = NULL;
    }
}

void city_degree(double latitude, double metres[2])
{
    const double a = 6378137, e2 = 0.00669437999014132, degree = 3.14159265358979323846 / 180;
    double       sine = sin(latitude * degree), w = 1 - e2 * sine * sine;
    metres[0] = degree * cos(latitude * degree) * a / sqrt(w);
    metres[1] = degree * a * (1 - e2) / (w * sqrt(w));
}

bool city_offset(const city_facts *into, const city_facts *from, double out[3])
{
    out[0] = out[1] = out[2] = 0;
    bool alike = into->known && from->known && into->geographic == from->geographic &&
                 (!into->crs || !from->crs || strcmp(into->crs, from->crs) == 0);
    if (!alike)
        return false;
    double scale[2] = {1, 1};
    if (into->geographic)
        city_degree(into->origin[1], scale);
    for (int k = 0; k < 3; k++)
        out[k] = (from->origin[k] - into->origin[k]) * (k < 2 ? scale[k] : 1);
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
    BRIDGE,
    TUNNEL,
    WORDS
} word;

const char *const city_words[] = {
    [ROOF] = "roof",           [WALL] = "wall",     [GROUND] = "ground", [CLOSURE] = "closure",
    [CEILING] = "ceiling",     [FLOOR] = "floor",   [WINDOW] = "window", [DOOR] = "door",
    [INTERIOR] = "interior",   [WATER] = "water",   [ROAD] = "road",     [RAIL] = "rail",
    [VERGE] = "verge",         [PLANT] = "plant",   [LAND] = "land",     [TERRAIN] = "terrain",
    [FURNITURE] = "furniture", [BRIDGE] = "bridge", [TUNNEL] = "tunnel", [WORDS] = NULL};

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

bool node_is_surface(const node *n)
{
    for (size_t i = 0; i < n->attribute_count; i++)
        if (strcmp(n->attributes[i].key, CITY_SURFACE_KEY) == 0 && n->attributes[i].value && n->name)
            return strcmp(n->attributes[i].value, n->name) == 0;
    return false;
}
