/* Where two things meet. */
#ifndef LIMNER_DEPICT_MEETING_H
#define LIMNER_DEPICT_MEETING_H

#include "depict/depict_private.h"

/* Where a target touches what it meets: in the middle between its own surface and the one that is there. With a partner
 * (NONE: whatever is near, or nothing) `met` is false where that is away from there. */
lmn_status meeting_place(double out[3], bool *met, const depict_job *j, const depict_target *t, int32_t partner,
                         const depict_impact *impact, lmn_error *error);

/* Does a target hit anything where its velocity changes at once (contact_is_hit), and whom? What only changes its mind
 * touches nothing. */
lmn_status meeting_touches(bool *out, int32_t *other, const depict_job *j, const depict_target *t,
                           const depict_impact *impact, lmn_error *error);

#endif
