/* Centre lines (ISO 128-2, line 04.1): the axes of cylinders where they are seen from the side, crosses where they are
 * seen along the axis, and pitch circles. */
#ifndef LIMNER_DRAFT_CENTRES_H
#define LIMNER_DRAFT_CENTRES_H

#include "draft/draw.h"
#include "draft/pitch.h"

/* Lines of the sheet that come before centre lines where both lie on each other: traces of cutting planes. */
typedef struct draft_segments {
    const double (*items)[2][2];
    size_t count;
} draft_segments;

/* `shown`: per cylinder. Cylinders that lean have none, as in pictorial views. Adds up how many lines and circles.
 * Errors: LMN_MEMORY. */
lmn_status draft_centres(const draft_view *v, const draft_cylinders *cylinders, const draft_pitches *pitches,
                         const bool *shown, draft_segments before, uint64_t *count, lmn_error *error);

#endif
