/* Where two things meet. */
#ifndef LIMNER_DEPICT_MEETING_H
#define LIMNER_DEPICT_MEETING_H

#include "depict/depict_private.h"

/* Where a target touches what it meets; with a partner (NONE: any), between both, and `met` is false where the partner
 * is away from there. */
lmn_status meeting_place(double out[3], bool *met, const depict_job *j, const depict_target *t, int32_t partner,
                         const depict_impact *impact, lmn_error *error);

/* The place of a target's surface that is nearest to a point at a time, and the node that has it. *distance (INFINITY
 * before) and the others stay what they are where it has none. */
lmn_status nearest_place(const double p[3], double best[3], double *distance, int32_t *node_index, const depict_job *j,
                         const depict_target *t, double seconds, lmn_error *error);

#endif
