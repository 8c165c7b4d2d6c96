/* Patterns that decide how something is told. Nienhaus 2005, section 7.10. */
#ifndef LIMNER_DEPICT_GROUPS_H
#define LIMNER_DEPICT_GROUPS_H

#include "depict/depict_private.h"

typedef enum group_kind {
    GROUP_NONE,
    GROUP_BURSTS, /* all at once, away from one place to all sides */
    GROUP_SPLITS  /* together first, then apart */
} group_kind;

typedef struct group {
    group_kind kind;
    size_t     things;
} group;

/* What the things right below a node do. Errors: LMN_MEMORY. */
lmn_status group_find(group *out, const depict_job *j, int32_t node, double from, double to, lmn_error *error);
/* Does it turn more than once about its way, rather than roll? Errors: LMN_MEMORY. */
lmn_status spins_along(bool *out, const depict_job *j, int32_t node, double from, double to, lmn_error *error);
/* Does it keep its distance from the other one while it goes on? Errors: LMN_MEMORY. */
lmn_status goes_with(bool *out, const depict_job *j, int32_t node, int32_t other, double from, double to,
                     lmn_error *error);

#endif
