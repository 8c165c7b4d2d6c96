/* What of surfaces goes with a node by itself: parts, or vertices of skins. */
#ifndef LIMNER_BEHAVIOUR_CARRY_H
#define LIMNER_BEHAVIOUR_CARRY_H

#include "scene/scene.h"

/* Does any? Its own part, and with `moved` (a flag a node; NULL: none) those below it that nothing between moves. */
bool node_carries(const lmn_scene *scene, int32_t node_index, const bool *moved);

/* The place of it that is farthest from the node's origin, in the node's axes, of vertices that follow it more than all
 * others: where a limb ends. The origin where there is none. */
void node_tip(const lmn_scene *scene, int32_t node_index, const bool *moved, double out[3]);

#endif
