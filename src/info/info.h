/* What a scene consists of, for people and programs. */
#ifndef LIMNER_INFO_INFO_H
#define LIMNER_INFO_INFO_H

#include "scene/scene.h"

/* The scene as JSON text (docs/reference/info.md); free with mem_free. NULL when memory is gone. */
char *scene_info_json(const lmn_scene *scene);

#endif
