/* A matrix taken apart into what animations move. */
#ifndef LIMNER_SCENE_DECOMPOSE_H
#define LIMNER_SCENE_DECOMPOSE_H

#include "scene/scene.h"

/* Translation, rotation (x y z w, unit) and scale of a matrix; a mirrored one has a negative scale, a flat one a scale
 * of 0. False when it is more than that, sheared: then T·R·S keeps the direction of its first axis and the plane of
 * the first two. Of matrices that are not finite, what comes out is finite too. */
bool mat4_decompose(const mat4 *m, double t[3], double r[4], double s[3]);

/* Gives a node that has a matrix translation, rotation and scale instead, with a warning; others stay as they are. */
void node_split_matrix(lmn_scene *scene, int32_t node_index);

#endif
