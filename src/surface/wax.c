/* wax: a candle's wax. Light goes in, wanders and comes out beside where it fell, so that it wraps around the form,
 * and what is thin lets warm light through. Wrapped light, further in the colours that go deeper: Green, "Real-time
 * approximations to subsurface scattering", GPU Gems 2004. No source of Limner's has it; how thin a position is, is
 * that of a ball, not measured. */
#include "surface/surface.h"

typedef struct wax {
    colour colour, glow;
    float  depth, warmth, shine, model_colour;
} wax;

static const param params[] = {
    PARAM_COLOUR_ROW(wax, colour, .def_colour = {0.97f, 0.92f, 0.80f, 1}, .as_light = true,
                     .doc = "Colour of the wax."),
    PARAM_COLOUR_ROW(wax, glow, .def_colour = {1, 0.62f, 0.27f, 1}, .as_light = true,
                     .doc = "Colour of light that has gone through the wax; its strongest channel goes deepest."),
    PARAM_FLOAT_ROW(wax, depth, .def = 0.6, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How deep light goes, and so how far it wraps around the form; 0 is an opaque surface."),
    PARAM_FLOAT_ROW(wax, warmth, .def = 0.8, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much of the glow shows where the form is thin, towards its border."),
    PARAM_FLOAT_ROW(wax, shine, .def = 0.3, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Strength of the broad highlight."),
    PARAM_FLOAT_ROW(wax, model_colour, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Fraction of the model's own colour in the colour of the wax."),
};

const technique surface_wax = {
    .name = "wax",
    .doc = "Candle wax: soft light that wraps around the form and glows where it is thin.",
    .example = "{\"surface\": {\"technique\": \"wax\", \"colour\": \"#c8402f\", \"glow\": \"#ff7a3c\"}}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(wax),
    .surface = &(const surface_row){.shader = "surface/wax.glsl", .direct = true},
};
