/* Indication: a picture on the texture coordinates that asks for more strokes where it is dark and for fewer where it
 * is light. Freudenberg 2003, sections 5.3.5 and 6.4; rows IM-15, IM-16, EX-28. */
#ifndef LIMNER_SURFACE_INDICATION_H
#define LIMNER_SURFACE_INDICATION_H

#include "base/mip_chain.h"
#include "base/text.h"

/* Is it a picture of a kind that can be read, or the word checker? Errors: LMN_USAGE. */
lmn_status indication_check(const char *name, lmn_error *error);
/* All that it is made from. */
void indication_describe(text *out, const char *name);
/* Greys, in levels of means; row 0 is v = 0 as glTF counts it, the top of a picture. The caller releases it. Errors:
 * those of image_load, LMN_LIMIT, LMN_MEMORY. */
lmn_status indication_make(mip_chain *out, const char *name, lmn_error *error);

#endif
