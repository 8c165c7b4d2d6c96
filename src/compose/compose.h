/* The kind "compose": how a figure's layers and lines meet the page. */
#ifndef LIMNER_COMPOSE_COMPOSE_H
#define LIMNER_COMPOSE_COMPOSE_H

#include "technique/technique.h"

extern const kind kind_compose;

extern const technique compose_opaque, compose_superimpose, compose_merged, compose_blueprint, compose_wire,
    compose_xray;

/* How lines look that are behind something. First member of the parameters of every composition of layers; the
 * first four are read by src/plan, which gives them to the line techniques of hidden layers. */
typedef struct layer_style {
    colour hidden_colour;
    float  hidden_width, hidden_dash, hidden_gap;
    float  hidden_opacity, fade, halo, clutter;
    bool   once;
} layer_style;

#define LAYER_STYLE_ROWS                                                                                               \
    PARAM_COLOUR_ROW(layer_style, hidden_colour, .can_auto = true, .def_auto = true, .cpu_only = true,                 \
                     .doc = "Colour of all lines of hidden layers; auto takes those of the visible ones."),            \
        PARAM_FLOAT_ROW(layer_style, hidden_width, .def = 0.75, .min = 0.375, .max = 24, .soft_max = 6,                \
                        .unit = UNIT_PT, .can_auto = true, .def_auto = true, .cpu_only = true,                         \
                        .doc = "Width of hidden lines; auto takes that of the visible ones."),                         \
        PARAM_FLOAT_ROW(                                                                                               \
            layer_style, hidden_dash, .def = 0, .min = 0, .max = 150, .soft_max = 9, .unit = UNIT_PT, .along = true,   \
            .cpu_only = true,                                                                                          \
            .doc = "Length of the dashes of hidden lines, along the line; 0 leaves them as visible lines are."),       \
        PARAM_FLOAT_ROW(layer_style, hidden_gap, .def = 3, .min = 0.375, .max = 150, .soft_max = 18, .unit = UNIT_PT,  \
                        .along = true, .cpu_only = true, .only_if = "hidden_dash",                                     \
                        .doc = "Length of the gaps between the dashes of hidden lines."),                              \
        PARAM_FLOAT_ROW(layer_style, hidden_opacity, .def = 1, .min = 0, .max = 1, .unit = UNIT_FRACTION,              \
                        .doc = "Opacity of the lines of the first hidden layer."),                                     \
        PARAM_FLOAT_ROW(                                                                                               \
            layer_style, fade, .def = 1, .min = 0, .max = 1, .unit = UNIT_FRACTION,                                    \
            .doc = "Every layer's lines have this fraction of the opacity of those in front; 1 keeps all alike."),     \
        PARAM_FLOAT_ROW(                                                                                               \
            layer_style, clutter, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,                                 \
            .doc = "How much what is behind fades by importance: creases before outlines, and more where many lines "  \
                   "are in front; nothing is cut off."),                                                               \
        PARAM_BOOL_ROW(layer_style, once, .def = 1, .variant = true,                                                   \
                       .doc = "An edge that repeats in the next layer is drawn once."),                                \
        PARAM_FLOAT_ROW(                                                                                               \
            layer_style, halo, .def = 0, .min = 0, .max = 12, .soft_max = 4.5, .unit = UNIT_PT,                        \
            .doc = "Gap in farther lines beside nearer ones, as on drawings of crossing tubes; 0 leaves none.")

/* What every composition of layers reads, and the passes behind it. */
#define LAYER_READS                                                                                                    \
    {                                                                                                                  \
        TARGET_SHADE, TARGET_DEPTH, TARGET_EDGE, TARGET_DASH, TARGET_ID, TARGET_GROUND, TARGET_EDGE_BEFORE,            \
            TARGET_NEARER, TARGET_NORMAL_DEPTH, TARGET_UNCERTAINTY, TARGET_OVERSHOOT, TARGET_STROKES, TARGET_MEETING   \
    }
/* A picture that compositions of layers keep for themselves: nearer lines, on the way to TARGET_NEARER. */
#define LAYER_NEARER_ROW TARGET_OWN(0)
#define LAYER_TARGETS    .targets = &layer_nearer_row, .target_count = 1
extern const target_row layer_nearer_row;

/* What the layers behind must know of the lines in front: where they leave a gap, and how crowded the position is. */
#define NEARER_LINES_PASSES(condition)                                                                                 \
    {.name = "nearer lines across",                                                                                    \
     .shader = "compose/nearer_row.frag",                                                                              \
     .reads = {TARGET_EDGE},                                                                                           \
     .writes = LAYER_NEARER_ROW,                                                                                       \
     .when = condition},                                                                                               \
    {                                                                                                                  \
        .name = "nearer lines", .shader = "compose/nearer.frag", .reads = {LAYER_NEARER_ROW, TARGET_NEARER},           \
        .writes = TARGET_NEARER, .when = condition                                                                     \
    }
#define LAYER_PASSES_BEHIND NEARER_LINES_PASSES("halo"), NEARER_LINES_PASSES("clutter&!halo")

#endif
