/* What `info` tells of a mesh's edges: can it be printed, does it enclose anything? Freudenberg 2003, section 7.1; row
 * OE-01. */
#ifndef LIMNER_INFO_MESH_INFO_H
#define LIMNER_INFO_MESH_INFO_H

#include <jansson.h>

#include "scene/scene.h"

/* Of the mesh as it is drawn: vertices at one position are one, faces that are there twice count once, those without
 * area not at all. NULL: without memory, or where there are no faces. The caller owns it. */
json_t *mesh_info_json(const mesh *m);

#endif
