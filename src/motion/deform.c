/* deform: nothing but the shape of what moves tells so; what the kind has in common says how. Großmann 2011, sections
 * 2.2.2, 2.3, 3.3.1 and 3.3.4; rows 14, 27, 32, 77i. */
#include "motion/motion.h"

typedef struct deform_values {
    motion_common common;
} deform_values;

const technique motion_deform = {
    .name = "deform",
    .doc = "The shape of what moves alone: stretched, squashed, leaning, late, as motion.stretch and the others say.",
    .example = "{\"motion\": {\"technique\": \"deform\", \"stretch\": 0.5, \"squash\": 0.4}, \"surface\": \"toon\", "
               "\"lines\": \"discontinuity\"}",
    .params_size = sizeof(deform_values),
    .motion = &(const motion_row){.traces = false},
};
