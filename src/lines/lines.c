/* The table of line techniques and what all of them share. */
#include "lines/lines.h"

#include <math.h>

#include "lines/overshoot.h"

static const char *const contrasts[] = {"none", "double", "adaptive", "directed", "lit", NULL};

static const param common[] = {
    PARAM_COLOUR_ROW(lines_common, colour, .def_colour = {0.09f, 0.10f, 0.12f, 1},
                     .doc = "Colour of profile lines: silhouettes and borders."),
    PARAM_COLOUR_ROW(lines_common, inner_colour, .can_auto = true, .def_auto = true, .auto_from = "colour",
                     .doc = "Colour of inner lines: creases; auto takes colour."),
    PARAM_COLOUR_ROW(lines_common, id_colour, .can_auto = true, .def_auto = true, .auto_from = "colour",
                     .doc = "Colour of lines between parts; auto takes colour."),
    PARAM_FLOAT_ROW(lines_common, width, .def = 1.5, .min = 0, .max = 24, .soft_min = 0.375, .soft_max = 6,
                    .unit = UNIT_PT, .reach = LINES_CROWD_WIDTHS, .doc = "Width of the lines."),
    PARAM_FLOAT_ROW(lines_common, profile_weight, .def = 1, .min = 0, .max = 4, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "Strength of profile lines; 0 hides them."),
    PARAM_FLOAT_ROW(lines_common, inner_weight, .def = 1, .min = 0, .max = 4, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "Strength of inner lines; 0 hides them."),
    PARAM_FLOAT_ROW(lines_common, id_weight, .def = 1, .min = 0, .max = 4, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "Strength of lines between parts; 0 hides them."),
    PARAM_FLOAT_ROW(lines_common, gain, .def = 1, .min = 0, .max = 1000, .soft_min = 0.5, .soft_max = 50,
                    .logarithmic = true, .doc = "Multiplies the detected ink; 1 keeps the operator's formula."),
    PARAM_FLOAT_ROW(lines_common, threshold, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Ink below this fraction is paper; taken off before the gain."),
    PARAM_FLOAT_ROW(lines_common, sharpen, .def = 0, .min = -0.12, .max = 1, .soft_min = -0.12, .soft_max = 0.5,
                    .doc = "Sharpening of the normal-depth buffer before detection; 0.1 gives wider and stronger "
                           "lines, negative values blur."),
    PARAM_ENUM_ROW(
        lines_common, contrast, .names = contrasts, .variant = true,
        .doc =
            "Lines on any ground: none; double adds a second line beside the first; adaptive takes the light or "
            "the dark colour by the ground; directed puts the second line towards the outside; lit on the side of the "
            "first light, the first line away from it."),
    PARAM_COLOUR_ROW(lines_common, light_colour, .def_colour = {1, 1, 1, 1}, .only_if = "contrast",
                     .doc = "The second or the light colour of contrast-aware lines."),
    PARAM_FLOAT_ROW(lines_common, offset_x, .def = 0.75, .min = -12, .max = 12, .soft_min = -3, .soft_max = 3,
                    .unit = UNIT_PT, .only_if = "contrast=double", .doc = "How far the second line lies to the right."),
    PARAM_FLOAT_ROW(lines_common, offset_y, .def = 0.75, .min = -12, .max = 12, .soft_min = -3, .soft_max = 3,
                    .unit = UNIT_PT, .only_if = "contrast=double", .doc = "How far the second line lies down."),
    PARAM_FLOAT_ROW(
        lines_common, suppress, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .only_if = "contrast=adaptive",
        .doc =
            "Luminance step across a line above which the picture shows the edge by itself and the line is left out; "
            "0 keeps all lines."),
    PARAM_FLOAT_ROW(lines_common, blur, .def = 4.5, .min = 0.75, .max = 24, .unit = UNIT_PT,
                    .only_if = "contrast=adaptive", .doc = "Radius in which the ground's brightness is averaged."),
    PARAM_FLOAT_ROW(
        lines_common, dash, .def = 0, .min = 0, .max = 150, .soft_max = 18, .unit = UNIT_PT, .along = true,
        .cpu_only = true,
        .doc = "Length of dashes along the lines, stretched so that lines begin, end and meet with ink; 0 leaves them "
               "unbroken, and a dash no longer than the line is wide becomes a dot."),
    PARAM_FLOAT_ROW(lines_common, gap, .def = 3, .min = 0.375, .max = 150, .soft_max = 18, .unit = UNIT_PT,
                    .along = true, .cpu_only = true, .only_if = "dash", .doc = "Length of the gaps between dashes."),
    PARAM_FLOAT_ROW(lines_common, overshoot, .def = 0, .min = 0, .max = 48, .soft_max = 24, .unit = UNIT_PT,
                    .reach = OVERSHOOT_MOST, .cpu_only = true,
                    .doc = "How far straight lines run on past corners and junctions, as in architects' drafts; it "
                           "varies from line to line, "
                           "and short lines run on less. 0 ends them where they meet."),
    PARAM_FLOAT_ROW(lines_common, halo, .def = 0, .min = 0, .max = 24, .soft_max = 9, .unit = UNIT_PT,
                    .doc = "Gap in lines behind an outline, beside it, so that objects separate; 0 leaves none."),
};

/* Ink of less than this is shading. */
static const float line_ink = 0.15f;

/* One for steps of one pixel, then those of lines/reach.glsl. */
int lines_flood_rounds(const void *values)
{
    int reach = (int)ceilf(0.5f * ((const lines_common *)values)->width + 0.75f), exponent = 0;
    while (1 << (exponent + 1) < reach)
        exponent++;
    return exponent + 2;
}

int lines_style_rounds(const void *values)
{
    const lines_common *lines = values;
    return lines->overshoot > 0 || lines->halo > 0 || lines->dash > 0;
}

static float weight_of(float weight, colour own, colour standard)
{
    float alpha = isnan(own.r) ? standard.a : own.a;
    return alpha > 0 ? weight : 0;
}

void lines_find_ink(uint8_t *ink, const float *edges, size_t count, const lines_common *lines)
{
    float profile = weight_of(lines->profile_weight, lines->colour, lines->colour);
    float inner = weight_of(lines->inner_weight, lines->inner_colour, lines->colour);
    float id = weight_of(lines->id_weight, lines->id_colour, lines->colour);
    for (size_t i = 0; i < count; i++) {
        const float *edge = &edges[4 * i];
        ink[i] =
            (1 - edge[0]) * profile >= line_ink || (1 - edge[1]) * inner >= line_ink || (1 - edge[3]) * id >= line_ink;
    }
}

const target_row lines_targets[LINES_TARGET_COUNT] = {
    {"t_outlines", TEXEL_RGBA16F},
    {"t_nearer_row", TEXEL_RGBA16F},
    {"t_filtered", TEXEL_RGBA16F, .filtered = true, .empty = {0, 0, 1, 1}},
    {"t_gradient", TEXEL_RGBA16F},
    {"t_feet", TEXEL_RGBA16F},
    {"t_tiles", TEXEL_R8, SCALE_TILE},
    {"t_seeds", TEXEL_RGBA32UI, .empty = {0xC000C000u, 0xC000C000u, 0xC000C000u, 0}}, /* none */
    {"t_pairs", TEXEL_RGBA16F},
    {"t_bare", TEXEL_RGBA16F, .empty = {1, 1, 1, 1}},
    {"t_thin", TEXEL_RGBA16F, .empty = {1, 1, 1, 1}},
    {"t_whole", TEXEL_RGBA16F, .empty = {1, 1, 1, 1}},
    {"t_styled", TEXEL_RGBA16F, .empty = {1, 1, 1, 1}},
    {"t_crowd", TEXEL_RGBA16F, SCALE_APART, .filtered = true},
    {"t_calm", TEXEL_R8, SCALE_TILE},
};

static const technique *const techniques[] = {
    &lines_discontinuity,    &lines_four_tap, &lines_sobel,   &lines_saito,
    &lines_saito_normalised, &lines_denormal, &lines_id,      &lines_colour,
    &lines_shadow,           &lines_shell,    &lines_strokes,
};

static const pass ink = {.name = "ink",
                         .shader = "lines/ink.frag",
                         .reads = {TARGET_SHADE, TARGET_EDGE, TARGET_DASH, TARGET_GROUND, TARGET_DEPTH},
                         .writes = TARGET_SHADE};

const kind kind_lines = {
    .id = KIND_LINES,
    .name = "lines",
    .doc = "Where lines are, and how they are inked.",
    .techniques = techniques,
    .technique_count = PARAM_COUNT(techniques),
    .standard = NULL,
    .selector_key = "operator",
    .array = true,
    .common = common,
    .common_count = PARAM_COUNT(common),
    .fold = &ink,
};
