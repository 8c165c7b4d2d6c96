/* What the two files about telling moments share. */
#ifndef LIMNER_TRACE_TELLING_PRIVATE_H
#define LIMNER_TRACE_TELLING_PRIVATE_H

#include "trace/telling.h"
#include "trace/trace_private.h"

/* A moment that could be taken. */
typedef struct telling_candidate {
    telling_moment moment;
    double         score;
} telling_candidate;

/* Where the ways of marks on what moves turn, stop or rebound on the page, TELLING_MOST at most.
 * `moves`: per part, which of them go anywhere. Errors: LMN_MEMORY, LMN_FORMAT. */
lmn_status telling_candidates(telling_candidate *out, size_t *count, bool *moves, const telling_options *o,
                              lmn_error *error);

#endif
