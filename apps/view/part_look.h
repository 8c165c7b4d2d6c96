/* A look of its own for a part. No window. */
#ifndef LIMNER_VIEW_PART_LOOK_H
#define LIMNER_VIEW_PART_LOOK_H

#include "limner/limner.h"

/* Adds a rule for the part with the techniques and parameters of the first rule of `from`; one that was made so before
 * goes. What holds for whole looks (light, ground …) stays. On an error the look may have the half of it. */
lmn_status part_look_put(lmn_look *look, uint32_t part, const lmn_look *from, lmn_error *error);

#endif
