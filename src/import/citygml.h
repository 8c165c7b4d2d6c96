/* Inside the import folder: CityGML between those who read it. The file is parsed in one pass into flat lists; what
 * refers to what is settled at its end, since references run forwards as well as backwards. */
#ifndef LIMNER_IMPORT_CITYGML_H
#define LIMNER_IMPORT_CITYGML_H

#include "base/limits.h"
#include "base/text.h"
#include "import/city.h"

enum { GML_TEXT_MAX = 65536, GML_LODS = 5 };

/* A hash of a gml:id; 0: none. */
typedef uint64_t gml_id;
gml_id           gml_id_of(const char *bytes, size_t size);

typedef struct gml_ring {
    uint32_t first, count; /* points: of the templates where it belongs to one */
    gml_id   id;
} gml_ring;

typedef struct gml_polygon {
    uint32_t ring_end;
    int32_t  owner; /* object, or −2 − template; NONE: nobody */
    int8_t   lod;
    uint8_t  word;
    bool     in_solid, inner;
    int32_t  material; /* of the scene */
} gml_polygon;

/* Something with an id consists of these polygons. */
typedef struct gml_range {
    gml_id   id;
    uint32_t first, end;
} gml_range;

/* An object's geometry refers to something with an id. */
typedef struct gml_reference {
    gml_id  id;
    int32_t owner;
    int8_t  lod;
    uint8_t word;
} gml_reference;

/* A polygon that an object has from another one, or from another level of detail of its own. */
typedef struct gml_borrowed {
    int32_t  owner;
    uint32_t polygon;
    int8_t   lod;
    uint8_t  word;
} gml_borrowed;

typedef struct gml_instance {
    int32_t owner;
    int8_t  lod;
    int32_t template_index; /* NONE: the one of `id` */
    gml_id  id;
    double  matrix[16], at[3];
} gml_instance;

typedef struct gml_object {
    char      *id;
    char       type[40];
    int32_t    parent, node;
    int8_t     lod, below_lod; /* of the geometry that is drawn, and the highest of its parts; −1: none */
    bool       has_children, is_part;
    attribute *attributes;
    size_t     attribute_count;
} gml_object;

/* What a polygon, or all of something with an id, is painted with. */
typedef struct gml_paint {
    gml_id  target;
    int32_t material; /* of the scene */
} gml_paint;

/* Places in a texture for the points of a ring. */
typedef struct gml_places {
    gml_id   ring;
    int32_t  material;
    uint32_t first, count; /* in uvs */
} gml_places;

#define GML_LIST(type, name)                                                                                           \
    type  *name;                                                                                                       \
    size_t name##_count, name##_capacity

typedef struct gml_element {
    char    name[40];
    uint8_t kind; /* of gml_kind */
    int8_t  lod;  /* inherited from what it is in; −1: none */
    uint8_t word;
    bool    has_children;
} gml_element;

typedef struct citygml_reader {
    const import_job *job;
    lmn_scene        *scene;
    lmn_status        status;
    lmn_error        *error;
    city_builder      builder;
    int               wish; /* highest level of detail */

    gml_element stack[LIMIT_XML_DEPTH];
    int         depth;
    int         skip_depth; /* all in the element at this depth is left out; 0: nothing is */
    int32_t     object;     /* that is read now */
    int32_t     template_index;
    int         dimension;
    bool        in_polygon, in_solid, inner_ring, numbers;
    char        carry[64]; /* of a number that came in pieces */
    size_t      carry_size;
    size_t      coordinate;
    double      point[3];
    text        words;
    bool        collects;
    char        uom[40];
    char        generic[128]; /* the name of a generic attribute */
    gml_id      ring_id;
    uint32_t    ring_first;
    uint32_t    range_starts[LIMIT_XML_DEPTH];
    gml_id      range_ids[LIMIT_XML_DEPTH];

    GML_LIST(double, points); /* three a point */
    GML_LIST(double, template_points);
    GML_LIST(gml_borrowed, borrowed);
    GML_LIST(gml_ring, rings);
    GML_LIST(gml_polygon, polygons);
    GML_LIST(gml_range, ranges);
    GML_LIST(gml_reference, references);
    GML_LIST(gml_instance, instances);
    GML_LIST(gml_object, objects);
    GML_LIST(gml_paint, paints);
    GML_LIST(gml_places, places);
    GML_LIST(vec2, uvs);
    size_t   template_count;
    uint64_t interiors, foreign, borrowed_corners;

    /* Of the appearance that is read: */
    int32_t   material; /* NONE: it cannot be had */
    bool      in_texture, in_material;
    wrap_mode wrap;
    gml_id    target;
    bool      latitude_first;
} citygml_reader;

lmn_status citygml_fail(citygml_reader *r, lmn_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
bool citygml_no_memory(citygml_reader *r);
#define GML_APPEND(r, name)                                                                                            \
    (mem_grow((void **)&(r)->name, &(r)->name##_capacity, (r)->name##_count + 1, sizeof *(r)->name)                    \
         ? &(r)->name[(r)->name##_count++]                                                                             \
         : (citygml_no_memory(r), NULL))

/* citygml_element.c: what the parser meets. */
void citygml_open_element(citygml_reader *r, const char *name, int attribute_count, const unsigned char **attributes);
void citygml_close_element(citygml_reader *r);
void citygml_characters(citygml_reader *r, const char *bytes, size_t size);

/* citygml_appearance.c: elements in appearances. True: it is one of them. */
bool citygml_open_appearance(citygml_reader *r, const char *name, const char *uri, const char *ring);
bool citygml_close_appearance(citygml_reader *r, const char *name, const char *text);

/* citygml_build.c: the lists to a scene. */
void citygml_build(citygml_reader *r);

#endif
