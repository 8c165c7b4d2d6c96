/* opaque: the figure becomes a depth sprite: colour with true depth, so that figures and plain geometry occlude
 * each other per pixel. Lines outside the boundary take the depth of the surface they belong to. Nienhaus 2005,
 * sections 3.7 and 4.7; rows E03, E08, E15, E20. */
#include "compose/compose.h"

static const pass passes[] = {
    {.name = "sprite",
     .shader = "compose/sprite.frag",
     .reads = {TARGET_SHADE, TARGET_DEPTH, TARGET_EDGE, TARGET_ID, TARGET_DASH, TARGET_GROUND, TARGET_UNCERTAINTY,
               TARGET_OVERSHOOT, TARGET_STROKES, TARGET_MEETING},
     .writes = TARGET_PAGE,
     .blend = BLEND_OVER,
     .depth = true},
};

const technique compose_opaque = {
    .name = "opaque",
    .doc = "Colour with true depth, lines on top.",
    .example = "{\"compose\": \"opaque\", \"lines\": \"four-tap\"}",
    .channels = CHANNEL_SHADE,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    /* Detecting here saves writing and reading the map, a tenth of a frame. */
    .compose = &(const compose_row){.merges_when = "contrast=none", .perturbable = true},
};
