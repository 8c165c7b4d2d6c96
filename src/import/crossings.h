/* Inside the import folder: roads that cross are one surface. */
#ifndef LIMNER_IMPORT_CROSSINGS_H
#define LIMNER_IMPORT_CROSSINGS_H

#include "base/error.h"
#include "scene/scene.h"

/* Says of the rims of roads, where they lie on another road of the same height, and of those of water and green below
 * roads, that they are no edges to be shown, so that a crossing has one outline; faces are cut where that begins and
 * ends. Roads stay parts of their own; those that lie on each other are a few millimetres higher or lower. For scenes
 * that have z up and whose nodes move nothing. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status crossings_join(lmn_scene *scene, lmn_error *error);

#endif
