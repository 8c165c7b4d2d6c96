/* Values of an animation's channels, and the rotations that they need: glTF 2.0, appendix C. */
#ifndef LIMNER_SCENE_CHANNEL_H
#define LIMNER_SCENE_CHANNEL_H

#include "scene/scene.h"

/* One channel's value at a time, `components` numbers. Rotations come out as unit quaternions. Before the first key and
 * behind the last one it stays. */
void animation_channel_at(const animation_channel *c, double seconds, double *out);

/* Makes it unit; the identity where it has no length. */
void quaternion_normalise(double q[4]);
/* Along the shorter arc, at an even speed. */
void quaternion_slerp(const double from[4], const double to[4], double t, double out[4]);

#endif
