/* Normals over a length on paper (TARGET_FORM), for surfaces that tell tones by the form and not by a mesh's faces. */
#ifndef LIMNER_SURFACE_FORM_H
#define LIMNER_SURFACE_FORM_H

#include "technique/technique.h"

/* So many rounds of the pass for a radius in pixels. */
int form_rounds(double radius);

/* `ROUNDS`: int (*)(const void *values), of the technique. All is spread on half the pixels each way, and then found on
 * each pixel. */
#define FORM_PASSES(ROUNDS)                                                                                            \
    {.name = "form, spread",                                                                                           \
     .shader = "surface/form_spread.frag",                                                                             \
     .reads = {TARGET_FORM_HALF, TARGET_NORMAL_DEPTH, TARGET_ID},                                                      \
     .writes = TARGET_FORM_HALF,                                                                                       \
     .rounds = (ROUNDS),                                                                                               \
     .when = "smoothing>0",                                                                                            \
     .prepares = true},                                                                                                \
    {                                                                                                                  \
        .name = "form", .shader = "surface/form.frag", .reads = {TARGET_FORM_HALF, TARGET_NORMAL_DEPTH, TARGET_ID},    \
        .writes = TARGET_FORM, .when = "smoothing>0", .prepares = true                                                 \
    }

#endif
