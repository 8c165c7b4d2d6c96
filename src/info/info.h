/* What a scene consists of, for people and programs. */
#ifndef LIMNER_INFO_INFO_H
#define LIMNER_INFO_INFO_H

#include "scene/scene.h"

/* The scene as JSON text (docs/reference/info.md); free with mem_free. NULL when memory is gone. */
char *scene_info_json(const lmn_scene *scene);

/* What drives what and when, where it goes and what it is: the scene's behaviour, or where it has none its first clips;
 * the same. */
char *scene_dynamics_json(const lmn_scene *scene);

#endif
