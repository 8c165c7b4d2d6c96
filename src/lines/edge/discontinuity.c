/* discontinuity: lines where visibility, orientation or part changes, whatever the slant of the surfaces. Goes past
 * the operators of Nienhaus 2005 (4.3) and Müller (2.2), whose depth differences also answer to a plane seen at a
 * grazing angle: here a depth step counts only as far as the slopes on both of its sides do not explain it. Window
 * depth is affine in screen space on any plane, so a plane gives exactly nothing. Rows E19, E22, and the edge-set
 * test. */
#include "lines/lines.h"
#include "stroke/ribbon.h"

typedef struct discontinuity {
    lines_common common;
    float        step, slope, crease, faint, meet, crease_width, cover, round;
    bool         parts;
} discontinuity;

static const param params[] = {
    PARAM_FLOAT_ROW(discontinuity, step, .def = 0.0006, .min = 0.00001, .max = 1, .soft_min = 0.0001, .soft_max = 0.1,
                    .unit = UNIT_FRACTION, .logarithmic = true,
                    .doc = "Smallest depth step that is a profile line, as a fraction of the figure's depth range."),
    PARAM_FLOAT_ROW(discontinuity, slope, .def = 1.25, .min = 0, .max = 10, .soft_max = 3,
                    .doc = "How much more than the steeper slope beside it a depth step must be, as a multiple of that "
                           "slope; less finds "
                           "more lines in rough terrain, more keeps it quiet."),
    PARAM_FLOAT_ROW(discontinuity, crease, .def = 44, .min = 0, .max = 180, .soft_min = 10, .soft_max = 90,
                    .unit = UNIT_DEGREES, .as_cosine = true,
                    .doc = "Angle between neighbouring normals from which on an inner line is fully drawn."),
    PARAM_FLOAT_ROW(discontinuity, faint, .def = 38, .min = 0, .max = 180, .soft_min = 5, .soft_max = 90,
                    .unit = UNIT_DEGREES, .as_cosine = true,
                    .doc = "Angle below which there is no inner line; between this and crease it fades in."),
    PARAM_FLOAT_ROW(discontinuity, meet, .def = 10, .min = 0, .max = 180, .soft_min = 3, .soft_max = 60,
                    .unit = UNIT_DEGREES, .as_cosine = true,
                    .doc = "The same as crease where two operands of a solid meet: an angle between surfaces that "
                           "are two by construction is no accident of facets."),
    PARAM_FLOAT_ROW(discontinuity, crease_width, .def = 1, .min = 0.1, .max = 2, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "Width of all lines that are no outlines, fraction of the width."),
    PARAM_FLOAT_ROW(discontinuity, cover, .def = 0.3, .min = 0.02, .max = 1, .soft_min = 0.1, .soft_max = 1,
                    .unit = UNIT_FRACTION,
                    .doc = "Lines that crowd get finer, so that they cover no more than this of the page around them; "
                           "at 1 all keep their width."),
    PARAM_FLOAT_ROW(discontinuity, round, .def = 0, .min = 0, .max = 24, .soft_max = 3, .unit = UNIT_PT,
                    .doc =
                        "Outlines, borders and creases of meshes that stand for curves are drawn as curves and leave "
                        "the mesh for it by no more than this."),
    PARAM_BOOL_ROW(discontinuity, parts, .def = 1, .variant = true, .doc = "Draw lines between parts."),
};

static void own_strokes(stroke_options *options, stroke_style *style, const void *values)
{
    lines_as_strokes(options, style, values);
    const discontinuity *lines = values;
    style->cover = lines->cover;
    style->crease_width = lines->crease_width;
    options->round = lines->round;
}

static const pass passes[] = {
    LINES_PASSES_BEFORE,
    {.name = "pairs",
     .shader = "lines/edge/pairs.frag",
     .reads = {TARGET_NORMAL_DEPTH, TARGET_ID, TARGET_DEPTH, TARGET_MEETING},
     .writes = LINES_PAIRS},
    {.name = "crowd",
     .shader = "lines/edge/crowd.frag",
     .reads = {LINES_PAIRS},
     .writes = LINES_CROWD,
     .when = "cover<1"},
    {.name = "blur crowd",
     .shader = "lines/edge/crowd_blur.frag",
     .reads = {LINES_CROWD},
     .writes = LINES_CROWD,
     .repeat = 2,
     .when = "cover<1"},
    {.name = "records",
     .records = true,
     .reads = {TARGET_DEPTH, TARGET_NORMAL_DEPTH, TARGET_ID, LINES_PAIRS, LINES_CROWD},
     .writes = TARGET_EDGE,
     .writes_too = LINES_BARE},
    {.name = "tiles of pairs",
     .shader = "lines/edge/pair_tiles.frag",
     .reads = {LINES_PAIRS, LINES_BARE, LINES_CROWD, TARGET_MEETING},
     .writes = LINES_TILES,
     .writes_too = LINES_CALM},
    /* What records have not drawn. */
    {.name = "feet",
     .shader = "lines/edge/feet.frag",
     .reads = {LINES_PAIRS, LINES_BARE, TARGET_NORMAL_DEPTH, TARGET_ID, TARGET_DEPTH, TARGET_MEETING, LINES_TILES},
     .writes = LINES_THIN,
     .writes_too = LINES_FEET,
     .tiles = LINES_TILES},
    LINES_PASSES_FLOOD(LINES_THIN, LINES_FEET),
    {.name = "spread",
     .shader = "lines/spread.frag",
     .reads = {LINES_THIN, LINES_FEET, LINES_TILES, LINES_SEEDS, LINES_CROWD},
     .writes = TARGET_EDGE,
     .tiles = LINES_TILES,
     .onto = true,
     .blend = BLEND_MIN,
     .with = LINES_BARE},
    {.name = "spread all",
     .shader = "lines/spread.frag",
     .reads = {LINES_THIN, LINES_FEET, LINES_TILES, LINES_SEEDS, LINES_CROWD},
     .writes = TARGET_EDGE,
     .tiles = LINES_TILES,
     .without = LINES_BARE},
    {.name = "calm",
     .shader = "lines/edge/calm.frag",
     .reads = {LINES_PAIRS, LINES_BARE, TARGET_NORMAL_DEPTH, TARGET_ID, TARGET_DEPTH, TARGET_MEETING, LINES_CALM,
               LINES_CROWD},
     .writes = TARGET_EDGE,
     .tiles = LINES_CALM,
     .onto = true,
     .blend = BLEND_MIN,
     .when = "cover<1"},
    /* What is done to whole lines is done to those of pixels, and taken over. */
    {.name = "whole lines",
     .shader = "lines/edge/whole.frag",
     .reads = {LINES_PAIRS},
     .writes = LINES_WHOLE,
     .rounds = lines_style_rounds,
     .stylised = true},
    LINES_PASSES_STYLISE(LINES_WHOLE, LINES_STYLED, LINES_STYLED),
    {.name = "restyle",
     .shader = "lines/edge/restyle.frag",
     .reads = {TARGET_EDGE, LINES_WHOLE, LINES_STYLED},
     .writes = TARGET_EDGE,
     .with = LINES_STYLED,
     .stylised = true},
    LINES_PASSES_HALO,
    LINES_PASSES_CONTRAST,
};

const technique lines_discontinuity = {
    .name = "discontinuity",
    .doc = "Steps of depth that no slope explains, creases by angle, and part borders.",
    .example = "{\"lines\": {\"operator\": \"discontinuity\"}, \"surface\": \"flat\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(discontinuity),
    .channels = CHANNEL_NORMAL_DEPTH,
    .part_channels = CHANNEL_ID,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    LINES_TARGETS,
    .lines = &(const lines_row){.as_strokes = own_strokes},
};
