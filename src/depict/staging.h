/* What the page is fitted to, where nobody gave a camera. */
#ifndef LIMNER_DEPICT_STAGING_H
#define LIMNER_DEPICT_STAGING_H

#include "depict/depict_private.h"

enum { STAGING_MOMENTS = 9 };
/* The moments of the whole at which the scene is measured, seconds. */
double staging_moment(const depict_job *j, int which);

/* What is told of, wherever it goes within its intervals, with room around; empty: nothing says where it is. Errors:
 * those of depict_pose. */
lmn_status staging_find(box3 *out, const depict_job *j, const expression_list *expressions, lmn_error *error);

#endif
