/* The table of layer techniques. */
#include "layer/layer.h"

const char *const layer_evaluations[] = {"auto", "lists", "products", NULL};

static const technique *const techniques[] = {&layers_front, &layers_peel};

const kind kind_layers = {
    .id = KIND_LAYERS, .name = "layers", .doc = "Which surfaces of a figure are seen.",
    .techniques = techniques, .technique_count = PARAM_COUNT(techniques), .standard = &layers_front,
    .selector_key = "technique",
};
