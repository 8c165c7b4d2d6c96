/* peel: one surface behind the other, nearest first, by (depth, part id, front-facing first): none skipped, none
 * twice. Coincident surfaces of one part with the same facing count once. Two producers give the same layers:
 * peeling draws the geometry once a layer and leaves out what the layer before had; lists draw it once and keep
 * every fragment in a list of its pixel. With a focus, only as many layers are taken as uncover it (depth masking).
 * Nienhaus 2005, sections 5.1, 5.2 and 5.4; rows B01–B05, B09, B10. */
#include "layer/layer.h"

typedef struct peel_values {
    bool        complement;
    int32_t     count, producer, memory, evaluation;
    float       fraction;
    param_words focus;
    float       focus_fraction, rear;
    colour      focus_colour;
    bool        settle_ties;
} peel_values;

static const char *const producers[] = {"auto", "peeling", "lists", NULL};

static const param params[] = {
    PARAM_BOOL_ROW(peel_values, complement, .def = 1, .cpu_only = true,
                   .doc =
                       "Lines where surfaces of parts that other rules draw cross this rule's, found by their depths."),
    PARAM_INT_ROW(peel_values, count, .def = 5, .min = 0, .max = LAYERS_MAX, .soft_max = 16, .unit = UNIT_COUNT,
                  .cpu_only = true, .doc = "Layers that are drawn at most; 0: all there are, up to 256."),
    PARAM_FLOAT_ROW(
        peel_values, fraction, .def = 0, .min = 0, .max = 1, .soft_max = 0.05, .unit = UNIT_FRACTION, .cpu_only = true,
        .doc = "Ends with the first layer that covers less than this fraction of the picture; 0 looks at every layer."),
    PARAM_TEXT_ROW(peel_values, focus, .example = "ball", .is_selector = true,
                   .doc = "Selector of parts to be uncovered: as few layers as show them, and they themselves opaque "
                          "at their true depth."),
    PARAM_FLOAT_ROW(peel_values, focus_fraction, .was = "focus_share", .def = 0.95, .min = 0, .max = 1,
                    .unit = UNIT_FRACTION, .cpu_only = true, .only_if = "focus",
                    .doc = "Fraction of the focus that must be uncovered."),
    PARAM_COLOUR_ROW(peel_values, focus_colour, .def_colour = {0.85f, 0.33f, 0.18f, 1}, .cpu_only = true,
                     .only_if = "focus", .doc = "Colour of the focus; none keeps its own."),
    PARAM_FLOAT_ROW(peel_values, rear, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .only_if = "focus",
                    .doc = "Opacity of the layers behind those that uncover the focus; 0 leaves them out."),
    PARAM_ENUM_ROW(peel_values, producer, .names = producers, .cpu_only = true,
                   .doc = "peeling: the geometry once a layer; lists: once, needs OpenGL 4.3; auto takes what is "
                          "faster. The layers are the same."),
    PARAM_INT_ROW(peel_values, memory, .def = 128, .min = 1, .max = 2048, .soft_min = 16, .soft_max = 512,
                  .cpu_only = true,
                  .doc = "MiB that lists may take, within the driver's limit; what does not fit is drawn in bands, or "
                         "else by peeling."),
    PARAM_BOOL_ROW(peel_values, settle_ties, .def = 0, .cpu_only = true,
                   .doc = "Parts that lie on one another within rounding come in the order of the parts, at every "
                          "pixel the same; else whichever rounding puts in front. By lists alone."),
    PARAM_ENUM_ROW(
        peel_values, evaluation, .names = layer_evaluations, .cpu_only = true,
        .doc =
            "Solids: lists sort every fragment of their operands, needs OpenGL 4.3; products peel them and work with "
            "the normal form of "
            "the tree, a union of intersections and differences; auto takes what is faster. The layers are the same."),
};

static void peel_layering(layering *out, const void *values)
{
    const peel_values *v = values;
    *out = (layering){.complement = v->complement,
                      .evaluation = v->evaluation,
                      .several = true,
                      .count = v->count,
                      .producer = v->producer,
                      .settle_ties = v->settle_ties,
                      .memory = v->memory,
                      .fraction = v->fraction,
                      .focus = v->focus.text,
                      .focus_fraction = v->focus_fraction,
                      .rear = v->rear,
                      .focus_colour = v->focus_colour};
}

const technique layers_peel = {
    .name = "peel",
    .doc = "Several surfaces behind each pixel.",
    .example = "{\"layers\": {\"technique\": \"peel\", \"count\": 3}, \"compose\": \"xray\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(peel_values),
    .layers = &(const layers_row){.layering = peel_layering},
};
