/* Inside the scene folder: repairing one primitive. */
#ifndef LIMNER_SCENE_CLEAN_H
#define LIMNER_SCENE_CLEAN_H

#include "scene/scene.h"

/* What was found, summed over primitives. */
typedef struct clean_counts {
    uint64_t triangles, degenerate, not_finite, normals, values, unheld;
    uint64_t lines, lines_short, lines_not_finite;
} clean_counts;

/* Drops triangles without area, lines without length and both with vertices that are not finite, then vertices that
 * none of them uses; makes normals unit and other numbers finite; sets the bounds. Indices must be in range. With
 * keep_closed, triangles without area stay when their corners differ: they close the surface between points on one
 * line. False when memory is gone. */
bool primitive_clean(primitive *p, bool keep_closed, clean_counts *counts);

/* Makes animations what posing relies on: times of a channel increase, rotations are unit, no channel of an animation
 * moves what another one of it moves, what moves has no matrix but translation, rotation and scale, and durations are
 * those of the channels. Targets must be in range, times and values finite. Warns of what was changed. False when
 * memory is gone. */
bool animations_clean(lmn_scene *scene);

#endif
