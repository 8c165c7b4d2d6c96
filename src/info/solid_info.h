/* The part of `limner info` that tells about solids. */
#ifndef LIMNER_INFO_SOLID_INFO_H
#define LIMNER_INFO_SOLID_INFO_H

#include <jansson.h>

#include "scene/solid.h"

/* Operands, operations, depth and tree as JSON with these bounds, which it takes over. NULL when memory is gone. */
json_t *solid_info_json(const lmn_scene *scene, const solid *s, json_t *bounds);

#endif
