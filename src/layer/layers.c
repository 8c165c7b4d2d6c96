/* The table of layer techniques. */
#include "layer/layer.h"

const char *const layer_evaluations[] = {"auto", "lists", "products", NULL};

static const technique *const techniques[] = {&layers_front, &layers_peel};

const kind kind_layers = {
    .id = KIND_LAYERS,
    .name = "layers",
    .doc = "Which surfaces of a figure are seen.",
    .techniques = techniques,
    .technique_count = PARAM_COUNT(techniques),
    .standard = &layers_front,
    .selector_key = "technique",
};

layering layering_of(const technique_use *layers)
{
    layering out = {.count = 1, .evaluation = EVALUATION_AUTO, .focus = ""};
    if (layers)
        layers->technique->layers->layering(&out, layers->values);
    return out;
}
