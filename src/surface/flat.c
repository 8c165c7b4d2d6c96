/* flat: one colour, no light. Nienhaus 2005, figures drawn by lines alone; row E23. */
#include "surface/surface.h"

typedef struct flat {
    colour colour;
    float  model_colour;
} flat;

static const param params[] = {
    PARAM_COLOUR_ROW(flat, colour, .def_colour = {1, 1, 1, 1},
                     .doc = "Colour of the surface; a transparent one leaves lines alone."),
    PARAM_FLOAT_ROW(flat, model_colour, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Fraction of the model's own colour."),
};

static bool flat_fill(colour *out, const void *values)
{
    const flat *v = values;
    *out = v->colour;
    return !(v->model_colour > 0);
}

const technique surface_flat = {
    .name = "flat",
    .doc = "One colour without light.",
    .example = "{\"surface\": {\"technique\": \"flat\", \"colour\": \"#eeddcc\"}}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(flat),
    .surface = &(const surface_row){.shader = "surface/flat.glsl", .direct = true, .as_fill = flat_fill},
};
