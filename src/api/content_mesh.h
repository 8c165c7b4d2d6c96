/* Inside the api folder: meshes that callers describe. */
#ifndef LIMNER_API_CONTENT_MESH_H
#define LIMNER_API_CONTENT_MESH_H

#include "limner/content.h"
#include "scene/scene.h"

/* Checks a description and copies it into a primitive, whose material is the given number − 1 (NONE for 0). Errors, in
 * the caller's name: LMN_USAGE, LMN_LIMIT, LMN_MEMORY; then nothing is left. */
lmn_status content_mesh_make(primitive *out, const lmn_scene *scene, const lmn_mesh_desc *desc, const char *caller,
                             lmn_error *error);

/* Copies positions, and unit normals where they are given; both are the caller's. Errors: as above. */
lmn_status content_positions_make(vec3 **positions, vec3 **normals, const float *from_positions,
                                  const float *from_normals, size_t count, const char *caller, lmn_error *error);

#endif
