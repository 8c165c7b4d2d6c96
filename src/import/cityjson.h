/* Inside the import folder: CityJSON between those who read it. */
#ifndef LIMNER_IMPORT_CITYJSON_H
#define LIMNER_IMPORT_CITYJSON_H

#include "import/city.h"
#include "import/json_scan.h"

/* The kinds of geometry, in this order: how often lists are nested around the numbers of points. */
typedef enum cityjson_kind {
    KIND_UNKNOWN,
    KIND_POINTS,
    KIND_LINES,
    KIND_SURFACES,
    KIND_SOLID,
    KIND_SOLIDS,
    KIND_INSTANCE
} cityjson_kind;

/* Bytes of the file, in half the room of a json_span: there are many. Size 0: none. */
typedef struct cityjson_span {
    uint32_t at, size;
} cityjson_span;

/* One geometry of an object: where its members are. Instances have a template and a matrix in place of semantics and
 * material. */
typedef struct cityjson_geometry {
    float         lod; /* −1: it has none */
    cityjson_kind kind;
    cityjson_span boundaries, semantics, material, texture;
} cityjson_geometry;

typedef struct cityjson_object {
    cityjson_span id, type, attributes, parent, children;
    uint32_t      first_geometry, geometry_count;
    float         lod;       /* of the geometry that is drawn; −1: none */
    float         below_lod; /* the highest of what is below it */
    int32_t       parent_index, node;
    bool          has_children;
} cityjson_object;

/* Members of a document: the model, or a feature of a sequence. */
typedef struct cityjson_document {
    json_span type, version, transform, metadata, objects, vertices, appearance, templates, extensions;
} cityjson_document;

typedef struct cityjson_template {
    cityjson_span geometry;
    city_meshes   meshes;
    bool          made;
} cityjson_template;

typedef struct cityjson_reader {
    const import_job *job;
    lmn_scene        *scene;
    lmn_status        status; /* the first error stays */
    lmn_error        *error;
    city_builder      builder;
    double            scale[3], translate[3];
    bool              placed; /* the origin is chosen */
    bool              latitude_first;
    float             wish; /* the level of detail asked for; infinity: the highest */

    vec3  *points; /* of the document */
    size_t point_count;

    cityjson_object   *objects;
    size_t             object_count, object_capacity;
    cityjson_geometry *geometries;
    size_t             geometry_count, geometry_capacity;
    uint32_t          *slots; /* ids to objects, open addressing */
    size_t             slot_count;

    cityjson_template *templates;
    size_t             template_count;
    vec3              *template_points;
    size_t             template_point_count;

    /* Of the document's appearance. */
    json_span  material_theme, texture_theme; /* at NULL: the first that a geometry has */
    int32_t   *materials, *textures;          /* materials of the scene; textures are made when they are used first */
    json_span *texture_spans;
    size_t     material_count, texture_count;
    vec2      *uvs;
    size_t     uv_count;

    city_shape shape;
    /* Of the shape that is read: how many faces there are at the end of each shell and solid. */
    size_t  *shell_ends, *solid_shells;
    size_t   shell_count, shell_capacity, solid_count, solid_capacity;
    uint8_t *words; /* of semantic surfaces */
    size_t   word_count, word_capacity;
    float    lods[32];
    size_t   lod_counts[32], lod_count;
} cityjson_reader;

lmn_status cityjson_fail(cityjson_reader *r, lmn_status status, const char *at, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* Makes a scanner's error the reader's. */
bool cityjson_good(cityjson_reader *r, const json_scan *s);
bool cityjson_no_memory(cityjson_reader *r);

cityjson_span cityjson_pack(const cityjson_reader *r, json_span span);
/* at is NULL where there is none. */
json_span cityjson_unpack(const cityjson_reader *r, cityjson_span span);

/* cityjson_points.c: the vertices of a document or of its templates, as the scene has them. */
void cityjson_read_points(cityjson_reader *r, json_span vertices, json_span metadata);
void cityjson_read_plain_points(cityjson_reader *r, json_span vertices, vec3 **out, size_t *count);

/* cityjson_geometry.c: adds what a geometry consists of to the reader's shape; false: left out. */
bool cityjson_read_shape(cityjson_reader *r, const cityjson_geometry *g);
/* Where the members of a geometry are, one after the other. */
void cityjson_scan_geometry(cityjson_reader *r, json_scan *s, cityjson_geometry *out);

/* cityjson_appearance.c */
void cityjson_read_appearance(cityjson_reader *r, json_span appearance);
void cityjson_end_appearance(cityjson_reader *r);
/* The scene's material for a texture; NONE: it cannot be had. */
int32_t cityjson_texture(cityjson_reader *r, size_t index);
/* The theme of a "material" or "texture" that is drawn; its value is left to `s`. False: there is none. */
bool cityjson_find_theme(json_span themes, json_span wanted, json_span *out);

/* cityjson_objects.c: all objects of a document, and the templates that they use. */
void cityjson_read_objects(cityjson_reader *r, json_span objects);
void cityjson_read_templates(cityjson_reader *r, json_span templates);
void cityjson_end_templates(cityjson_reader *r);

#endif
