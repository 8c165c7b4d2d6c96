/* superimpose: the third pass of edge enhancement. The parts are drawn again and look the edge map up where they
 * land, so outlines end at the boundary. Nienhaus 2005, sections 4.4 and 4.5; row E08. */
#include "compose/compose.h"

static const pass passes[] = {
    {.name = "superimpose",
     .shader = "lines/ink.glsl",
     .reads = {TARGET_EDGE, TARGET_DASH, TARGET_SHADE, TARGET_DEPTH, TARGET_GROUND},
     .writes = TARGET_PAGE,
     .geometry = true},
};

const technique compose_superimpose = {
    .name = "superimpose",
    .doc = "Draws the parts again with the lines on them; outlines end at the boundary.",
    .example = "{\"compose\": \"superimpose\", \"lines\": \"four-tap\"}",
    .channels = CHANNEL_SHADE,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .compose = &(const compose_row){.merges_when = NULL},
};
