/* front: the visible surface only. Nienhaus 2005, sections 3.6 and 4.7; rows E04, E15, E18. */
#include "layer/layer.h"

typedef enum layer_shading { SHADING_FORWARD, SHADING_DEFERRED } layer_shading;

typedef struct front_values {
    bool    complement;
    int32_t shading, evaluation;
} front_values;

static const char *const shading_names[] = {"forward", "deferred", NULL};

static const param params[] = {
    PARAM_BOOL_ROW(front_values, complement, .def = 1, .cpu_only = true,
                   .doc = "Parts that other rules draw take part in edge detection, so that lines appear where they "
                          "meet this rule's parts. Where the rule is perturbed or seen through only the lines in which "
                          "surfaces cross, which are found by their depths."),
    PARAM_ENUM_ROW(front_values, shading, .names = shading_names, .cpu_only = true,
                   .doc = "forward: shaded while the geometry is drawn; deferred: from the G-buffer afterwards, unless "
                          "the surface technique needs its geometry."),
    PARAM_ENUM_ROW(front_values, evaluation, .names = layer_evaluations, .cpu_only = true,
                   .doc = "Solids: lists sort every fragment of their operands, needs OpenGL 4.3; products work with "
                          "their normal form, a union of "
                          "intersections and differences; auto takes what is faster. The surfaces are the same."),
};

static void front_layering(layering *out, const void *values)
{
    const front_values *v = values;
    out->complement = v->complement;
    out->deferred = v->shading == SHADING_DEFERRED;
    out->evaluation = v->evaluation;
}

const technique layers_front = {
    .name = "front",
    .doc = "The visible surface.",
    .example = "{\"layers\": \"front\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(front_values),
    .layers = &(const layers_row){.layering = front_layering},
};
