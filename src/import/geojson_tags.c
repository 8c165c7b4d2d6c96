/* Heights, roofs and classes from properties. Of OpenStreetMap: the wiki's pages "Simple 3D Buildings" (height,
 * min_height, building:levels, roof:shape, roof:height, roof:levels) and "Map features". */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/geojson.h"

#define STOREY  3.0    /* m, as Simple 3D Buildings takes it */
#define HIGHEST 5000.0 /* m */

json_span geojson_property(json_span properties, const char *const *keys)
{
    json_span found = {NULL, 0};
    size_t    best = (size_t)-1;
    if (!properties.at || properties.at[0] != '{')
        return found;
    json_scan s = scan_of(properties);
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s);
        bool      text = scan_peek(&s) == '"', null = scan_null(&s);
        json_span value = null ? (json_span){NULL, 0} : text ? scan_string(&s) : scan_skip(&s);
        for (size_t i = 0; keys[i] && i < best && value.at && value.size; i++)
            if (span_is(key, keys[i])) {
                found = value;
                best = i;
            }
    }
    return found;
}

static json_span property(json_span properties, const char *key)
{
    const char *const keys[] = {key, NULL};
    return geojson_property(properties, keys);
}

/* Metres; a unit behind it is left out, but for feet. NAN: none is said. */
static double number_of(json_span value)
{
    char   text[32], *end;
    size_t size = value.size < sizeof text - 1 ? value.size : sizeof text - 1;
    if (!value.at)
        return NAN;
    memcpy(text, value.at, size);
    text[size] = '\0';
    double number = strtod(text, &end);
    if (end == text || !isfinite(number))
        return NAN;
    while (*end == ' ')
        end++;
    return *end == '\'' || strcmp(end, "ft") == 0 ? number * 0.3048 : number;
}

static bool is_among(json_span value, const char *const *words)
{
    for (size_t i = 0; value.at && words[i]; i++)
        if (span_is(value, words[i]))
            return true;
    return false;
}

/* `other`: it is drawn as another form, or as none. */
static roof_form roof_of(json_span shape, bool *other)
{
    static const struct {
        const char *word;
        roof_form   form;
        bool        other;
    } rows[] = {{"flat", ROOF_FLAT, false},           {"gabled", ROOF_GABLED, false},
                {"hipped", ROOF_HIPPED, false},       {"half-hipped", ROOF_HIPPED, true},
                {"half_hipped", ROOF_HIPPED, true},   {"side_hipped", ROOF_HIPPED, true},
                {"saltbox", ROOF_GABLED, true},       {"double_saltbox", ROOF_GABLED, true},
                {"pyramidal", ROOF_PYRAMIDAL, false}, {"cone", ROOF_PYRAMIDAL, false},
                {"mansard", ROOF_MANSARD, false},     {"mansard-flat", ROOF_MANSARD_FLAT, false},
                {"gambrel", ROOF_GAMBREL, false},     {"skillion", ROOF_SKILLION, false},
                {"lean_to", ROOF_SKILLION, false},    {"dome", ROOF_DOME, false},
                {"onion", ROOF_ONION, false}};
    *other = false;
    for (size_t i = 0; shape.at && i < sizeof rows / sizeof *rows; i++)
        if (span_is(shape, rows[i].word)) {
            *other = rows[i].other;
            return rows[i].form;
        }
    *other = shape.at && shape.size;
    return ROOF_FLAT;
}

/* Degrees from north, or a wind: N, NNE, NE … */
static void read_direction(footprint *body, json_span value)
{
    static const char *const winds[] = {"N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE",
                                        "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW"};
    double                   degrees = number_of(value);
    for (int i = 0; i < 16; i++)
        if (value.at && span_is(value, winds[i]))
            degrees = 22.5 * i;
    body->has_direction = isfinite(degrees);
    body->direction = body->has_direction ? degrees * 0.017453292519943295 : 0;
}

/* In units of so many metres; what reaches higher than anything stands is cut off there. */
static double height_of(json_span value, double unit, geojson_thing *out)
{
    double number = number_of(value);
    bool   limited = number * unit > HIGHEST;
    out->limited = out->limited || limited;
    return limited ? HIGHEST / unit : number;
}

static void understand_building(geojson_thing *out, json_span properties)
{
    static const char *const heights[] = {"height", "building:height", "measuredHeight", "Height", "HEIGHT", NULL};
    static const char *const storeys[] = {"building:levels", "storeysAboveGround", "levels", "num_floors", NULL};
    static const char *const bases[] = {"min_height", "building:min_height", NULL};
    double                   high = height_of(geojson_property(properties, heights), 1, out),
           levels = height_of(geojson_property(properties, storeys), STOREY, out),
           base = height_of(geojson_property(properties, bases), 1, out),
           roof = height_of(property(properties, "roof:height"), 1, out),
           roof_levels = height_of(property(properties, "roof:levels"), STOREY, out);
    json_span part = property(properties, "building:part");
    out->type = part.at ? "BuildingPart" : "Building";
    out->is_part = part.at && !span_is(part, "no");
    out->is_building = true;
    out->body.roof = roof_of(property(properties, "roof:shape"), &out->other_roof);
    read_direction(&out->body, property(properties, "roof:direction"));
    if (!(roof > 0))
        roof = out->body.roof == ROOF_FLAT ? 0 : roof_levels > 0 ? roof_levels * STOREY : STOREY;
    out->guessed = !(high > 0) && !(levels > 0);
    /* A stated height is that of the roof's top; storeys end at the eaves. */
    double eaves = high > 0 ? fmax(high - roof, 0.3 * high) : (levels > 0 ? levels : 2) * STOREY;
    out->body.base = base > 0 ? base : 0;
    out->body.eaves = fmax(eaves, out->body.base + 0.1);
    out->body.ridge = out->body.roof == ROOF_FLAT && high > 0 ? fmax(high, out->body.eaves)
                                                              : out->body.eaves + (high > 0 ? high - eaves : roof);
}

static double width_of_road(json_span kind)
{
    static const struct {
        const char *kind;
        double      metres;
    } rows[] = {{"motorway", 14},   {"trunk", 12},  {"primary", 11},      {"secondary", 9}, {"tertiary", 8},
                {"residential", 6}, {"service", 4}, {"footway", 2},       {"path", 1.5},    {"cycleway", 2.5},
                {"pedestrian", 5},  {"steps", 2},   {"living_street", 5}, {"track", 3}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (span_is(kind, rows[i].kind))
            return rows[i].metres;
    return 5;
}

/* Wider ways lie over narrower ones, rails over all, by so little that crossings have one outline all the same
 * (crossings.h): two colours at one height would flicker. */
static double rise_of_way(double width, bool rail)
{
    const double STEP = 0.004, LIMIT = 9; /* m */
    return STEP * (rail ? LIMIT + 1 : fmin(fmax(floor(width / 1.5), 0), LIMIT));
}

/* What lies on the ground: a little higher each, so that none flickers through another. */
static void understand_ground(geojson_thing *out, json_span properties, bool line)
{
    static const char *const waters[] = {"water", "bay", "reservoir", "basin", "riverbank", NULL};
    static const char *const greens[] = {
        "park",    "garden",     "pitch",    "golf_course",       "playground",    "grass", "forest", "meadow",
        "orchard", "vineyard",   "cemetery", "recreation_ground", "village_green", "wood",  "scrub",  "grassland",
        "heath",   "allotments", NULL};
    static const char *const paths[] = {"footway", "path",      "cycleway", "pedestrian", "steps",
                                        "track",   "bridleway", "corridor", NULL};
    json_span                natural = property(properties, "natural"), landuse = property(properties, "landuse"),
              leisure = property(properties, "leisure"), way = property(properties, "highway"),
              rail = property(properties, "railway"), stream = property(properties, "waterway");
    json_span tunnel = property(properties, "tunnel");
    double    wide = number_of(property(properties, "width"));
    if (way.at || rail.at) {
        out->type = rail.at ? "Railway" : "Road";
        out->width = wide > 0 ? wide : rail.at ? 3.5 : width_of_road(way);
        out->is_nothing = tunnel.at && !span_is(tunnel, "no");
        out->cars = way.at && !is_among(way, paths);
        out->body.base = 0.06;
        out->rise = rise_of_way(out->width, rail.at != NULL);
    } else if (stream.at || is_among(natural, waters) || is_among(landuse, waters) ||
               property(properties, "water").at) {
        out->type = "WaterBody";
        out->width = wide > 0 ? wide : span_is(stream, "river") ? 20 : span_is(stream, "canal") ? 10 : 3;
        out->body.base = 0.02;
    } else if (is_among(natural, greens) || is_among(landuse, greens) || is_among(leisure, greens)) {
        out->type = "PlantCover";
        out->body.base = 0.03;
    } else {
        out->type = "LandUse";
        out->is_nothing = line;
    }
}

/* People, cars and furniture are called by one of these keys; trees by their form, if they have one. */
static void understand_point(geojson_thing *out, json_span properties)
{
    static const char *const keys[] = {"kind", "amenity", "highway", "barrier", "natural", "class", NULL};
    static const struct {
        const char *word;
        prop_kind   kind;
    } rows[] = {{"person", PROP_PERSON},
                {"pedestrian", PROP_WALKER},
                {"walker", PROP_WALKER},
                {"child", PROP_CHILD},
                {"car", PROP_CAR},
                {"van", PROP_VAN},
                {"bus", PROP_BUS},
                {"bicycle", PROP_CYCLIST},
                {"cyclist", PROP_CYCLIST},
                {"street_lamp", PROP_LAMP},
                {"lamp", PROP_LAMP},
                {"bench", PROP_BENCH},
                {"waste_basket", PROP_BIN},
                {"bin", PROP_BIN},
                {"bollard", PROP_BOLLARD},
                {"tree", PROP_BROAD_TREE},
                {"line_tree", PROP_LINE_TREE}};
    json_span word = geojson_property(properties, keys), leaves = property(properties, "leaf_type");
    double    high = number_of(property(properties, "height")), turn = number_of(property(properties, "direction"));
    out->is_nothing = true;
    for (size_t i = 0; i < sizeof rows / sizeof *rows && word.at; i++)
        if (span_is(word, rows[i].word)) {
            out->prop = rows[i].kind;
            out->is_nothing = false;
        }
    if (out->prop == PROP_BROAD_TREE && span_is(leaves, "needleleaved"))
        out->prop = PROP_NEEDLE_TREE;
    out->type = prop_class(out->prop);
    out->body.ridge = out->prop < PROP_BROAD_TREE ? 1 : high > 0 && high < 200 ? high : 8;
    out->heading = isfinite(turn) ? (90 - turn) * 0.017453292519943295 : 0;
}

void geojson_understand(geojson_thing *out, json_span properties, bool point, bool line)
{
    static const char *const buildings[] = {"building",           "building:part",  "height",
                                            "building:height",    "measuredHeight", "building:levels",
                                            "storeysAboveGround", "roof:shape",     NULL};
    *out = (geojson_thing){.type = "LandUse"};
    if (point) {
        understand_point(out, properties);
        return;
    }
    json_span building = geojson_property(properties, buildings);
    if (!line && building.at && !span_is(building, "no"))
        understand_building(out, properties);
    else
        understand_ground(out, properties, line);
}
