/* Where somebody speaks. */
#ifndef LIMNER_DEPICT_MOUTH_H
#define LIMNER_DEPICT_MOUTH_H

#include "depict/depict_private.h"

typedef struct mouth {
    double at[3];   /* the mouth */
    double head[3]; /* middle of the head */
    double radius;  /* of the head */
} mouth;

/* A node below the target that is called mouth or jaw; else the front of one that is called head; else the top of the
 * target's box. Errors: LMN_MEMORY. */
lmn_status mouth_find(mouth *out, const depict_job *j, const depict_target *t, double seconds, lmn_error *error);

#endif
