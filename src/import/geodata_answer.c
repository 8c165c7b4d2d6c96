/* In the child: opening a file that lies in memory, and what GDAL finds in it as GeoJSON, which this program reads by
 * itself and as carefully as any other. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "import/geodata.h"
#include "import/geodata_library.h"

#define FOLDER "/vsimem/limner/"

/* Kinds of geometries, fields and openings, as GDAL numbers them. */
enum { POINT = 1, LINE = 2, POLYGON = 3, POINTS = 4, LINES = 5, POLYGONS = 6, COLLECTION = 7 };
enum { FIELD_INTEGER = 0, FIELD_REAL = 2, FIELD_INTEGER64 = 12 };
enum { OPEN_RASTER = 0x02, OPEN_VECTOR = 0x04 };

/* Which of a closed way's keys make it an area; all else comes as other_tags. */
static const char osm_keys[] =
    "closed_ways_are_polygons=aeroway,amenity,boundary,building,building:part,craft,geological,historic,landuse,"
    "leisure,military,natural,office,place,shop,sport,tourism,water,area:highway\n"
    "attribute_name_laundering=no\n"
    "[points]\nosm_id=yes\nother_tags=yes\n[lines]\nosm_id=yes\nother_tags=yes\n"
    "[multipolygons]\nosm_id=yes\nosm_way_id=yes\nother_tags=yes\n[multilinestrings]\nosm_id=yes\nother_tags=yes\n"
    "[other_relations]\nosm_id=yes\nother_tags=yes\n";

/* --- text ----------------------------------------------------------------------------------------------- */

static void put(fence_bytes *to, const char *text)
{
    fence_put(to, text, strlen(text));
}

static void put_quoted(fence_bytes *to, const char *text, size_t size)
{
    fence_put(to, "\"", 1);
    for (size_t i = 0; i < size; i++) {
        char c = text[i], escape[8];
        if (c == '"' || c == '\\') {
            snprintf(escape, sizeof escape, "\\%c", c);
            put(to, escape);
        } else if ((unsigned char)c < 0x20) {
            snprintf(escape, sizeof escape, "\\u%04x", c);
            put(to, escape);
        } else {
            fence_put(to, &c, 1);
        }
    }
    fence_put(to, "\"", 1);
}

static void put_property(fence_bytes *to, const char *key, size_t key_size, const char *value, size_t size, bool *any)
{
    put(to, *any ? "," : "");
    put_quoted(to, key, key_size);
    put(to, ":");
    put_quoted(to, value, size);
    *any = true;
}

/* --- properties ----------------------------------------------------------------------------------------- */

/* A quoted piece of "key"=>"value", unescaped in place; NULL: there is none. */
static char *take_piece(char **at, size_t *size)
{
    char *begin = strchr(*at, '"'), *out;
    if (!begin)
        return NULL;
    out = ++begin;
    char *read = begin;
    for (; *read && *read != '"'; read++) {
        if (*read == '\\' && read[1])
            read++;
        *out++ = *read;
    }
    *at = *read ? read + 1 : read;
    *size = (size_t)(out - begin);
    return begin;
}

/* "height"=>"12","roof:shape"=>"gabled" */
static void put_tags(fence_bytes *to, const char *tags, bool *any)
{
    char *copy = mem_copy_text(tags), *at = copy;
    if (!copy)
        to->failed = true;
    while (at) {
        size_t key_size, size;
        char  *key = take_piece(&at, &key_size), *value = key ? take_piece(&at, &size) : NULL;
        if (!value)
            break;
        put_property(to, key, key_size, value, size, any);
    }
    mem_free(copy);
}

/* A layer of cadastres says what its features are by its name alone. */
static void put_kind(fence_bytes *to, const char *layer, bool *any)
{
    static const struct {
        const char *part, *key, *value;
    } rows[] = {{"build", "building", "yes"},   {"footprint", "building", "yes"}, {"gebaeude", "building", "yes"},
                {"gebäude", "building", "yes"}, {"batiment", "building", "yes"},  {"pand", "building", "yes"},
                {"road", "highway", "yes"},     {"street", "highway", "yes"},     {"strasse", "highway", "yes"},
                {"water", "natural", "water"},  {"tree", "natural", "tree"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (const char *at = layer; at && *at; at++)
            if (strncasecmp(at, rows[i].part, strlen(rows[i].part)) == 0) {
                put_property(to, rows[i].key, strlen(rows[i].key), rows[i].value, strlen(rows[i].value), any);
                return;
            }
}

static void put_properties(const geodata_child *c, gdal_handle feature, const char *layer)
{
    const geodata_library *g = c->library;
    bool                   any = false;
    put(c->answer, "\"properties\":{");
    for (int i = 0, count = g->OGR_F_GetFieldCount(feature); i < count; i++) {
        if (!g->OGR_F_IsFieldSetAndNotNull(feature, i))
            continue;
        const char *key = g->OGR_Fld_GetNameRef(g->OGR_F_GetFieldDefnRef(feature, i));
        const char *value = g->OGR_F_GetFieldAsString(feature, i);
        if (strcmp(key, "other_tags") == 0)
            put_tags(c->answer, value, &any);
        else
            put_property(c->answer, key, strlen(key), value, strlen(value), &any);
    }
    put_kind(c->answer, layer, &any);
    put(c->answer, "}");
}

/* --- geometries ----------------------------------------------------------------------------------------- */

static void put_position(const geodata_child *c, gdal_handle geometry, int i, const double scale[3])
{
    double x, y, z;
    char   text[96];
    c->library->OGR_G_GetPoint(geometry, i, &x, &y, &z);
    if (isfinite(x) && isfinite(y) && isfinite(z) && fabs(x) < 1e12 && fabs(y) < 1e12 && fabs(z) < 1e12)
        snprintf(text, sizeof text, "[%.*f,%.*f,%.3f]", (int)scale[2], x * scale[0], (int)scale[2], y * scale[0],
                 z * scale[1]);
    else
        snprintf(text, sizeof text, "[null]");
    put(c->answer, text);
}

static void put_line(const geodata_child *c, gdal_handle geometry, const double scale[3])
{
    put(c->answer, "[");
    for (int i = 0, count = c->library->OGR_G_GetPointCount(geometry); i < count; i++) {
        put(c->answer, i ? "," : "");
        put_position(c, geometry, i, scale);
    }
    put(c->answer, "]");
}

static void put_coordinates(const geodata_child *c, gdal_handle geometry, int kind, const double scale[3])
{
    if (kind == POINT) {
        put_position(c, geometry, 0, scale);
        return;
    }
    if (kind == LINE) {
        put_line(c, geometry, scale);
        return;
    }
    put(c->answer, "[");
    for (int i = 0, count = c->library->OGR_G_GetGeometryCount(geometry); i < count; i++) {
        gdal_handle part = c->library->OGR_G_GetGeometryRef(geometry, i);
        put(c->answer, i ? "," : "");
        if (kind == POLYGON)
            put_line(c, part, scale);
        else
            put_coordinates(c, part, kind - 3, scale);
    }
    put(c->answer, "]");
}

static void put_geometry(const geodata_child *c, gdal_handle geometry, const double scale[3])
{
    static const char *const names[] = {NULL,         "Point",           "LineString",  "Polygon",
                                        "MultiPoint", "MultiLineString", "MultiPolygon"};
    gdal_handle              plain = c->library->OGR_G_GetLinearGeometry(geometry, 0, NULL);
    /* The number of a kind is one of the flat ones and thousands for each dimension more. */
    int kind = plain ? (int)((unsigned)c->library->OGR_G_GetGeometryType(plain) & 0x7FFFFFFF) % 1000 : 0;
    if (kind < POINT || kind > POLYGONS) {
        put(c->answer, "\"geometry\":{\"type\":\"other\",\"coordinates\":[]}");
    } else {
        put(c->answer, "\"geometry\":{\"type\":\"");
        put(c->answer, names[kind]);
        put(c->answer, "\",\"coordinates\":");
        put_coordinates(c, plain, kind, scale);
        put(c->answer, "}");
    }
    if (plain)
        c->library->OGR_G_DestroyGeometry(plain);
}

/* --- systems -------------------------------------------------------------------------------------------- */

const char *geodata_system_name(const geodata_child *c, gdal_handle system, char *room, size_t size)
{
    if (!system)
        return "";
    const char *authority = c->library->OSRGetAuthorityName(system, NULL);
    const char *code = c->library->OSRGetAuthorityCode(system, NULL);
    if (authority && code && strcmp(authority, "EPSG") == 0)
        snprintf(room, size, "EPSG:%s", code);
    else
        snprintf(room, size, "%s", c->library->OSRGetName(system) ? c->library->OSRGetName(system) : "");
    return room;
}

/* What everything is said in: the system of the first layer that has one, or degrees where that has no metres. */
typedef struct common_system {
    gdal_handle system; /* NULL: nobody says */
    char        name[256];
    double      scale[3]; /* of the plane, of heights; decimals */
} common_system;

static void choose_system(const geodata_child *c, common_system *out)
{
    const geodata_library *g = c->library;
    gdal_handle            found = NULL;
    for (int i = 0, count = g->GDALDatasetGetLayerCount(c->data); i < count && !found; i++)
        found = g->OGR_L_GetSpatialRef(g->GDALDatasetGetLayer(c->data, i));
    *out = (common_system){.scale = {1, 1, 4}};
    if (!found)
        return;
    out->system = g->OSRClone(found);
    g->OSRAutoIdentifyEPSG(out->system);
    const char *projection = g->OSRGetAttrValue(out->system, "PROJECTION", 0);
    bool        stretched = projection && strncmp(projection, "Mercator", 8) == 0;
    bool        known = g->OSRGetAuthorityCode(out->system, NULL) != NULL;
    if (stretched || (g->OSRIsGeographic(out->system) && !known)) {
        g->OSRDestroySpatialReference(out->system);
        out->system = g->OSRNewSpatialReference(NULL);
        g->OSRSetFromUserInput(out->system, "EPSG:4326");
    } else if (!known && g->OSRIsProjected(out->system)) {
        double metres = g->OSRGetLinearUnits(out->system, NULL);
        if (metres > 0 && isfinite(metres))
            out->scale[0] = out->scale[1] = metres;
    }
    g->OSRSetAxisMappingStrategy(out->system, 0);
    if (g->OSRIsGeographic(out->system))
        out->scale[2] = 10;
    geodata_system_name(c, out->system, out->name, sizeof out->name);
}

/* The way from a layer's system to the common one; NULL: they are one, or there is none. */
typedef struct layer_way {
    gdal_handle layer, way;
} layer_way;

static void find_way(const geodata_child *c, const common_system *to, gdal_handle layer, layer_way *at)
{
    const geodata_library *g = c->library;
    if (at->layer == layer)
        return;
    if (at->way)
        g->OCTDestroyCoordinateTransformation(at->way);
    gdal_handle system = g->OGR_L_GetSpatialRef(layer);
    bool        other = system && to->system && !g->OSRIsSame(system, to->system);
    *at = (layer_way){layer, other ? g->OCTNewCoordinateTransformation(system, to->system) : NULL};
}

lmn_status geodata_features(const geodata_child *c)
{
    const geodata_library *g = c->library;
    common_system          to;
    layer_way              at = {NULL, NULL};
    gdal_handle            layer, feature;
    bool                   any = false;
    choose_system(c, &to);
    put(c->answer, "{\"type\":\"FeatureCollection\",");
    if (to.name[0]) {
        put(c->answer, "\"crs\":{\"type\":\"name\",\"properties\":{\"name\":");
        put_quoted(c->answer, to.name, strlen(to.name));
        put(c->answer, "}},");
    } else {
        put(c->answer, "\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"\"}},");
    }
    put(c->answer, "\"features\":[\n");
    while (!c->answer->failed && (feature = g->GDALDatasetGetNextFeature(c->data, &layer, NULL, NULL, NULL))) {
        gdal_handle geometry = g->OGR_F_GetGeometryRef(feature);
        find_way(c, &to, layer, &at);
        if (geometry && (!at.way || g->OGR_G_Transform(geometry, at.way) == 0)) {
            put(c->answer, any ? ",\n{\"type\":\"Feature\"," : "{\"type\":\"Feature\",");
            put_properties(c, feature, g->OGR_L_GetName(layer));
            put(c->answer, ",");
            put_geometry(c, geometry, to.scale);
            put(c->answer, "}");
            any = true;
        }
        g->OGR_F_Destroy(feature);
    }
    put(c->answer, "]}");
    if (at.way)
        g->OCTDestroyCoordinateTransformation(at.way);
    if (to.system)
        g->OSRDestroySpatialReference(to.system);
    return LMN_OK;
}

/* --- opening -------------------------------------------------------------------------------------------- */

static void add_file(const geodata_library *g, const char *name, const void *bytes, size_t size)
{
    char path[512];
    snprintf(path, sizeof path, FOLDER "%s", name);
    /* GDAL changes nothing that is opened for reading. */
    union {
        const void    *given;
        unsigned char *taken;
    } memory = {bytes};
    void *file = g->VSIFileFromMemBuffer(path, memory.taken, size, 0);
    if (file)
        g->VSIFCloseL(file);
}

static bool take_files(const geodata_library *g, fence_reader *r)
{
    for (uint32_t i = 0, count = fence_take_u32(r); i < count && !r->ended; i++) {
        char       *name = fence_take_text(r);
        uint32_t    size = fence_take_u32(r);
        const void *bytes = fence_take(r, size);
        if (name && bytes)
            add_file(g, name, bytes, size);
        mem_free(name);
    }
    return !r->ended;
}

static lmn_status answer_open(const geodata_child *c, geodata_question question, fence_reader *r)
{
    geodata_grid grid = {0};
    if (question == GEODATA_FEATURES)
        return geodata_features(c);
    if (question == GEODATA_EXTENT)
        return geodata_extent_of(c);
    const void *given = fence_take(r, sizeof grid);
    char       *system = fence_take_text(r);
    if (given)
        memcpy(&grid, given, sizeof grid);
    lmn_status status = given && system ? geodata_heights(c, &grid, system) : error_memory(c->error);
    mem_free(system);
    return status;
}

lmn_status geodata_answer(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    static const char *const vectors[] = {"GPKG", "ESRI Shapefile", "OSM", "FlatGeobuf", NULL};
    static const char *const rasters[] = {"GTiff", "SRTMHGT", "AAIGrid", NULL};
    geodata_library          g;
    if (!geodata_library_get(&g)) {
        error_set(error, LMN_UNSUPPORTED, "this format is read with GDAL, which is not installed");
        error_hint(error, "install it (Debian: apt-get install gdal-bin), or convert the file to GeoJSON");
        return LMN_UNSUPPORTED;
    }
    fence_reader     r = fence_read(request, size);
    geodata_question question = (geodata_question)fence_take_u32(&r);
    char            *name = fence_take_text(&r), path[512];
    if (!name || !take_files(&g, &r)) {
        mem_free(name);
        return error_memory(error);
    }
    add_file(&g, "osmconf.ini", osm_keys, sizeof osm_keys - 1);
    snprintf(path, sizeof path, FOLDER "%s", name);
    mem_free(name);
    bool          vector = question == GEODATA_FEATURES;
    geodata_child c = {&g, NULL, answer, error};
    c.data = g.GDALOpenEx(path, vector ? OPEN_VECTOR : OPEN_RASTER, vector ? vectors : rasters, NULL, NULL);
    if (!c.data)
        return error_set(error, LMN_FORMAT, "GDAL cannot read it: %.200s", g.CPLGetLastErrorMsg());
    lmn_status status = answer_open(&c, question, &r);
    g.GDALClose(c.data);
    return status;
}
