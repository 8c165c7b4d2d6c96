/* The kind "lines": where lines are, and how they are inked. */
#ifndef LIMNER_LINES_LINES_H
#define LIMNER_LINES_LINES_H

#include "technique/technique.h"

extern const kind kind_lines;

/* What the pass "dashes" does; see lines/dash.h. */
bool dash_process(const pass_pixels *edges, uint8_t *out, const void *values);

/* What every line technique has. First member of each technique's parameters. */
typedef struct lines_common {
    colour  colour, inner_colour, id_colour, light_colour;
    float   width, profile_weight, inner_weight, id_weight;
    float   gain, threshold, sharpen;
    int32_t contrast;
    float   offset_x, offset_y, suppress, blur;
    float   dash, gap;
} lines_common;

/* Passes that surround an operator's own. Dashes are placed before lines grow: thin ones are traced best. */
#define LINES_PASSES_BEFORE                                                                                           \
    {.name = "prefilter", .shader = "lines/edge/prefilter.frag", .reads = {TARGET_NORMAL_DEPTH},                      \
     .writes = TARGET_NORMAL_DEPTH, .when = "sharpen"}
#define LINES_PASSES_BEHIND                                                                                           \
    {.name = "dashes", .process = dash_process, .reads = {TARGET_EDGE}, .writes = TARGET_DASH, .when = "dash"},       \
    {.name = "grow", .shader = "lines/edge/grow.frag", .reads = {TARGET_EDGE}, .writes = TARGET_EDGE,                 \
     .when = "width>2"},                                                                                              \
    {.name = "ground", .shader = "lines/ground.frag", .reads = {TARGET_SHADE, TARGET_PAGE},                           \
     .writes = TARGET_GROUND, .when = "contrast>1"},                                                                  \
    {.name = "blur ground", .shader = "lines/blur.frag", .reads = {TARGET_GROUND}, .writes = TARGET_GROUND,           \
     .repeat = 2, .when = "contrast>1"}

extern const technique lines_discontinuity, lines_four_tap, lines_sobel, lines_saito, lines_saito_normalised,
    lines_denormal, lines_id, lines_colour;

#endif
