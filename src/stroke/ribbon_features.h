/* Hidden lines by what they are of. A *run* is what of a chain is hidden without a visible stretch in it. Runs of one
 * chain, and those that go on as one another where they end, are one *feature*: the rim of a bore, the edge of a wall,
 * whatever its kind changes to on the way. Features on one piece of surface are a *body*, and bodies are of parts. */
#ifndef LIMNER_STROKE_RIBBON_FEATURES_H
#define LIMNER_STROKE_RIBBON_FEATURES_H

#include "stroke/ribbon_private.h"

typedef struct hidden_run {
    uint32_t first, count;        /* strokes */
    uint32_t feature, body, part; /* numbers; runs of one feature follow each other, and those of one body, one part */
    float    length;
    float    extent; /* of all that is hidden of the body, on paper: the diagonal of its box */
    bool     seen;   /* other lines of the body are visible */
} hidden_run;

typedef struct hidden_runs {
    hidden_run *items;
    size_t      count;
} hidden_runs;

/* All runs that are to be drawn, in the order of importance: parts behind fewer surfaces first, then longer ones; of
 * each its bodies likewise, and of these their features, outlines before creases. Free the items with mem_free. False:
 * out of memory. */
bool hidden_runs_find(hidden_runs *out, const ribbon_job *job);

#endif
