/* What of surfaces goes with a node by itself: parts, or vertices of skins. */
#ifndef LIMNER_BEHAVIOUR_CARRY_H
#define LIMNER_BEHAVIOUR_CARRY_H

#include "scene/scene.h"

/* Does any, a part of its own or vertices? */
bool node_carries(const lmn_scene *scene, int32_t node_index);

/* Of all nodes that a flag says to move by themselves: does any, which they do also of parts below them that nothing
 * between moves; and the place of it that is farthest from the node's origin, in the node's axes, of vertices that
 * follow it more than all others: where a limb ends. Arrays of an element a node, 0 before. */
void node_tips(double (*tips)[3], bool *carried, const lmn_scene *scene, const bool *moved);

#endif
