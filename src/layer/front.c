/* front: the visible surface only. Nienhaus 2005, sections 3.6 and 4.7; rows E04, E15, E18. */
#include "layer/layer.h"

static const char *const shading_names[] = {"forward", "deferred", NULL};

static const param params[] = {
    PARAM_BOOL_ROW(front_values, complement, .def = 1, .cpu_only = true,
                   .doc = "Parts that other rules draw take part in edge detection, so that lines appear where they meet this rule's parts."),
    PARAM_ENUM_ROW(front_values, shading, .names = shading_names, .cpu_only = true,
                   .doc = "forward: shaded while the geometry is drawn; deferred: from the G-buffer afterwards, unless the surface technique needs its geometry."),
    PARAM_ENUM_ROW(front_values, evaluation, .names = layer_evaluations, .cpu_only = true,
                   .doc = "Solids: lists sort every fragment of their operands, needs OpenGL 4.3; products work with their normal form, a union of "
                          "intersections and differences; auto takes what is faster. The surfaces are the same."),
};

const technique layers_front = {
    .name = "front", .doc = "The visible surface.", .example = "{\"layers\": \"front\"}",
    .params = params, .param_count = PARAM_COUNT(params), .params_size = sizeof(front_values),
};
