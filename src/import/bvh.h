/* Inside the import folder: what a BVH file says, between its reader and what makes a scene of it. */
#ifndef LIMNER_IMPORT_BVH_H
#define LIMNER_IMPORT_BVH_H

#include "import/import.h"

/* What a number of a frame is; the axis is the kind modulo 3. */
typedef enum bvh_channel { BVH_X_POSITION, BVH_Y_POSITION, BVH_Z_POSITION, BVH_X_ROTATION } bvh_channel;
enum { BVH_CHANNELS_MAX = 6 };

typedef struct bvh_joint {
    char         *name;   /* NULL: it has none, or it ends a bone (End Site) */
    int32_t       parent; /* index of a joint in front of this one, NONE of a root */
    double        offset[3];
    unsigned char channels[BVH_CHANNELS_MAX]; /* in the order of the file, from BVH_X_POSITION to BVH_X_ROTATION + 2 */
    int           channel_count;
    bool          is_end; /* where a bone ends; no joint of its own */
    int32_t       node;   /* of the scene, NONE of an end */
} bvh_joint;

/* The joints, parents before children, in the order of the file. */
typedef struct bvh_skeleton {
    bvh_joint *joints;
    size_t     count, capacity, channel_count;
} bvh_skeleton;

/* Makes a node of each joint that is no end, and below it a part of each of its bones. Errors: LMN_MEMORY. */
lmn_status bvh_build_skeleton(lmn_scene *scene, bvh_skeleton *skeleton, lmn_error *error);

/* Adds an animation with channels for `frames` keys to the scene, for the joints that have any; NULL when memory is
 * gone. `values` are to be set by bvh_put_frame. */
animation *bvh_add_motion(lmn_scene *scene, const bvh_skeleton *skeleton, size_t frames, double frame_time);
/* Sets the keys of one frame from its numbers, as many as the skeleton has channels. Frames come in order: a rotation
 * takes the one of the two quaternions that is nearer to the one before. */
void bvh_put_frame(animation *motion, const bvh_skeleton *skeleton, size_t frame, const double *numbers);

#endif
