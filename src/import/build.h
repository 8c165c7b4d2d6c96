/* Inside the import folder: what several readers need when they fill a scene. */
#ifndef LIMNER_IMPORT_BUILD_H
#define LIMNER_IMPORT_BUILD_H

#include "import/import.h"

/* Adds a mesh of one primitive and a root node that draws it; takes over what `p` holds, also when it fails. `name`
 * may be NULL and is copied. Errors: LMN_MEMORY. */
lmn_status build_part(lmn_scene *scene, primitive *p, const char *name, lmn_error *error);

/* sRGB 0.8 in linear light: shades stay visible on both white and dark grounds. */
#define BUILD_PLAIN_GREY 0.6038f

/* The material of formats that have none: light neutral grey, white when vertex colours decide. Adds it; NONE when
 * memory is gone. */
int32_t build_plain_material(lmn_scene *scene, bool has_colours);

/* Adds an attribute to a node; copies both. False when memory is gone. */
bool build_attribute(node *n, const char *key, const char *value);

/* Cuts a polygon into corners − 2 triangles with its winding: a fan when it is convex, else by clipping ears.
 * `corners` are vertex numbers in range; `out` has room for 3 · (corners − 2). */
void build_triangulate(const vec3 *positions, const uint32_t *corners, uint32_t count, uint32_t *out);

/* Is there a file beside the model, that it may have? */
bool build_has_file(const import_job *job, const char *name);

/* Loads a file beside the model; one that is missing, or that the model may not have, is a warning that calls it
 * `what`, and out->data is NULL. Errors: LMN_MEMORY. */
lmn_status build_side_file(const import_job *job, const char *what, const char *name, file_data *out, lmn_error *error);

/* Adds the image in a file beside the model. When it is missing or cannot be decoded, that is a warning and *out is
 * NONE. Errors: LMN_MEMORY. */
lmn_status build_image_file(const import_job *job, const char *name, int32_t *out, lmn_error *error);

/* Adds the image in these bytes, called `name` in warnings; otherwise the same. */
lmn_status build_image_bytes(const import_job *job, const char *name, const unsigned char *bytes, size_t size,
                             int32_t *out, lmn_error *error);

/* The number of the line that `at` is on, counted from `from`; 1 for the first. */
int build_line(const char *from, const char *at);

#endif
