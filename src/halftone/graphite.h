/* What graphite looks like on its own: how dark a lead gets, and the unevenness of what it leaves. Müller, sections
 * 1 and 2.3; rows P10, P29, P32, P33. */
#ifndef LIMNER_HALFTONE_GRAPHITE_H
#define LIMNER_HALFTONE_GRAPHITE_H

#include "base/error.h"
#include "base/mip_chain.h"

/* Leads from the hardest to the softest. */
typedef enum lead_grade {
    LEAD_6H,
    LEAD_5H,
    LEAD_4H,
    LEAD_3H,
    LEAD_2H,
    LEAD_H,
    LEAD_F,
    LEAD_HB,
    LEAD_B,
    LEAD_2B,
    LEAD_3B,
    LEAD_4B,
    LEAD_5B,
    LEAD_6B,
    LEAD_7B,
    LEAD_8B,
    LEAD_COUNT
} lead_grade;
extern const char *const lead_grade_names[LEAD_COUNT + 1]; /* NULL-terminated */

/* The darkest that a lead gets however often it goes over a position, 0 … 1 as the eye counts: 0.36 for 6H, 0.95 for
 * 8B. */
float lead_darkest(lead_grade grade);

/* Side of the pictures that graphite_grain makes, texels. */
enum { GRAPHITE_SIDE = 256 };

/* Two seamless pictures as channels of one, RG8, one level: clouds of gradient noise from 0 to 255, by which old
 * lines fade; and short strokes over each other, 255 where graphite lies thickest. Errors: LMN_MEMORY. */
lmn_status graphite_grain(mip_chain *out, uint32_t seed, lmn_error *error);

#endif
