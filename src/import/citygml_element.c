/* Elements of CityGML one after the other. Names are told apart without their namespaces: these change with each
 * version, and hardly any name means two things. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "import/citygml.h"

typedef enum gml_kind {
    GML_OTHER,
    GML_OBJECT,
    GML_SURFACE,  /* a surface that says what it is */
    GML_GEOMETRY, /* something made of polygons, which may have an id */
    GML_POLYGON,
    GML_RING,
    GML_NUMBERS,
    GML_TEXT,      /* of an object, an attribute or an appearance */
    GML_ATTRIBUTE, /* a generic one */
    GML_TEMPLATE,
    GML_INSTANCE
} gml_kind;

/* The kinds of names, sorted by name. */
static const struct {
    const char *name;
    gml_kind    kind;
} kinds[] = {
    {"Bridge", GML_OBJECT},
    {"BridgeConstructionElement", GML_OBJECT},
    {"BridgeConstructiveElement", GML_OBJECT},
    {"BridgeInstallation", GML_OBJECT},
    {"BridgePart", GML_OBJECT},
    {"Building", GML_OBJECT},
    {"BuildingConstructiveElement", GML_OBJECT},
    {"BuildingInstallation", GML_OBJECT},
    {"BuildingPart", GML_OBJECT},
    {"BuildingUnit", GML_OBJECT},
    {"CityFurniture", GML_OBJECT},
    {"CompositeSolid", GML_GEOMETRY},
    {"CompositeSurface", GML_GEOMETRY},
    {"GenericCityObject", GML_OBJECT},
    {"GenericLogicalSpace", GML_OBJECT},
    {"GenericOccupiedSpace", GML_OBJECT},
    {"GenericThematicSurface", GML_OBJECT},
    {"GenericUnoccupiedSpace", GML_OBJECT},
    {"Hole", GML_OBJECT},
    {"ImplicitGeometry", GML_INSTANCE},
    {"LandUse", GML_OBJECT},
    {"LinearRing", GML_RING},
    {"MultiSolid", GML_GEOMETRY},
    {"MultiSurface", GML_GEOMETRY},
    {"OrientableSurface", GML_GEOMETRY},
    {"OtherConstruction", GML_OBJECT},
    {"PlantCover", GML_OBJECT},
    {"Polygon", GML_POLYGON},
    {"PolygonPatch", GML_POLYGON},
    {"PolyhedralSurface", GML_GEOMETRY},
    {"Railway", GML_OBJECT},
    {"Rectangle", GML_POLYGON},
    {"Road", GML_OBJECT},
    {"Solid", GML_GEOMETRY},
    {"SolitaryVegetationObject", GML_OBJECT},
    {"Square", GML_OBJECT},
    {"Storey", GML_OBJECT},
    {"Surface", GML_GEOMETRY},
    {"TINRelief", GML_OBJECT},
    {"Tin", GML_GEOMETRY},
    {"Track", GML_OBJECT},
    {"TransportationComplex", GML_OBJECT},
    {"Triangle", GML_POLYGON},
    {"TriangulatedSurface", GML_GEOMETRY},
    {"Tunnel", GML_OBJECT},
    {"TunnelInstallation", GML_OBJECT},
    {"TunnelPart", GML_OBJECT},
    {"WaterBody", GML_OBJECT},
    {"Waterway", GML_OBJECT},
    {"coordinates", GML_NUMBERS},
    {"pos", GML_NUMBERS},
    {"posList", GML_NUMBERS},
    {"relativeGMLGeometry", GML_TEMPLATE},
    {"relativeGeometry", GML_TEMPLATE},
};

static gml_kind kind_of(const char *name)
{
    size_t low = 0, high = sizeof kinds / sizeof *kinds;
    while (low < high) {
        size_t middle = (low + high) / 2;
        int    order = strcmp(name, kinds[middle].name);
        if (order == 0)
            return kinds[middle].kind;
        if (order < 0)
            high = middle;
        else
            low = middle + 1;
    }
    return GML_OTHER;
}

static bool is_among(const char *const *names, const char *name)
{
    while (*names && strcmp(*names, name) != 0)
        names++;
    return *names != NULL;
}

/* What is inside of things is not drawn. */
static const char *const interiors[] = {"Room",
                                        "BuildingRoom",
                                        "IntBuildingInstallation",
                                        "BuildingFurniture",
                                        "BridgeRoom",
                                        "IntBridgeInstallation",
                                        "HollowSpace",
                                        "IntTunnelInstallation",
                                        NULL};
/* Elements in which nothing is looked for. */
static const char *const others[] = {"Address", "address", "externalReference", NULL};

gml_id gml_id_of(const char *bytes, size_t size)
{
    uint64_t h = UINT64_C(14695981039346656037);
    for (size_t i = 0; i < size; i++)
        h = (h ^ (unsigned char)bytes[i]) * UINT64_C(1099511628211);
    h ^= h >> 29;
    return h ? h : 1;
}

/* --- attributes of elements ----------------------------------------------------------------------------- */

typedef struct gml_value {
    const char *at; /* NULL: there is none */
    size_t      size;
} gml_value;

typedef struct gml_values {
    gml_value id, href, srs_name, srs_dimension, uom, name, uri, ring;
} gml_values;

static gml_values values_of(int count, const unsigned char **list)
{
    gml_values v = {{0}};
    for (int i = 0; i < count; i++, list += 5) {
        const char *name = (const char *)list[0];
        gml_value  *to = strcmp(name, "id") == 0             ? &v.id
                         : strcmp(name, "href") == 0         ? &v.href
                         : strcmp(name, "srsName") == 0      ? &v.srs_name
                         : strcmp(name, "srsDimension") == 0 ? &v.srs_dimension
                         : strcmp(name, "uom") == 0          ? &v.uom
                         : strcmp(name, "name") == 0         ? &v.name
                         : strcmp(name, "uri") == 0          ? &v.uri
                         : strcmp(name, "ring") == 0         ? &v.ring
                                                             : NULL;
        if (to)
            *to = (gml_value){(const char *)list[3], (size_t)(list[4] - list[3])};
    }
    return v;
}

/* "#name" within this file; 0: it is another one, or nothing. */
static gml_id local_id(gml_value href)
{
    return href.at && href.size > 1 && href.at[0] == '#' ? gml_id_of(href.at + 1, href.size - 1) : 0;
}

static void copy_value(char *out, size_t size, gml_value v)
{
    size_t length = v.at && v.size < size ? v.size : 0;
    if (length)
        memcpy(out, v.at, length);
    out[length] = '\0';
}

/* --- objects -------------------------------------------------------------------------------------------- */

static bool ends_with(const char *name, const char *end)
{
    size_t length = strlen(name), behind = strlen(end);
    return length > behind && strcmp(name + length - behind, end) == 0;
}

static void open_object(citygml_reader *r, gml_element *e, const gml_values *v)
{
    if (r->objects_count == LIMIT_NODES) {
        citygml_fail(r, LMN_LIMIT, "more than %zu city objects", LIMIT_NODES);
        return;
    }
    gml_object *o = GML_APPEND(r, objects);
    if (!o)
        return;
    char fallback[32];
    *o = (gml_object){
        .parent = r->object, .node = NONE, .lod = -1, .below_lod = -1, .is_part = ends_with(e->name, "Part")};
    snprintf(fallback, sizeof fallback, "object-%zu", r->objects_count);
    snprintf(o->type, sizeof o->type, "%s", e->name);
    o->id = v->id.at && v->id.size ? scene_clean_name(v->id.at, v->id.size) : mem_copy_text(fallback);
    if (!o->id)
        citygml_no_memory(r);
    if (r->object != NONE)
        r->objects[r->object].has_children = true;
    r->object = (int32_t)r->objects_count - 1;
    e->word = CITY_NO_WORD;
    e->lod = -1;
}

static void add_attribute(citygml_reader *r, const char *key, const char *value)
{
    enum { ATTRIBUTES_MAX = 4096 };
    gml_object *o = &r->objects[r->object];
    if (o->attribute_count == ATTRIBUTES_MAX)
        return;
    attribute *grown = mem_realloc(o->attributes, (o->attribute_count + 1) * sizeof *grown);
    if (!grown) {
        citygml_no_memory(r);
        return;
    }
    o->attributes = grown;
    char *name = scene_clean_name(key, strlen(key)), *text = scene_clean_name(value, strlen(value));
    if (name && text && attribute_make(&grown[o->attribute_count], name, text))
        o->attribute_count++;
    else
        citygml_no_memory(r);
    mem_free(name);
    mem_free(text);
}

static bool is_metre(const char *uom)
{
    return !uom[0] || strcmp(uom, "m") == 0 || ends_with(uom, ":m") || ends_with(uom, "#m") || ends_with(uom, "/m") ||
           strcmp(uom, "metre") == 0;
}

static void put_attribute(citygml_reader *r, const char *key, const char *value)
{
    char name[180];
    if (r->object == NONE || !key[0] || !value[0])
        return;
    add_attribute(r, key, value);
    if (!is_metre(r->uom)) {
        snprintf(name, sizeof name, "%s.uom", key);
        add_attribute(r, name, r->uom);
    }
}

/* --- geometry ------------------------------------------------------------------------------------------- */

static int32_t owner_of(const citygml_reader *r)
{
    return r->template_index != NONE ? -2 - r->template_index : r->object;
}

static void add_point(citygml_reader *r)
{
    bool     local = r->template_index != NONE;
    double **list = local ? &r->template_points : &r->points;
    size_t  *count = local ? &r->template_points_count : &r->points_count;
    size_t  *capacity = local ? &r->template_points_capacity : &r->points_capacity;
    if (!mem_grow((void **)list, capacity, *count + 3, sizeof **list)) {
        citygml_no_memory(r);
        return;
    }
    memcpy(*list + *count, r->point, sizeof r->point);
    *count += 3;
    if (*count / 3 > LIMIT_VERTICES)
        citygml_fail(r, LMN_LIMIT, "more than %zu vertices", LIMIT_VERTICES);
}

/* Points of the list that is filled now. */
static uint32_t point_count(const citygml_reader *r)
{
    return (uint32_t)((r->template_index != NONE ? r->template_points_count : r->points_count) / 3);
}

static void end_number(citygml_reader *r)
{
    double value = 0;
    if (r->carry_size == 0)
        return;
    const char *end = r->carry + r->carry_size;
    if (text_parse_double(r->carry, end, &value) != end || !isfinite(value))
        value = NAN; /* the point is none */
    r->carry_size = 0;
    r->point[r->coordinate++] = value;
    if ((int)r->coordinate < r->dimension)
        return;
    for (size_t k = r->coordinate; k < 3; k++)
        r->point[k] = 0;
    r->coordinate = 0;
    if (r->in_polygon)
        add_point(r);
}

static void read_numbers(citygml_reader *r, const char *bytes, size_t size)
{
    for (size_t i = 0; i < size && r->status == LMN_OK; i++) {
        char c = bytes[i];
        if (c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == ',')
            end_number(r);
        else if (r->carry_size < sizeof r->carry - 1)
            r->carry[r->carry_size++] = c;
    }
}

static void end_ring(citygml_reader *r)
{
    gml_ring *ring = GML_APPEND(r, rings);
    if (ring)
        *ring = (gml_ring){r->ring_first, point_count(r) - r->ring_first, r->ring_id};
}

static void end_polygon(citygml_reader *r, const gml_element *e)
{
    gml_polygon *p = GML_APPEND(r, polygons);
    if (p)
        *p = (gml_polygon){.ring_end = (uint32_t)r->rings_count,
                           .owner = owner_of(r),
                           .lod = e->lod < 0 ? 1 : e->lod,
                           .word = e->word,
                           .in_solid = r->in_solid,
                           .inner = r->inner_ring,
                           .material = NONE};
    r->in_polygon = false;
}

static void add_range(citygml_reader *r, gml_id id, uint32_t first)
{
    if (!id || first == r->polygons_count)
        return;
    gml_range *range = GML_APPEND(r, ranges);
    if (range)
        *range = (gml_range){id, first, (uint32_t)r->polygons_count};
}

static void add_reference(citygml_reader *r, const gml_element *e, gml_id id)
{
    gml_reference *f = GML_APPEND(r, references);
    if (f)
        *f = (gml_reference){id, owner_of(r), e->lod, e->word};
}

static void open_instance(citygml_reader *r, const gml_element *e)
{
    gml_instance *i = GML_APPEND(r, instances);
    if (!i)
        return;
    *i = (gml_instance){.owner = r->object, .lod = e->lod < 0 ? 1 : e->lod, .template_index = NONE};
    for (int k = 0; k < 4; k++)
        i->matrix[5 * k] = 1;
}

static void read_matrix(citygml_reader *r, const char *words)
{
    double      matrix[16];
    const char *at = words, *end = words + strlen(words);
    for (int k = 0; k < 16; k++) {
        while (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t')
            at++;
        at = text_parse_double(at, end, &matrix[k]);
        if (!at || !isfinite(matrix[k])) {
            r->builder.tally.bad_geometry++;
            return;
        }
    }
    memcpy(r->instances[r->instances_count - 1].matrix, matrix, sizeof matrix);
}

static void set_crs(citygml_reader *r, gml_value name)
{
    if (r->scene->city.crs || !name.at || !name.size)
        return;
    r->scene->city.crs = scene_clean_name(name.at, name.size);
    if (!r->scene->city.crs)
        citygml_no_memory(r);
}

/* --- opening -------------------------------------------------------------------------------------------- */

static void open_numbers(citygml_reader *r, const gml_values *v)
{
    r->numbers = true;
    r->carry_size = r->coordinate = 0;
    if (v->srs_dimension.at)
        r->dimension = v->srs_dimension.size == 1 && v->srs_dimension.at[0] == '2' ? 2 : 3;
}

static bool is_generic(const char *name)
{
    return ends_with(name, "Attribute") && strcmp(name, "genericAttribute") != 0 &&
           strcmp(name, "_genericAttribute") != 0;
}

static void collect(citygml_reader *r, const gml_values *v)
{
    r->collects = true;
    r->words.size = 0;
    if (r->words.data)
        r->words.data[0] = '\0';
    copy_value(r->uom, sizeof r->uom, v->uom);
}

/* Elements that nothing else names: lod…, attributes, words of an appearance. */
static void open_other(citygml_reader *r, gml_element *e, const gml_element *above, const gml_values *v)
{
    uint8_t word = city_word_of_class(e->name, strlen(e->name));
    char    uri[256], ring[256];
    copy_value(uri, sizeof uri, v->uri.at ? v->uri : v->href);
    copy_value(ring, sizeof ring, v->ring);
    if (citygml_open_appearance(r, e->name, uri, ring)) {
        collect(r, v);
    } else if (strncmp(e->name, "lod", 3) == 0 && e->name[3] >= '0' && e->name[3] < '0' + GML_LODS) {
        e->lod = (int8_t)(e->name[3] - '0');
    } else if (is_generic(e->name)) {
        e->kind = GML_ATTRIBUTE;
        copy_value(r->generic, sizeof r->generic, v->name);
    } else if (r->object != NONE && word != CITY_NO_WORD) {
        e->kind = GML_SURFACE;
        e->word = word;
    } else if (above->kind == GML_OBJECT || above->kind == GML_ATTRIBUTE ||
               strcmp(e->name, "transformationMatrix") == 0) {
        collect(r, v);
        e->kind = GML_TEXT;
    }
}

static void open_kind(citygml_reader *r, gml_element *e, const gml_element *above, const gml_values *v)
{
    switch (e->kind) {
    case GML_OBJECT: open_object(r, e, v); break;
    case GML_GEOMETRY: r->in_solid = r->in_solid || ends_with(e->name, "Solid") || strcmp(e->name, "Solid") == 0; break;
    case GML_POLYGON: r->in_polygon = true; break;
    case GML_RING:
        r->ring_id = v->id.at ? gml_id_of(v->id.at, v->id.size) : 0;
        r->ring_first = point_count(r);
        break;
    case GML_NUMBERS: open_numbers(r, v); break;
    case GML_INSTANCE: open_instance(r, e); break;
    case GML_TEMPLATE:
        if (r->instances_count == 0 || r->template_index != NONE)
            break;
        r->instances[r->instances_count - 1].id = local_id(v->href);
        r->template_index = (int32_t)r->template_count;
        break;
    default: open_other(r, e, above, v); break;
    }
}

void citygml_open_element(citygml_reader *r, const char *name, int attribute_count, const unsigned char **attributes)
{
    static const gml_element outside = {.lod = -1, .word = CITY_NO_WORD};
    if (r->status != LMN_OK)
        return;
    if (r->depth == LIMIT_XML_DEPTH) {
        citygml_fail(r, LMN_LIMIT, "elements are nested deeper than %d", LIMIT_XML_DEPTH);
        return;
    }
    gml_element       *e = &r->stack[r->depth];
    const gml_element *above = r->depth ? &r->stack[r->depth - 1] : &outside;
    *e = (gml_element){.lod = above->lod, .word = above->word};
    snprintf(e->name, sizeof e->name, "%s", name);
    if (r->depth)
        r->stack[r->depth - 1].has_children = true;
    r->range_starts[r->depth] = (uint32_t)r->polygons_count;
    r->range_ids[r->depth] = 0;
    r->depth++;
    bool interior = is_among(interiors, name);
    if (!r->skip_depth && (interior || is_among(others, name))) {
        r->skip_depth = r->depth;
        r->interiors += interior;
    }
    if (r->skip_depth)
        return;
    e->kind = (uint8_t)kind_of(name);
    gml_values v = values_of(attribute_count, attributes);
    set_crs(r, v.srs_name);
    if (strcmp(name, "interior") == 0 && strcmp(above->name, "Solid") == 0)
        r->inner_ring = true;
    open_kind(r, e, above, &v);
    if (v.id.at && (e->kind == GML_GEOMETRY || e->kind == GML_POLYGON))
        r->range_ids[r->depth - 1] = gml_id_of(v.id.at, v.id.size);
    if (local_id(v.href) && e->lod >= 0 && r->object != NONE && e->kind != GML_TEMPLATE && e->kind != GML_TEXT)
        add_reference(r, e, local_id(v.href));
}

/* --- closing -------------------------------------------------------------------------------------------- */

static void close_text(citygml_reader *r, const gml_element *e, const gml_element *above)
{
    const char *words = r->words.data ? r->words.data : "";
    while (*words && strchr(" \t\r\n", *words))
        words++;
    size_t size = strlen(words);
    while (size && strchr(" \t\r\n", words[size - 1]))
        size--;
    if (r->words.data)
        r->words.data[(size_t)(words - r->words.data) + size] = '\0';
    bool filled = !e->has_children && size > 0;
    r->collects = false;
    if (citygml_close_appearance(r, e->name, words) || !filled)
        return;
    if (strcmp(e->name, "transformationMatrix") == 0 && r->instances_count)
        read_matrix(r, words);
    else if (above->kind == GML_ATTRIBUTE && strcmp(e->name, "name") == 0)
        snprintf(r->generic, sizeof r->generic, "%s", words);
    else if (above->kind == GML_ATTRIBUTE && strcmp(e->name, "value") == 0)
        put_attribute(r, r->generic, words);
    else if (above->kind == GML_OBJECT)
        put_attribute(r, e->name, words);
}

static void close_numbers(citygml_reader *r)
{
    end_number(r);
    r->numbers = false;
    r->coordinate = 0;
    if (r->in_polygon || r->instances_count == 0)
        return;
    for (int up = 1; up <= 4 && up < r->depth; up++) /* pos, Point, referencePoint */
        if (strcmp(r->stack[r->depth - up].name, "referencePoint") == 0)
            memcpy(r->instances[r->instances_count - 1].at, r->point, sizeof r->point);
}

static void close_template(citygml_reader *r)
{
    if (r->template_index == NONE || r->instances_count == 0)
        return;
    r->template_index = NONE;
    uint32_t first = r->range_starts[r->depth];
    if (first == r->polygons_count)
        return;
    r->instances[r->instances_count - 1].template_index = (int32_t)r->template_count++;
}

void citygml_close_element(citygml_reader *r)
{
    static const gml_element outside = {.lod = -1, .word = CITY_NO_WORD};
    if (r->status != LMN_OK || r->depth == 0)
        return;
    gml_element        e = r->stack[--r->depth];
    const gml_element *above = r->depth ? &r->stack[r->depth - 1] : &outside;
    if (r->skip_depth) {
        r->skip_depth = r->skip_depth > r->depth ? 0 : r->skip_depth;
        return;
    }
    switch (e.kind) {
    case GML_OBJECT: r->object = r->object == NONE ? NONE : r->objects[r->object].parent; break;
    case GML_GEOMETRY:
        if (ends_with(e.name, "Solid") || strcmp(e.name, "Solid") == 0)
            r->in_solid = false;
        break;
    case GML_POLYGON:
        if (r->in_polygon)
            end_polygon(r, &e);
        break;
    case GML_RING:
        if (r->in_polygon)
            end_ring(r);
        break;
    case GML_NUMBERS: close_numbers(r); break;
    case GML_TEMPLATE: close_template(r); break;
    default: break;
    }
    if (strcmp(e.name, "interior") == 0 && strcmp(above->name, "Solid") == 0)
        r->inner_ring = false;
    if (strcmp(e.name, "libraryObject") == 0)
        r->foreign++;
    if (r->collects || e.kind == GML_TEXT)
        close_text(r, &e, above);
    else
        citygml_close_appearance(r, e.name, "");
    add_range(r, r->range_ids[r->depth], r->range_starts[r->depth]);
}

void citygml_characters(citygml_reader *r, const char *bytes, size_t size)
{
    if (r->status != LMN_OK || r->skip_depth)
        return;
    if (r->numbers) {
        read_numbers(r, bytes, size);
    } else if (r->collects && r->words.size < GML_TEXT_MAX) {
        text_append_bytes(&r->words, bytes, size);
        if (r->words.failed)
            citygml_no_memory(r);
    }
}
