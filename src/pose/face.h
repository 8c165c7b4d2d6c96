/* Where somebody speaks, and looks from, as far as names and proportions tell. Nienhaus 2005, section 7.9. */
#ifndef LIMNER_POSE_FACE_H
#define LIMNER_POSE_FACE_H

#include "pose/pose.h"

typedef struct face {
    double mouth[3];
    double head[3];                             /* middle of the head */
    double radius;                              /* of the head */
    double eyes[2][3];                          /* the left one and the right one, as who looks has them */
    double gaze[3];                             /* where they look, unit */
    bool   named_mouth, named_head, named_eyes; /* nodes say where they are */
} face;

/* Of the figure at a node and below it. Its mouth: a node below it that is called mouth or jaw; else the front of one
 * that is called head or skull, with what skins hang on it; else the top of the figure's box. Eyes: the two nodes that
 * are called eye and lie farthest apart; else symmetric places at the front of the head, as people have them: as far
 * below the crown as above the chin, two fifths of its breadth apart. Models look along +z (−y where z is up), and
 * heads as they turn from there. Where nothing has a surface the head is at `middle`, of a figure of this radius.
 * Errors: LMN_MEMORY. */
lmn_status face_find(face *out, const pose *p, int32_t node_index, const double middle[3], double radius,
                     lmn_error *error);

#endif
