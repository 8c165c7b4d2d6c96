/* What techniques have in common that draw marks on surfaces: tone, paper, ink, and how marks come and go. Their
 * structs begin with this one. */
#ifndef LIMNER_SURFACE_MARKS_H
#define LIMNER_SURFACE_MARKS_H

#include "marks/marks.h"
#include "technique/technique.h"

typedef struct mark_values {
    int32_t count, pattern_seed;
    float   shadow, light, contrast, texture, fade;
    colour  ink, paper;
    float   paper_tint, paper_light, paper_strokes;
    bool    cull;
} mark_values;

#define MARK_ROWS(COUNT, WHAT)                                                                                         \
    PARAM_INT_ROW(mark_values, count, .def = (COUNT), .min = 1, .max = 1000000, .soft_min = 1000, .soft_max = 200000,  \
                  .logarithmic = true, .unit = UNIT_COUNT, .cpu_only = true,                                           \
                  .doc = WHAT " on the whole figure. Which of them are drawn follows from light and distance; the "    \
                              "more there are, the nearer one can go."),                                               \
        PARAM_INT_ROW(mark_values, pattern_seed, .def = 0, .min = 0, .max = 1000000, .soft_max = 100,                  \
                      .cpu_only = true, .doc = "Another set of the same kind."),                                       \
        PARAM_FLOAT_ROW(mark_values, shadow, .def = 0.05, .min = -1, .max = 1, .soft_min = 0, .unit = UNIT_FRACTION,   \
                        .doc = "Tone without any light: 0 is as black as marks can make it, 1 white."),                \
        PARAM_FLOAT_ROW(mark_values, light, .def = 1.1, .min = -1, .max = 4, .soft_min = 0, .soft_max = 2,             \
                        .unit = UNIT_FRACTION,                                                                         \
                        .doc = "Tone in full light; above 1 the lit side is free of marks for some way."),             \
        PARAM_FLOAT_ROW(mark_values, contrast, .def = 1, .min = 0.1, .max = 8, .soft_max = 3, .logarithmic = true,     \
                        .doc = "Bends the way from shadow to light: above 1 more is dark."),                           \
        PARAM_FLOAT_ROW(mark_values, texture, .toggles = true, .def = 0.4, .min = 0, .max = 1, .unit = UNIT_FRACTION,  \
                        .doc = "Fraction of the model's own brightness, textures too, in the tone."),                  \
        PARAM_FLOAT_ROW(mark_values, fade, .def = 0.15, .min = 0.001, .max = 1, .soft_max = 0.5,                       \
                        .unit = UNIT_FRACTION,                                                                         \
                        .doc = "Marks that come or go grow or shrink over this fraction of their threshold, so that "  \
                               "none appears at once."),                                                               \
        PARAM_COLOUR_ROW(mark_values, ink, .def_colour = {0.09f, 0.09f, 0.11f, 1},                                     \
                         .doc = "Colour of marks. Lighter than the paper, they stand for light instead of shade."),    \
        PARAM_COLOUR_ROW(mark_values, paper, .can_auto = true, .def_auto = true, .auto_ground = true,                  \
                         .doc = "Colour between marks; auto takes the page's ground."),                                \
        PARAM_FLOAT_ROW(mark_values, paper_tint, .toggles = true, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, \
                        .doc = "Fraction of the model's own colour in the paper."),                                    \
        PARAM_FLOAT_ROW(mark_values, paper_light, .def = 1, .min = 0, .max = 1, .unit = UNIT_FRACTION,                 \
                        .only_if = "paper_tint", .doc = "How far light shades that colour; 0 leaves it flat."),        \
        PARAM_FLOAT_ROW(mark_values, paper_strokes, .toggles = true, .def = 0, .min = 0, .max = 100, .soft_max = 30,   \
                        .unit = UNIT_PT, .only_if = "paper_tint",                                                      \
                        .doc = "Width of the strokes of a broad pen that lay that colour, slanting over the page and " \
                               "one over the other: fewer in the light, where paper shows between them; 0: it is "     \
                               "flat. In pictures only."),                                                             \
        PARAM_BOOL_ROW(mark_values, cull, .def = 1, .cpu_only = true,                                                  \
                       .doc = "Leaves out, cluster by cluster, marks that cannot be seen from here. The picture is "   \
                              "the same without; it takes longer.")

typedef struct stipple_values {
    mark_values common;
    float       diameter, grow;
} stipple_values;

typedef struct surface_strokes_values {
    mark_values common;
    int32_t     placed, law, series, tuft, primitive, layout, hiding;
    float       width, scale, length, turn, uneven, taper, repeat, jitter, indication_strength, upright, lean, combed;
    bool        equalised;
    param_words strokes, indication;
} surface_strokes_values;

typedef struct surface_lines_values {
    mark_values common;
    int32_t     series;
    bool        steady;
    float scale, length, uneven, groups, overlap, pressure, patchy, stray, turn, slant, crossed, room, least, widest,
        taper, tip, join, swell, solid;
} surface_lines_values;

typedef enum stroke_placing { PLACED_FORM, PLACED_PLANES, PLACED_UV, PLACED_GRASS } stroke_placing;

/* How marks of a technique look, for who draws them without a GPU; lengths as the values have them. False: the
 * technique has no marks. */
bool surface_mark_style(mark_style *out, const technique_use *use);

#endif
