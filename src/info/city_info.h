/* The part of `limner info` and of reports that tells about city data. */
#ifndef LIMNER_INFO_CITY_INFO_H
#define LIMNER_INFO_CITY_INFO_H

#include <jansson.h>

#include "scene/scene.h"

/* Where it lies, what it consists of, what was left out or repaired (docs/reference/info.md); null for other models. */
json_t *city_info_json(const lmn_scene *scene);

#endif
