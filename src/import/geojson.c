/* GeoJSON (RFC 7946): footprints with heights become buildings, other areas what lies on the ground between them,
 * lines of roads and rails strips, trees trees. Keys are those of OpenStreetMap's Simple 3D Buildings, and of
 * cadastres. Degrees become metres around the middle. */
#define _GNU_SOURCE /* memmem */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "import/city_crs.h"
#include "import/crossings.h"
#include "import/footprint.h"
#include "import/geojson.h"
#include "import/json_scan.h"
#include "import/ring.h"
#include "import/street.h"
#include "import/untangle.h"

enum { POSITIONS_MAX = 1000000 };

#define STRAIGHT 5e-3 /* m */

/* The outline and holes of one polygon, or one line. */
typedef struct rings {
    double (*positions)[2];
    size_t *counts;
    size_t  position_count, position_capacity, ring_count, ring_capacity;
    double  lowest; /* height, 0 where none is given */
} rings;

typedef struct geojson_reader {
    const import_job *job;
    lmn_scene        *scene;
    lmn_error        *error;
    lmn_status        status;
    city_builder      builder;
    city_shape        shape, flat; /* flat: one area or strip before it lies on the terrain */
    footprint_points  points, flat_points;
    rings             rings;
    untangled         untangled; /* the polygon that is read */
    city_meshes       props[PROPS];
    street           *street; /* NULL: nobody asks for more than the file has */
    double (*parts)[3];       /* middles of buildings' parts, by x */
    size_t   part_count, part_capacity;
    uint64_t guessed_heights, limited_heights, flat_roofs, other_roofs, places;
    size_t   number;
} geojson_reader;

typedef struct feature {
    json_span id, properties, geometry;
} feature;

static bool no_memory(geojson_reader *r)
{
    r->status = error_memory(r->error);
    return false;
}

static bool good(geojson_reader *r, const json_scan *s)
{
    if (s->wrong && r->status == LMN_OK) {
        const char *at = (const char *)r->job->file->data;
        int         line = 1;
        for (; at < s->wrong_at; at++)
            line += *at == '\n';
        r->status = error_in_file(r->error, LMN_FORMAT, r->job->path, line, "%s", s->wrong);
    }
    return r->status == LMN_OK;
}

/* --- positions ------------------------------------------------------------------------------------------ */

typedef void (*position_fn)(geojson_reader *r, const double p[3], void *user);

static void read_position(geojson_reader *r, json_scan *s, position_fn each, void *user)
{
    double p[3] = {0, 0, 0};
    int    k = 0;
    for (bool more = scan_open(s, '['); more; more = scan_next(s, ']'), k++) {
        double value = 0;
        if (scan_number(s, &value) && k < 3)
            p[k] = value;
    }
    if (k >= 2 && isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]) && fabs(p[0]) <= 1e15 && fabs(p[1]) <= 1e15)
        each(r, p, user);
    else if (!s->wrong)
        r->builder.tally.missing_points++;
}

/* A list of positions. */
static void read_line(geojson_reader *r, json_scan *s, position_fn each, void *user)
{
    if (scan_peek(s) != '[') {
        scan_skip(s);
        r->builder.tally.bad_geometry++;
        return;
    }
    for (bool more = scan_open(s, '['); more && r->status == LMN_OK; more = scan_next(s, ']')) {
        if (scan_peek(s) == '[') {
            read_position(r, s, each, user);
        } else {
            scan_skip(s);
            r->builder.tally.bad_geometry++;
        }
    }
}

/* Every position at any depth of lists. */
static void each_position(geojson_reader *r, json_scan *s, int depth, position_fn each, void *user)
{
    if (depth > 4 || scan_peek(s) != '[') {
        scan_skip(s);
        return;
    }
    json_scan inside = *s;
    if (scan_open(&inside, '[') && scan_peek(&inside) != '[' && scan_peek(&inside) != '{') {
        read_position(r, s, each, user);
        return;
    }
    for (bool more = scan_open(s, '['); more && r->status == LMN_OK; more = scan_next(s, ']'))
        each_position(r, s, depth + 1, each, user);
}

static void keep_position(geojson_reader *r, const double p[3], void *user)
{
    rings *k = user;
    double local[3] = {p[0], p[1], p[2]};
    city_crs_local(&r->scene->city, false, local);
    size_t begin = k->position_count - (k->ring_count ? k->counts[k->ring_count - 1] : 0);
    if (k->position_count > begin) {
        const double *last = k->positions[k->position_count - 1];
        if (hypot(last[0] - local[0], last[1] - local[1]) < 1e-3)
            return;
    }
    if (k->position_count >= POSITIONS_MAX) {
        r->status =
            error_in_file(r->error, LMN_LIMIT, r->job->path, 0, "a polygon of more than %d corners", POSITIONS_MAX);
        return;
    }
    if (!mem_grow((void **)&k->positions, &k->position_capacity, k->position_count + 1, sizeof *k->positions)) {
        no_memory(r);
        return;
    }
    k->lowest = k->position_count ? fmin(k->lowest, local[2]) : local[2];
    memcpy(k->positions[k->position_count++], local, 2 * sizeof *local);
    k->counts[k->ring_count - 1]++;
}

static bool begin_ring(geojson_reader *r, rings *k)
{
    if (!mem_grow((void **)&k->counts, &k->ring_capacity, k->ring_count + 1, sizeof *k->counts))
        return no_memory(r);
    k->counts[k->ring_count++] = 0;
    return true;
}

/* Anticlockwise or not: many files do not hold to what RFC 7946 says in section 3.1.6. */
static void wind(double (*p)[2], size_t count, bool anticlockwise)
{
    double area = 0;
    for (size_t i = 0; i < count; i++)
        area += p[i][0] * p[(i + 1) % count][1] - p[(i + 1) % count][0] * p[i][1];
    for (size_t i = 0; i < count / 2 && (area > 0) != anticlockwise; i++)
        for (int k = 0; k < 2; k++) {
            double kept = p[i][k];
            p[i][k] = p[count - 1 - i][k];
            p[count - 1 - i][k] = kept;
        }
}

/* Corners on the straight way between their neighbours, and back and forth on it, are none: roofs would have an edge
 * there. */
static void straighten(rings *k, size_t first)
{
    size_t *count = &k->counts[k->ring_count - 1], kept = 0;
    double(*p)[2] = k->positions + first;
    for (size_t i = 0; i < *count; i++) {
        const double *a = p[kept ? kept - 1 : *count - 1], *b = p[i], *c = p[(i + 1) % *count];
        double        x = c[0] - a[0], y = c[1] - a[1], length = hypot(x, y);
        double        off = length > 0 ? fabs(x * (b[1] - a[1]) - y * (b[0] - a[0])) / length : 0;
        bool          straight = off<STRAIGHT          &&* count - (i - kept)> 3;
        if (!straight)
            memmove(p[kept++], b, sizeof *p);
    }
    k->position_count -= *count - kept;
    *count = kept;
}

/* A ring's last position is its first one again; rings without an area are left out, and holes with their outline. */
static void end_ring(geojson_reader *r, rings *k)
{
    size_t *count = &k->counts[k->ring_count - 1], first = k->position_count - *count;
    while (*count > 1 && hypot(k->positions[first][0] - k->positions[k->position_count - 1][0],
                               k->positions[first][1] - k->positions[k->position_count - 1][1]) < 1e-3) {
        k->position_count--;
        --*count;
    }
    if (*count >= 3) {
        straighten(k, first);
        wind(k->positions + first, *count, k->ring_count == 1);
        return;
    }
    k->position_count -= *count;
    k->ring_count--;
    r->builder.tally.degenerate++;
}

static bool read_polygon(geojson_reader *r, json_scan *s)
{
    rings *k = &r->rings;
    bool   outline = true;
    k->position_count = k->ring_count = 0;
    if (scan_peek(s) != '[') {
        scan_skip(s);
        r->builder.tally.bad_geometry++;
        return false;
    }
    for (bool more = scan_open(s, '['); more && r->status == LMN_OK; more = scan_next(s, ']')) {
        if (!outline && k->ring_count == 0) {
            scan_skip(s);
            continue;
        }
        if (!begin_ring(r, k))
            return false;
        read_line(r, s, keep_position, k);
        if (r->status == LMN_OK)
            end_ring(r, k);
        outline = false;
    }
    return r->status == LMN_OK && k->ring_count > 0;
}

/* --- objects -------------------------------------------------------------------------------------------- */

static void put_attributes(geojson_reader *r, int32_t node, json_span properties)
{
    enum { BYTES_MAX = 4096 };
    json_scan s = scan_of(properties);
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s);
        bool      text = scan_peek(&s) == '"', null = scan_null(&s);
        json_span value = null ? (json_span){NULL, 0} : text ? scan_string(&s) : scan_skip(&s);
        if (null || !value.at || s.wrong || value.size > BYTES_MAX)
            continue;
        if (!city_attribute_of_spans(r->scene, node, key, value)) {
            no_memory(r);
            return;
        }
    }
    good(r, &s);
}

static char *id_of(geojson_reader *r, const feature *f, bool *numbered)
{
    static const char *const keys[] = {"@id", "gml_id", "osm_id", "osm_way_id", "fid", "id", NULL};
    char                     name[40];
    json_span                id = f->id.at ? f->id : geojson_property(f->properties, keys);
    *numbered = !id.at || !id.size;
    if (!*numbered)
        return span_decode(id);
    snprintf(name, sizeof name, "feature-%zu", r->number);
    return mem_copy_text(name);
}

/* What a feature's shape becomes below its node. */
static void attach(geojson_reader *r, int32_t node, const geojson_thing *thing)
{
    city_meshes meshes = {NULL, 0, 0};
    if (r->status == LMN_OK && r->shape.face_count) {
        city_builder_points(&r->builder, r->points.items, r->points.count);
        r->status = city_make(&r->builder, &r->shape, city_word_of_class(thing->type, strlen(thing->type)),
                              thing->is_building, &meshes);
    }
    if (r->status == LMN_OK && meshes.count)
        r->status = city_attach(&r->builder, node, &meshes, NULL, true);
    else
        r->builder.tally.no_geometry++;
    mem_free(meshes.items);
}

static void begin_flat(geojson_reader *r)
{
    city_shape_clear(&r->flat);
    r->flat_points.count = 0;
}

/* What lies on the ground goes to the object's shape: as it is, or along the terrain, where the slope between two
 * surfaces asks for more room than a level one does. */
static bool lay_flat(geojson_reader *r, const geojson_thing *thing)
{
    const city_shape *flat = &r->flat;
    uint32_t          first = (uint32_t)r->points.count;
    if (r->builder.terrain)
        return terrain_drape(r->builder.terrain, flat, r->flat_points.items, 0.1 + 4 * thing->body.base + thing->rise,
                             &r->shape, &r->points);
    bool done = true;
    for (size_t i = 0; i < r->flat_points.count && done; i++) {
        vec3 p = r->flat_points.items[i];
        done = footprint_add_point(&r->points, (double)p.x, (double)p.y, (double)p.z);
    }
    for (size_t ring = 0, i = 0; ring < flat->ring_count && done; ring++) {
        for (; i < flat->rings[ring] && done; i++)
            done = city_shape_corner(&r->shape, first + flat->corners[i]);
        done = done && city_shape_end_ring(&r->shape);
    }
    return done && city_shape_end_face(&r->shape, NONE, CITY_NO_WORD, 0);
}

/* Is there a part of the building inside? Then the parts are the building (Simple 3D Buildings). */
static bool has_parts(const geojson_reader *r)
{
    const rings *k = &r->rings;
    double       low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < k->counts[0]; i++) {
        low = fmin(low, k->positions[i][0]);
        high = fmax(high, k->positions[i][0]);
    }
    size_t first = 0, end = r->part_count;
    while (first < end) {
        size_t middle = first + (end - first) / 2;
        if (r->parts[middle][0] < low)
            first = middle + 1;
        else
            end = middle;
    }
    for (; first < r->part_count && r->parts[first][0] <= high; first++)
        if (ring_has((const double(*)[2])k->positions, k->counts[0], r->parts[first]))
            return true;
    return false;
}

/* One polygon whose rings cross nothing. */
static bool raise_polygon(geojson_reader *r, const geojson_thing *thing, const double (*positions)[2],
                          const size_t *counts, size_t rings)
{
    const bool   obstacle = thing->is_building || strcmp(thing->type, "WaterBody") == 0;
    footprint    how = thing->body;
    roof_made    made = ROOF_AS_ASKED;
    bool         done = !r->street || !obstacle || street_add_obstacle(r->street, positions, counts[0]);
    const double ground = r->builder.terrain && thing->is_building
                              ? terrain_lowest(r->builder.terrain, positions, counts[0])
                              : r->rings.lowest;
    how.base += ground;
    how.eaves += ground;
    how.ridge += ground;
    if (thing->is_building) {
        done = done && footprint_raise(&r->shape, &r->points, &how, positions, counts, rings, &made);
        r->flat_roofs += made == ROOF_MADE_FLAT;
        r->other_roofs += made == ROOF_OTHERWISE || (made == ROOF_AS_ASKED && thing->other_roof);
        return done;
    }
    begin_flat(r);
    uint32_t at = 0;
    for (size_t ring = 0; ring < rings && done; ring++) {
        for (size_t i = 0; i < counts[ring] && done; i++, at++)
            done = footprint_add_point(&r->flat_points, positions[at][0], positions[at][1], how.base + thing->rise) &&
                   city_shape_corner(&r->flat, at);
        done = done && city_shape_end_ring(&r->flat);
    }
    return done && city_shape_end_face(&r->flat, NONE, CITY_NO_WORD, 0) && lay_flat(r, thing);
}

static void add_polygon(geojson_reader *r, const geojson_thing *thing, json_scan *s)
{
    if (!read_polygon(r, s))
        return;
    const rings *k = &r->rings;
    if (thing->is_building && !thing->is_part && has_parts(r)) {
        r->builder.tally.coarser++;
        return;
    }
    untangled *u = &r->untangled;
    bool       done = untangle(u, (const double(*)[2])k->positions, k->counts, k->ring_count);
    for (size_t i = 0; i < u->count && done; i++)
        done = raise_polygon(r, thing, (const double(*)[2])u->rings.positions + u->polygons[i].position,
                             u->rings.counts + u->polygons[i].first, u->polygons[i].rings);
    if (!done)
        no_memory(r);
}

static void add_line(geojson_reader *r, const geojson_thing *thing, json_scan *s)
{
    rings *k = &r->rings;
    k->position_count = k->ring_count = 0;
    if (!begin_ring(r, k))
        return;
    read_line(r, s, keep_position, k);
    if (r->status != LMN_OK || k->position_count < 2 || !(thing->width > 0))
        return;
    begin_flat(r);
    if (!footprint_strip(&r->flat, &r->flat_points, (const double(*)[2])k->positions, k->position_count, thing->width,
                         thing->body.base + thing->rise + k->lowest) ||
        !lay_flat(r, thing))
        no_memory(r);
    if (r->status == LMN_OK && r->street && strcmp(thing->type, "Road") == 0 &&
        !street_add_road(r->street, (const double(*)[2])k->positions, k->position_count, thing->width, thing->cars))
        no_memory(r);
}

static void keep_place(geojson_reader *r, const double p[3], void *user)
{
    double *out = user;
    memcpy(out, p, 3 * sizeof *out);
    city_crs_local(&r->scene->city, false, out);
}

static void put_prop(geojson_reader *r, int32_t node, const geojson_thing *thing, json_scan *s)
{
    double at[3] = {NAN, 0, 0}, size = thing->body.ridge, c = size * cos(thing->heading),
           n = size * sin(thing->heading);
    city_meshes *meshes = &r->props[thing->prop];
    read_position(r, s, keep_place, at);
    if (!isfinite(at[0]))
        return;
    if (!meshes->count)
        r->status = prop_make(&r->builder, thing->prop, meshes);
    if (r->builder.terrain)
        at[2] = terrain_height(r->builder.terrain, at[0], at[1]);
    mat4 place = {{c, n, 0, 0, -n, c, 0, 0, 0, 0, size, 0, at[0], at[1], at[2], 1}};
    if (r->status == LMN_OK)
        r->status = city_attach(&r->builder, node, meshes, &place, true);
    if (r->status == LMN_OK && r->street &&
        !street_add_thing(r->street, at[0], at[1], prop_room_of(thing->prop).radius))
        no_memory(r);
}

static void put_feature(geojson_reader *r, const feature *f)
{
    json_span     type = {NULL, 0}, coordinates = {NULL, 0};
    geojson_thing thing;
    if (!f->geometry.at || f->geometry.at[0] != '{') {
        r->builder.tally.no_geometry++;
        return;
    }
    json_scan s = scan_of(f->geometry);
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s);
        if (span_is(key, "type"))
            type = scan_string(&s);
        else if (span_is(key, "coordinates"))
            coordinates = scan_skip(&s);
        else
            scan_skip(&s);
    }
    if (!good(r, &s))
        return;
    bool point = span_is(type, "Point"), line = span_is(type, "LineString"), lines = span_is(type, "MultiLineString");
    bool area = span_is(type, "Polygon"), areas = span_is(type, "MultiPolygon");
    if (!coordinates.at || (!point && !line && !lines && !area && !areas)) {
        r->builder.tally.unknown_types++;
        return;
    }
    geojson_understand(&thing, f->properties, point, line || lines);
    if (thing.is_nothing) {
        r->places++;
        return;
    }
    r->guessed_heights += thing.guessed;
    r->limited_heights += thing.limited;
    bool    numbered;
    char   *id = id_of(r, f, &numbered);
    int32_t node = city_object(&r->builder, id, thing.type, strlen(thing.type));
    if (node == NONE) {
        r->status = r->status == LMN_OK ? error_memory(r->error) : r->status;
        return;
    }
    r->scene->nodes[node].numbered = numbered;
    put_attributes(r, node, f->properties);
    city_shape_clear(&r->shape);
    r->points.count = 0;
    s = scan_of(coordinates);
    if (point) {
        put_prop(r, node, &thing, &s);
        return;
    }
    if (area)
        add_polygon(r, &thing, &s);
    else if (line)
        add_line(r, &thing, &s);
    else if (scan_peek(&s) == '[')
        for (bool more = scan_open(&s, '['); more && r->status == LMN_OK; more = scan_next(&s, ']')) {
            if (areas)
                add_polygon(r, &thing, &s);
            else
                add_line(r, &thing, &s);
        }
    if (good(r, &s))
        attach(r, node, &thing);
}

/* --- the file ------------------------------------------------------------------------------------------- */

static feature read_feature(json_scan *s)
{
    feature f = {{NULL, 0}, {NULL, 0}, {NULL, 0}};
    for (bool more = scan_open(s, '{'); more; more = scan_next(s, '}')) {
        json_span key = scan_key(s);
        if (span_is(key, "id"))
            f.id = scan_peek(s) == '"' ? scan_string(s) : scan_skip(s);
        else if (span_is(key, "properties"))
            f.properties = scan_skip(s);
        else if (span_is(key, "geometry"))
            f.geometry = scan_skip(s);
        else
            scan_skip(s);
    }
    if (f.properties.at && f.properties.at[0] != '{')
        f.properties = (json_span){NULL, 0};
    return f;
}

typedef struct extent {
    double low[3], high[3];
} extent;

static void widen(geojson_reader *r, const double p[3], void *user)
{
    extent *e = user;
    (void)r;
    for (int k = 0; k < 3; k++) {
        e->low[k] = fmin(e->low[k], p[k]);
        e->high[k] = fmax(e->high[k], p[k]);
    }
}

static const extent nowhere = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

/* The middle of a building's part, as the file has it. */
static void keep_part(geojson_reader *r, const feature *f, const extent *own)
{
    static const char *const keys[] = {"building:part", NULL};
    json_span                part = geojson_property(f->properties, keys);
    if (!part.at || span_is(part, "no") || !(own->high[0] >= own->low[0]))
        return;
    if (!mem_grow((void **)&r->parts, &r->part_capacity, r->part_count + 1, sizeof *r->parts)) {
        no_memory(r);
        return;
    }
    for (int k = 0; k < 3; k++)
        r->parts[r->part_count][k] = own->low[k] + (own->high[k] - own->low[k]) / 2;
    r->part_count++;
}

static int compare_parts(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void place_parts(geojson_reader *r)
{
    for (size_t i = 0; i < r->part_count; i++)
        city_crs_local(&r->scene->city, false, r->parts[i]);
    if (r->part_count)
        qsort(r->parts, r->part_count, sizeof *r->parts, compare_parts);
}

/* Degrees that no plane holds: why, should nothing come of them. */
static void note_extent(geojson_reader *r, const extent *e)
{
    bool degrees =
        !r->scene->city.crs && e->low[0] >= -360 && e->high[0] <= 360 && e->low[1] >= -360 && e->high[1] <= 360;
    if (degrees && (e->low[1] < -90 || e->high[1] > 90))
        snprintf(r->builder.cause, sizeof r->builder.cause,
                 "it has latitudes from %.6g to %.6g degrees, and the poles lie at 90 (longitudes come first)",
                 e->low[1], e->high[1]);
    else if (degrees && e->high[0] - e->low[0] > 180)
        snprintf(
            r->builder.cause, sizeof r->builder.cause,
            "its longitudes go from %.6g to %.6g degrees, around the Earth or across the antimeridian: files on both "
            "sides of it are not read",
            e->low[0], e->high[0]);
}

static void find_place(geojson_reader *r, json_span features)
{
    extent    e = nowhere;
    json_scan s = scan_of(features);
    for (bool more = scan_open(&s, '['); more && r->status == LMN_OK; more = scan_next(&s, ']')) {
        if (scan_peek(&s) != '{') {
            scan_skip(&s);
            continue;
        }
        feature f = read_feature(&s);
        if (!f.geometry.at || f.geometry.at[0] != '{')
            continue;
        extent    own = nowhere;
        json_scan g = scan_of(f.geometry);
        for (bool next = scan_open(&g, '{'); next; next = scan_next(&g, '}'))
            if (span_is(scan_key(&g), "coordinates"))
                each_position(r, &g, 0, widen, &own);
            else
                scan_skip(&g);
        for (int k = 0; k < 3; k++) {
            e.low[k] = fmin(e.low[k], own.low[k]);
            e.high[k] = fmax(e.high[k], own.high[k]);
        }
        if (good(r, &g))
            keep_part(r, &f, &own);
    }
    city_facts *facts = &r->scene->city;
    if (!good(r, &s) || !(e.high[0] >= e.low[0]))
        return;
    r->builder.tally.missing_points = 0; /* counted again when they are read */
    note_extent(r, &e);
    const char *name = facts->crs ? facts->crs : "urn:ogc:def:crs:OGC:1.3:CRS84";
    /* RFC 7946, section 3.1.1: longitude first, whatever the system's own order is. */
    city_crs_understand(facts, name, e.low, e.high, NULL);
    city_choose_origin(facts, e.low, e.high);
    place_parts(r);
}

static void read_features(geojson_reader *r, json_span features)
{
    json_scan s = scan_of(features);
    for (bool more = scan_open(&s, '['); more && r->status == LMN_OK; more = scan_next(&s, ']')) {
        r->number++;
        if (scan_peek(&s) != '{') {
            scan_skip(&s);
            r->builder.tally.bad_geometry++;
            continue;
        }
        feature f = read_feature(&s);
        if (!s.wrong)
            put_feature(r, &f);
        if (r->number % 1024 == 0 && r->status == LMN_OK)
            r->status = import_progress(r->job, 0.2 + 0.6 * (double)(s.at - features.at) / (double)features.size,
                                        "raising buildings", r->error);
    }
    good(r, &s);
}

/* {"type": "name", "properties": {"name": "urn:…"}}, of 2008. */
static void read_crs(geojson_reader *r, json_span crs)
{
    if (!crs.at || crs.at[0] != '{')
        return;
    json_scan s = scan_of(crs);
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s), value = scan_skip(&s);
        if (!span_is(key, "properties") || value.at[0] != '{')
            continue;
        static const char *const keys[] = {"name", NULL};
        json_span                name = geojson_property(value, keys);
        mem_free(r->scene->city.crs);
        r->scene->city.crs = name.at ? span_decode(name) : NULL;
    }
    good(r, &s);
}

static void read_document(geojson_reader *r)
{
    json_scan s = {.at = (const char *)r->job->file->data,
                   .end = (const char *)r->job->file->data + r->job->file->size};
    json_span features = {NULL, 0}, crs = {NULL, 0};
    if (r->job->file->size >= 3 && memcmp(s.at, "\xEF\xBB\xBF", 3) == 0)
        s.at += 3;
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s);
        if (span_is(key, "features") && scan_peek(&s) == '[')
            features = scan_skip(&s);
        else if (span_is(key, "crs"))
            crs = scan_skip(&s);
        else
            scan_skip(&s);
    }
    if (!good(r, &s))
        return;
    if (!features.at) {
        r->status = error_in_file(r->error, LMN_FORMAT, r->job->path, 0, "'features' is missing");
        error_hint(r->error, "a GeoJSON model is a FeatureCollection");
        return;
    }
    read_crs(r, crs);
    find_place(r, features);
    if (r->status == LMN_OK)
        r->status = city_builder_terrain(&r->builder);
    double density = r->job->desc ? r->job->desc->populate : 0;
    if (r->status == LMN_OK && density > 0 && !(r->street = street_new()))
        no_memory(r);
    if (r->status == LMN_OK)
        read_features(r, features);
    if (r->status == LMN_OK)
        r->status = crossings_join(r->scene, r->error);
    if (r->status == LMN_OK && r->street)
        r->status = street_populate(r->street, &r->builder, density);
}

static void tell(geojson_reader *r)
{
    city_facts *facts = &r->scene->city;
    bool        done =
        (!r->guessed_heights || city_add(facts, CITY_REPAIRED, "guessed-heights", r->guessed_heights)) &&
        (!r->limited_heights || city_add(facts, CITY_REPAIRED, "limited-heights", r->limited_heights)) &&
        (!r->untangled.crossing || city_add(facts, CITY_REPAIRED, "self-crossing-footprints", r->untangled.crossing)) &&
        (!r->untangled.stray_holes || city_add(facts, CITY_SKIPPED, "stray-holes", r->untangled.stray_holes)) &&
        (!r->flat_roofs || city_add(facts, CITY_REPAIRED, "flat-roofs", r->flat_roofs)) &&
        (!r->other_roofs || city_add(facts, CITY_REPAIRED, "other-roofs", r->other_roofs)) &&
        (!r->places || city_add(facts, CITY_SKIPPED, "points", r->places));
    if (!done)
        no_memory(r);
}

static lmn_status read_geojson(const import_job *job, lmn_error *error)
{
    geojson_reader *r = mem_calloc(1, sizeof *r);
    if (!r)
        return error_memory(error);
    r->job = job;
    r->scene = job->scene;
    r->error = error;
    r->status = city_builder_open(&r->builder, job, error);
    if (r->status == LMN_OK)
        read_document(r);
    if (r->status == LMN_OK)
        tell(r);
    lmn_status status = city_builder_close(&r->builder, r->status);
    city_shape_release(&r->shape);
    city_shape_release(&r->flat);
    mem_free(r->flat_points.items);
    mem_free(r->points.items);
    mem_free(r->rings.positions);
    mem_free(r->rings.counts);
    mem_free(r->parts);
    untangle_release(&r->untangled);
    for (int i = 0; i < PROPS; i++)
        mem_free(r->props[i].items);
    street_free(r->street);
    mem_free(r);
    return status;
}

static bool recognises(const file_data *file)
{
    const char *at = (const char *)file->data;
    size_t      size = file->size < 4096 ? file->size : 4096;
    size_t      first = 0;
    while (first < size && strchr("\xEF\xBB\xBF \n\r\t", at[first]) && at[first])
        first++;
    return first < size && at[first] == '{' && memmem(at, file->size, "\"FeatureCollection\"", 19);
}

const import_format import_geojson = {
    .name = "GeoJSON",
    .endings = ".geojson .json",
    .up = 'z',
    .recognises = recognises,
    .read = read_geojson,
};
