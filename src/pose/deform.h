/* What moves is deformed by how it moves, as illustrators draw it: stretched along its way, squashed where it is
 * stopped, leaning, its rear late or drawn out into teeth. Großmann 2011, sections 2.2.2, 2.3, 3.3.1 and 3.3.4. */
#ifndef LIMNER_POSE_DEFORM_H
#define LIMNER_POSE_DEFORM_H

#include "pose/bend.h"
#include "scene/scene.h"

struct pose;

/* How a part that moves is deformed. Speeds are measured by the length of what moves: lengths a second. */
typedef struct part_deformation {
    double  stretch, squash;               /* at the full speed: how much longer; how much flatter when it is lost */
    double  lean, inertia;                 /* radians: forward at the full speed, back at the full acceleration */
    double  full_speed, full_acceleration; /* lengths a second, and a second squared */
    double  lag, comb;                     /* seconds that the rear, that the tips of the teeth are late */
    int32_t teeth;
    double slit, pan; /* seconds that the top is exposed after the bottom; how far the fastest one is followed, 0 … 1 */
    double drag;      /* seconds that the rear keeps its velocity */
} part_deformation;

/* Of all parts, whose ghosts have the same; who draws makes it of a look. */
typedef struct pose_deformation {
    part_deformation *parts;
    size_t            part_count;
    double            response; /* seconds before and after a time from which velocities are taken */
    uint64_t          hash;     /* of the rest */
} pose_deformation;

bool part_deformation_is_none(const part_deformation *d);
/* Is a part not as a whole where it would be: late or dragged? */
bool part_deformation_bends(const part_deformation *d);
void pose_deformation_release(pose_deformation *d);

/* What becomes of a pose. */
typedef struct deformed_nodes {
    bool      *changed; /* per node */
    mat4      *changes; /* per node, of the world */
    part_bend *bends;   /* per part; NULL: none bends */
    mat4      *joints;  /* of all of these */
    size_t     count;   /* things that are deformed */
    size_t     coarse;  /* things that have too few vertices for their teeth */
} deformed_nodes;

/* Of an undeformed pose whose moment has a deformation. Errors: LMN_MEMORY. Release it also after one. */
lmn_status deformed_nodes_find(deformed_nodes *out, const struct pose *p, lmn_error *error);
void       deformed_nodes_release(deformed_nodes *d);

#endif
