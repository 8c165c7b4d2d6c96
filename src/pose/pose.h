/* Where everything in a scene is at a time, in the world: what drawings read instead of the scene's own nodes, so that
 * nothing but this room knows what moves things. */
#ifndef LIMNER_POSE_POSE_H
#define LIMNER_POSE_POSE_H

#include "pose/deform.h"
#include "pose/moment.h"
#include "scene/scene.h"

/* How a part's mesh is deformed. */
typedef struct part_pose {
    const mat4 *joints; /* NULL: no skin; else from the mesh to the world, and the node's own matrix does not count
                           (glTF 2.0, section 3.7.3.3) */
    size_t           joint_count;
    const float     *weights; /* of morph targets */
    size_t           weight_count;
    const part_bend *bend; /* what of it is late, after all else; NULL: it never bends */
    /* What was posed for the part's box, one a primitive of its mesh; NULL: none. pose_vertices_of reads it. */
    const primitive *primitives;
    posed_vertices  *posed;
    size_t           primitive_count;
} part_pose;

enum { POSE_PAST_MAX = 4 };

typedef struct pose {
    const lmn_scene *scene;
    uint64_t         revision; /* of the scene, when it was posed */
    moment           when;
    mat4            *worlds;     /* per node */
    part_pose       *parts;      /* per part */
    box3            *part_boxes; /* per part, then per ghost: deformed, world axes */
    const box3      *fit_boxes; /* of the same parts: what pictures are fitted to; `part_boxes`, or lent by who poses */
    size_t           part_count, ghost_count;
    struct pose     *at_rest;         /* the same scene when nothing has moved; NULL: it is that */
    struct pose *past[POSE_PAST_MAX]; /* the same scene earlier, at equal steps: which velocities are measured from */
    int          past_count;          /* 0: nobody asks */
    double       past_seconds;        /* how much earlier the last one is */
    box3         box;                 /* of all parts */
    mat4        *joints;              /* of all parts, which point into it */
    float       *weights;             /* of nodes whose weights move; parts point into it */
    mat4        *rigid;               /* per node: where it would be, were it not deformed; NULL: as in worlds */
    part_bend   *bends;               /* per part, which point into it; NULL: none bends */
    mat4        *bend_joints;         /* of all of these */
    size_t       deformed_count;      /* nodes and parts that are deformed by how they move */
    size_t       coarse_count;        /* things that have too few vertices for the teeth that they should have */
    posed_vertices *posed;            /* of all parts' primitives; parts point into it. NULL: nobody asks */
    size_t          posed_count;
    camera         *cameras; /* as the scene's, whose names they borrow */
    light          *lights;
} pose;

/* The scene at a moment. It is lent, and must neither change nor end before the pose. Errors: LMN_MEMORY, LMN_FORMAT
 * (animations put a part where no camera can look). Release it also after one. */
lmn_status pose_create(pose *out, const lmn_scene *scene, const moment *when, lmn_error *error);
void       pose_release(pose *p);

/* Brings a pose to another moment of its scene, which has not changed since: as made anew, but with the memory and the
 * rest that it has. Errors: as above. */
lmn_status pose_move(pose *p, const moment *when, lmn_error *error);

/* Adds `count` poses of earlier times, the last of them `seconds` before, none before the clips' begin; of a scene at
 * rest there are none. Errors: LMN_MEMORY. */
lmn_status pose_add_past(pose *p, double seconds, int count, lmn_error *error);

/* Brings what does not move back to where it is in another pose of the same scene: parts without `moves` (one a part,
 * then one a ghost), and unless all have it, cameras and lights. */
void pose_hold(pose *p, const pose *held, const bool *moves);

/* Says that nothing is deformed although the moment asks for it, or not as it asks. */
void pose_warn_of_rigid(const pose *p, warnings *warnings);

/* Says which parts have no extent because all the joints that they follow have none. */
void pose_warn_of_flat(const pose *p, warnings *warnings);

/* Does the pose move the vertices of this primitive within its mesh? */
bool pose_deforms(const part_pose *pose, const primitive *p);

/* Where nodes would be, were they not deformed by how they move: what tells which way they go. */
const mat4 *pose_rigid_worlds(const pose *p);

/* Can anything move vertices of this part within its mesh? */
bool pose_part_deforms(const part_pose *pose);

/* Positions (and normals; may be NULL in and out) of a primitive in the pose, within its mesh; of skins, in the world.
 * `source` (NULL: all in their order): which vertices. Arrays hold `count` elements. */
void pose_vertices(const part_pose *pose, const primitive *p, const vec3 *normals, const uint32_t *source,
                   uint32_t count, vec3 *out_positions, vec3 *out_normals);

/* The vertices of this primitive in the pose where they are known already, because the part's box was made of them;
 * else NULL. */
const posed_vertices *pose_vertices_of(const part_pose *pose, const primitive *p);

/* Where an instance of a part is: takes its deformed mesh to the world. `instance` is below node_draw_count. */
mat4 pose_instance(const pose *p, size_t part_index, size_t instance);

/* The boxes of parts and ghosts over the whole of a moment's clips, sampled: they hold what pictures of any time show.
 * Free with mem_free. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status pose_swept_boxes(box3 **out, const lmn_scene *scene, const moment *when, lmn_error *error);
/* The same over these times alone, seconds ≥ 0. */
lmn_status pose_boxes_at(box3 **out, const lmn_scene *scene, const moment *when, const double *times, size_t count,
                         lmn_error *error);

#endif
