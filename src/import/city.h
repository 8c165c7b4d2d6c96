/* Inside the import folder: what a city model is, whatever its format, and the way from there to a scene. Readers say
 * what objects there are and hand over their faces; orientation, triangles, nodes and names are made here.
 *
 * An object becomes a node called like its id, with its attributes; below it a node for each kind of surface it has
 * ("roof", "wall" …), so that rules can select these, or its mesh itself when all its surfaces are of one kind. */
#ifndef LIMNER_IMPORT_CITY_H
#define LIMNER_IMPORT_CITY_H

#include "import/import.h"
#include "import/json_scan.h"
#include "scene/city.h"

enum { CITY_INNER = 1 }; /* a face of an inner shell: it looks into the cavity */

typedef struct city_face {
    uint32_t ring_end; /* its rings end before this one; the first is the outline, the others are holes */
    int32_t  material; /* of the scene; NONE: the plain one */
    uint8_t  word;     /* in city_words; CITY_NO_WORD: the object's */
    uint8_t  flags;
} city_face;

/* The geometry of one object, or a template for several. Growing arrays that are used again for the next one. */
typedef struct city_shape {
    uint32_t  *corners; /* numbers of points */
    uint32_t  *rings;   /* where each ring ends in `corners` */
    city_face *faces;
    vec2      *uvs; /* a corner, as many as corners, or none at all */
    size_t     corner_count, ring_count, face_count, uv_count;
    size_t     corner_capacity, ring_capacity, face_capacity, uv_capacity;
    bool       lines; /* rings are lines, and there are no faces */
} city_shape;
void city_shape_clear(city_shape *s);
void city_shape_release(city_shape *s);
bool city_shape_corner(city_shape *s, uint32_t point);
bool city_shape_end_ring(city_shape *s);
bool city_shape_end_face(city_shape *s, int32_t material, uint8_t word, uint8_t flags);

/* What was met, for the report. */
typedef struct city_tally {
    uint64_t degenerate, missing_points, crossing, uneven, turned, no_geometry, no_lod, unknown_types, bad_geometry,
        points, guessed, broken_references, extensions, coarser, cyclic;
} city_tally;

typedef struct city_builder {
    const import_job *job;
    lmn_scene        *scene;
    lmn_error        *error;
    const vec3       *points; /* less the origin, z up */
    size_t            point_count;
    int32_t           plain; /* material */
    city_tally        tally;
    uint64_t          surfaces[64]; /* a word, and behind the last those without one */
    struct terrain   *terrain;      /* NULL: none, or not read yet */
    char              cause[160];   /* what is wrong with the file as such, for when nothing comes of it; "": nothing */
    struct city_scratch *scratch;
} city_builder;

lmn_status city_builder_open(city_builder *b, const import_job *job, lmn_error *error);
/* Puts what was counted into the scene's facts and warnings. Errors: LMN_FORMAT (there is nothing to draw: why). */
lmn_status city_builder_close(city_builder *b, lmn_status status);
/* Reads the terrain that the caller has named, if he has, once the city's place is known. */
lmn_status city_builder_terrain(city_builder *b);
/* Other points from here on, as many. Those of one object at a time are used. */
void city_builder_points(city_builder *b, const vec3 *points, size_t count);

/* A node for an object with its id and class ("Building"); NONE and an error when memory is gone. Links are for the
 * reader to make (city_link). */
int32_t city_object(city_builder *b, char *id, const char *type, size_t type_size);
/* Makes `child` a child of `parent`; false when it would be its own ancestor or has a parent. */
bool city_link(city_builder *b, int32_t parent, int32_t child);
/* Texts are copied. False when memory is gone. */
bool city_attribute(lmn_scene *scene, int32_t node, const char *key, const char *value);
bool city_attribute_sized(lmn_scene *scene, int32_t node, const char *key, size_t key_size, const char *value,
                          size_t value_size);
bool city_attribute_of_spans(lmn_scene *scene, int32_t node, json_span key, json_span value);

/* What a shape becomes: a mesh for each kind of surface. Templates are made once and attached several times. */
typedef struct city_mesh {
    int32_t mesh;
    uint8_t word; /* CITY_NO_WORD: it is not known what it is */
} city_mesh;
typedef struct city_meshes {
    city_mesh *items;
    size_t     count, capacity;
} city_meshes;

/* The same before the scene has them. */
typedef struct city_form {
    primitive *primitives;
    size_t     count;
    uint8_t    word;
} city_form;
typedef struct city_forms {
    city_form *items;
    size_t     count, capacity;
} city_forms;
void city_forms_release(city_forms *forms);

/* Makes the forms of a shape, which is changed on the way, without a look at the scene, so that several threads can,
 * each with a builder of its own: forked from one, and joined to it in the end, which counts what they have met. The
 * rest is as for city_make. */
lmn_status city_form_shape(city_builder *b, city_shape *shape, uint8_t own, bool building, city_forms *out);
lmn_status city_builder_fork(city_builder *out, const city_builder *b, lmn_error *error);
void       city_builder_join(city_builder *b, city_builder *forked);
/* Appends them to the scene, whose they are then. */
lmn_status city_keep(city_builder *b, city_forms *forms, city_meshes *out);

/* Appends the meshes of a shape, which is changed on the way. `own` is the word of the object's class, `building` says
 * that it has an inside. */
lmn_status city_make(city_builder *b, city_shape *shape, uint8_t own, bool building, city_meshes *out);
/* Hangs them from the object's node; with a matrix if it is not NULL. `alone`: nothing else hangs there, so that a
 * single mesh can be the node's own. */
lmn_status city_attach(city_builder *b, int32_t node, const city_meshes *meshes, const mat4 *matrix, bool alone);

/* Bounds of points, some of which may be NaN. Where they are farther apart than any city, a vertex or two lie at the
 * other end of the world: then the middle of most of them is taken. */
void city_extent(double (*points)[3], size_t count, double low[3], double high[3]);
/* Where the origin is to be for points between these bounds: their middle on a round number. */
void city_choose_origin(city_facts *facts, const double low[3], const double high[3]);

/* city_turn.c: makes the faces of a shape look outwards, or up where they enclose nothing. What looks which way is
 * found over the edges that two faces share. *turned counts the faces. False when memory is gone. */
typedef struct city_turner city_turner;
city_turner               *city_turner_new(void);
void                       city_turner_free(city_turner *t);
bool city_turn(city_turner *t, const vec3 *points, city_shape *shape, bool building, uint64_t *turned);

/* city_triangles.c: cuts a face into triangles, whose corners are numbers in `shape->corners`, three each, appended to
 * *out. False when memory is gone. A face without area gives none. */
typedef struct city_triangles {
    uint32_t *corners;
    size_t    count, capacity;
} city_triangles;
typedef enum city_cut {
    CITY_CUT_WELL,
    CITY_CUT_CROSSING,
    CITY_CUT_UNEVEN,
    CITY_CUT_NOTHING,
    CITY_CUT_NO_MEMORY
} city_cut;
city_cut city_triangulate(city_triangles *out, const vec3 *points, const city_shape *shape, size_t face);
/* Where a face's rings begin. */
size_t city_first_ring(const city_shape *shape, size_t face);
size_t city_first_corner(const city_shape *shape, size_t ring);
/* Newell's normal, twice as long as the area, of the outline. */
void city_normal(const vec3 *points, const city_shape *shape, size_t face, double out[3]);

#endif
