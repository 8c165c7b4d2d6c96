/* Where things that come together touch, from their surfaces alone: the first features that meet when one goes on as it
 * comes, and the normal that these have. */
#ifndef LIMNER_CONTACT_TOUCH_H
#define LIMNER_CONTACT_TOUCH_H

#include "pose/pose.h"

typedef struct touch {
    size_t part;                /* index: whose surface is met */
    double place[3], normal[3]; /* on the own surface; unit, the way that this is pushed */
    double gap;                 /* along the normal, from the place to what is met; below 0 where both overlap */
} touch;

/* What is known of a motion. */
typedef struct touch_motion {
    /* How fast a place of the own surface is, against that of another part there, before both meet. */
    lmn_status (*approach)(double out[3], void *user, size_t part, const double place[3], lmn_error *error);
    /* Is what has been found a contact? Others are looked for where it is none. */
    lmn_status (*accepts)(bool *out, void *user, const touch *found, lmn_error *error);
    void  *user;
    double reach; /* how far apart both may be, or in one another */
    bool   turns; /* places of it go different ways: that counts which is nearest to the other part, not its middle */
} touch_motion;

/* How own parts (a flag each) touch others in a pose. The normal is that of the face which is met, or, where an edge
 * meets an edge, square to both; of spheres (contact/sphere.h), that of the sphere. Where a whole edge or face touches,
 * the place is in its middle. *found is false where nothing is met. Errors: LMN_MEMORY, LMN_CANCELLED, those of the
 * motion. */
lmn_status touch_find(touch *out, bool *found, const pose *p, const bool *own, const bool *others,
                      const touch_motion *motion, lmn_error *error);

#endif
