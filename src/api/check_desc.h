/* Inside the api folder: is a description of a drawing in order? */
#ifndef LIMNER_API_CHECK_DESC_H
#define LIMNER_API_CHECK_DESC_H

#include "limner/draw.h"

/* The description whole: what a caller built against an older header did not know has its standard value. Errors:
 * LMN_USAGE. */
lmn_status check_draw_desc(lmn_draw_desc *full, const lmn_draw_desc *given, lmn_error *error);

/* Has the picture no more pixels than the current work may draw? Errors: LMN_LIMIT. */
lmn_status check_pixels(const lmn_draw_desc *desc, lmn_error *error);

#endif
