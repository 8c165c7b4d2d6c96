/* merged: edge detection inside the shading pass, without a full-screen pass; an explicit comparison with the first
 * pass's depth keeps hidden fragments out of it. Only for line techniques of one pass, others are superimposed.
 * Nienhaus 2005, section 4.7; row E16. */
#include "compose/compose.h"

static const pass passes[] = {
    {.name = "merged",
     .shader = "lines/ink.glsl",
     .reads = {TARGET_DEPTH, TARGET_EDGE, TARGET_DASH},
     .writes = TARGET_PAGE,
     .geometry = true},
};

const technique compose_merged = {
    .name = "merged",
    .doc = "Detects edges while shading, on visible fragments only.",
    .example = "{\"compose\": \"merged\", \"lines\": \"four-tap\"}",
    .channels = CHANNEL_SHADE,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .compose = &(const compose_row){.merges_when = "contrast=none"},
};
