/* A time of a scene's animations. */
#ifndef LIMNER_POSE_MOMENT_H
#define LIMNER_POSE_MOMENT_H

#include "scene/scene.h"

enum { CLIPS_AT_ONCE = 16 };

struct pose_deformation;

/* Without clips: at rest. Zero-initialised before it is set, so that equal ones have equal bytes. */
typedef struct moment {
    double   seconds;
    uint32_t clips[CLIPS_AT_ONCE]; /* indices of the scene's animations; where two move one thing the later one does */
    size_t   clip_count;
    double   held_seconds; /* parts that are held are where they are then (pose_hold) */
    uint64_t held;         /* which parts; 0: none */
    /* How what moves is deformed (pose/deform.h), lent; NULL: it is not. Poses that are made of this moment at other
     * times are deformed as they move then. */
    const struct pose_deformation *deformation;
    uint64_t                       deformation_hash;
} moment;

moment moment_at_rest(void);

/* `clips`: names or numbers from 1 on, separated by commas; a name stands for all clips that have it. NULL: the first
 * of each file, or rest when there is none. Times before or after all of a scene's clips are brought to their begin or
 * end, with a warning (`warnings` may be NULL). Errors: LMN_USAGE. */
lmn_status moment_find(moment *out, const lmn_scene *scene, const char *clips, double seconds, warnings *warnings,
                       lmn_error *error);

bool   moment_equal(const moment *a, const moment *b);
double moment_duration(const moment *m, const lmn_scene *scene); /* of the longest clip, seconds */

#endif
