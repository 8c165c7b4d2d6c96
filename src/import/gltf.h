/* Inside the import folder: the glTF reader's state. The first error sticks in `status`; later calls do nothing. */
#ifndef LIMNER_IMPORT_GLTF_H
#define LIMNER_IMPORT_GLTF_H

#include <jansson.h>

#include "import/import.h"

enum { GLTF_WHERE = 160 };

typedef struct gltf_buffer {
    bool                 asked, missing; /* missing: a warning was given, what needs it is left out */
    const unsigned char *data;
    size_t               size;
    unsigned char       *owned;
    file_data            file;
    char                *name; /* for messages */
} gltf_buffer;

typedef struct gltf_view {
    bool                 asked, missing;
    const unsigned char *data;
    size_t               size, stride; /* stride 0: packed */
    unsigned char       *owned;        /* when it was decompressed */
} gltf_view;

typedef struct gltf_reader {
    const import_job    *job;
    lmn_scene           *scene;
    lmn_error           *error;
    lmn_status           status;
    json_t              *root;
    const unsigned char *chunk; /* the GLB's binary chunk, or NULL */
    size_t               chunk_size;
    gltf_buffer         *buffers;
    gltf_view           *views;
    size_t               buffer_count, view_count;
    int32_t             *mesh_map, *node_map, *image_map; /* index in the file → in the scene, NONE: not there */
    size_t               mesh_count, node_count, image_count;
    size_t               elements, zeros, vertices, triangles, lines, instances; /* read so far, against the limits */
    const char          *missing_buffer;                                         /* the name of the first */
    bool                 nameless_buffer;                                        /* one that names no file is missing */
} gltf_reader;

/* An accessor's data, checked to lie within its view. */
typedef struct gltf_accessor {
    size_t               count, stride;
    int                  components, type; /* type: glTF's component type */
    bool                 normalized;
    const unsigned char *data; /* NULL: zeros */
    json_t              *sparse;
} gltf_accessor;

/* --- gltf_json.c: values with messages that say where --------------------------------------------------- */

lmn_status gltf_fail(gltf_reader *r, lmn_status status, const char *format, ...) __attribute__((format(printf, 3, 4)));
bool       gltf_out_of_memory(gltf_reader *r); /* sets the error; returns false for `return` */
void       gltf_warn(gltf_reader *r, warning_code code, const char *format, ...) __attribute__((format(printf, 3, 4)));
size_t     gltf_count(gltf_reader *r, const char *list);
json_t    *gltf_item(gltf_reader *r, const char *list, size_t index); /* NULL and an error when it is no object */
json_t    *gltf_member(gltf_reader *r, json_t *object, const char *key, json_type type, const char *where);
json_t    *gltf_extension(json_t *object, const char *name);
/* False when the key is absent (or after an error); `count` is what the index must lie below, `what` its list's
 * name. */
bool   gltf_index(gltf_reader *r, json_t *object, const char *key, size_t count, const char *what, const char *where,
                  size_t *out);
bool   gltf_size(gltf_reader *r, json_t *object, const char *key, size_t otherwise, const char *where, size_t *out);
double gltf_number(json_t *object, const char *key, double otherwise);
bool   gltf_true(json_t *object, const char *key);
/* Copies `count` numbers; false and untouched when the key is absent or holds something else. */
bool  gltf_numbers(json_t *object, const char *key, double *out, size_t count);
char *gltf_name(gltf_reader *r, json_t *object);             /* NULL when there is none */
void *gltf_alloc(gltf_reader *r, size_t count, size_t size); /* zeroed */

/* --- gltf_buffer.c -------------------------------------------------------------------------------------- */

/* NULL when missing or after an error. */
const gltf_view *gltf_get_view(gltf_reader *r, size_t index, const char *where);
/* Bytes behind a "data:" or file URI. False when missing (a warning was given) or after an error. `kind` says what. */
bool gltf_load_uri(gltf_reader *r, const char *uri, const char *kind, unsigned char **owned, file_data *file,
                   char **name);
void gltf_release_buffers(gltf_reader *r);

/* --- gltf_accessor.c ------------------------------------------------------------------------------------ */

/* False when its buffer is missing or after an error. */
bool gltf_open_accessor(gltf_reader *r, size_t index, const char *where, gltf_accessor *out);
/* All elements as floats, `components` each: missing ones become 0, a fourth 1. NULL like above; free with
 * mem_free. */
float    *gltf_read_floats(gltf_reader *r, const gltf_accessor *a, int components, const char *where);
uint32_t *gltf_read_integers(gltf_reader *r, const gltf_accessor *a, int components, const char *where);

/* --- gltf_pointer.c ------------------------------------------------------------------------------------- */

/* What a pointer of KHR_animation_pointer leads to: something that is animated, something of a node outside of the
 * drawn scene, or something that is not read. After the nodes, cameras and lights. */
typedef enum gltf_pointer { GLTF_POINTER_FOUND, GLTF_POINTER_OUTSIDE, GLTF_POINTER_UNKNOWN } gltf_pointer;
gltf_pointer gltf_find_pointer(const gltf_reader *r, const char *pointer, animation_path *path, int32_t *target);

/* --- the content ---------------------------------------------------------------------------------------- */

void    gltf_read_materials(gltf_reader *r);
int32_t gltf_get_mesh(gltf_reader *r, size_t index); /* NONE when nothing of it can be drawn or after an error */
void    gltf_read_nodes(gltf_reader *r);
void    gltf_read_cameras(gltf_reader *r);
void    gltf_read_lights(gltf_reader *r);
void    gltf_read_skins(gltf_reader *r);
void    gltf_read_animations(gltf_reader *r);

#endif
