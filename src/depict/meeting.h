/* Where two things meet. */
#ifndef LIMNER_DEPICT_MEETING_H
#define LIMNER_DEPICT_MEETING_H

#include "depict/depict_private.h"

/* Where a target touches what it meets; with a partner (NONE: any), between both, and `met` is false where the partner
 * is away from there. */
lmn_status meeting_place(double out[3], bool *met, const depict_job *j, const depict_target *t, int32_t partner,
                         const depict_impact *impact, lmn_error *error);

#endif
