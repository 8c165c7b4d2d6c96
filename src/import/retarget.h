/* Motion capture that moves a model instead of its own skeleton. */
#ifndef LIMNER_IMPORT_RETARGET_H
#define LIMNER_IMPORT_RETARGET_H

#include "scene/scene.h"

/* When joints of the scene's skins are called like those of the motion, the scene gets an animation that turns them as
 * the motion turns its own, and *done is true: the motion needs no place in the scene any more. Names are compared
 * without what stands in front of a colon and in any case; half of the joints must agree. Where they do not, a warning
 * goes to the motion. Joints turn relative to their rest (import/retarget_pairs.h), which is taken to be the same pose
 * in both. The uppermost joint goes where the motion goes, in steps as long as its legs. On error both scenes are
 * unchanged. Errors: LMN_MEMORY. */
lmn_status retarget_motion(lmn_scene *scene, lmn_scene *motion, const char *file, bool *done, lmn_error *error);

#endif
