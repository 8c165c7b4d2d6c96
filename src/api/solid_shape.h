/* Inside the api folder: shapes that callers describe. */
#ifndef LIMNER_API_SOLID_SHAPE_H
#define LIMNER_API_SOLID_SHAPE_H

#include "limner/solid.h"
#include "scene/scene.h"

/* Checks a shape and makes its mesh; the result is the caller's. Errors: LMN_USAGE, in the caller's name;
 * LMN_LIMIT, LMN_MEMORY. */
lmn_status solid_shape_make(mesh *out, const lmn_shape *shape, const char *caller, lmn_error *error);
/* "box" */
const char *solid_shape_name(lmn_shape_kind kind);

#endif
