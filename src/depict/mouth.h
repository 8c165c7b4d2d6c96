/* Where somebody speaks, and looks from. */
#ifndef LIMNER_DEPICT_MOUTH_H
#define LIMNER_DEPICT_MOUTH_H

#include "depict/depict_private.h"

typedef struct mouth {
    double at[3];      /* the mouth */
    double head[3];    /* middle of the head */
    double radius;     /* of the head */
    double eyes[2][3]; /* the left one and the right one, as who looks has them */
    double gaze[3];    /* where they look, unit */
    bool   named_eyes; /* nodes say where they are */
} mouth;

/* A node below the target that is called mouth or jaw; else the front of one that is called head; else the top of the
 * target's box. Eyes: the two nodes below it that are called eye and lie farthest apart; else symmetric places at the
 * front of the head, as people have them: as far below the crown as above the chin, two fifths of its breadth apart.
 * Errors: LMN_MEMORY. */
lmn_status mouth_find(mouth *out, const depict_job *j, const depict_target *t, double seconds, lmn_error *error);

#endif
