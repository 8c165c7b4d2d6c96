/* Inside the scene folder: the list of parts. */
#ifndef LIMNER_SCENE_PARTS_H
#define LIMNER_SCENE_PARTS_H

#include "scene/scene.h"

/* Numbers the nodes that draw triangles, depth first: names, unique paths, counts and bounds. `prefix` and its
 * slash stand in front of each path (NULL: none), ids start behind `first_id`, `position` moves the bounds (NULL:
 * not). Ghosts come behind the others. The result and its strings belong to the caller. False when memory is gone. */
typedef struct part_list {
    part  *parts;
    size_t part_count, ghost_count;
} part_list;

bool parts_list(const lmn_scene *scene, const char *prefix, uint32_t first_id, const mat4 *position, part_list *out);
/* Puts a prefix and its slash in front of all paths of a list that has none. May it be so, without cutting one? */
bool parts_fit(const part_list *list, const char *prefix);
bool parts_put_below(part_list *list, const char *prefix); /* false when memory is gone */
void parts_release(part *parts, size_t count);

#endif
