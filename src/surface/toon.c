/* toon: bands the summed light, then smooths only the borders between bands. Nienhaus 2005, sections 3.4 and 4.6
 * (the shade map is blurred by four samples that cover nine texels); row E12. */
#include "surface/form.h"
#include "surface/surface.h"

typedef struct toon {
    int32_t bands;
    float   softness, gradation, shadow, light, highlight, saturation, smoothing, darkest, lightness, blacks, feather,
        spacing, spotted, reflected;
    colour shade, bright, ink;
    bool   seed_blur;
} toon;

static const param params[] = {
    PARAM_INT_ROW(toon, bands, .def = 3, .min = 1, .max = 16, .soft_min = 2, .soft_max = 6, .unit = UNIT_COUNT,
                  .doc = "Number of flat tones between shadow and full light."),
    PARAM_FLOAT_ROW(toon, softness, .def = 0.75, .min = 0, .max = 6, .soft_max = 2.25, .unit = UNIT_PT,
                    .doc = "Width of the blend across a tone border; 0 is hard."),
    PARAM_FLOAT_ROW(toon, gradation, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How gradually one tone goes over into the next, fraction of the light that a tone stands "
                           "for: 0 is a border, "
                           "1 an even wash."),
    PARAM_FLOAT_ROW(toon, shadow, .def = 0.42, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Brightness of the darkest tone."),
    PARAM_COLOUR_ROW(toon, shade, .def_colour = {1, 1, 1, 1}, .as_light = true,
                     .doc = "Colour of the light that the darkest tone has; lighter ones have less of it."),
    PARAM_COLOUR_ROW(toon, bright, .def_colour = {1, 1, 1, 1}, .as_light = true,
                     .doc = "Colour of the light that the lightest tone has; darker ones have less of it."),
    PARAM_FLOAT_ROW(toon, light, .def = 1, .min = 0, .max = 2, .soft_max = 1.2, .unit = UNIT_FRACTION,
                    .doc = "Brightness of the lightest tone."),
    PARAM_FLOAT_ROW(toon, highlight, .def = 0.5, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Strength of the hard-edged highlight; 0 leaves it out."),
    PARAM_FLOAT_ROW(toon, saturation, .def = 1.1, .min = 0, .max = 3, .soft_max = 2,
                    .doc = "Saturation of the tones; cartoons like more than nature."),
    PARAM_FLOAT_ROW(toon, smoothing, .def = 0, .min = 0, .max = 100, .soft_max = 40, .unit = UNIT_PT,
                    .doc =
                        "Light is smoothed over this radius before tones are told apart, textures over at most 24 pt "
                        "of it, within a part and not across creases: borders of tones no longer follow the faces of "
                        "a mesh; 0 leaves both as they are. Not in what is seen through."),
    PARAM_FLOAT_ROW(toon, darkest, .def = 0, .min = 0, .max = 0.33, .unit = UNIT_FRACTION,
                    .doc = "No fill is shown darker than this, so that ink stays legible on it."),
    PARAM_FLOAT_ROW(toon, lightness, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Mixes the model's colours towards white: a thin wash of them."),
    PARAM_FLOAT_ROW(toon, blacks, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "What is turned away from the first light is filled with ink: 1 all of it, less what is "
                           "turned farther; 0 nothing."),
    PARAM_FLOAT_ROW(toon, feather, .def = 0, .min = 0, .max = 1, .soft_max = 0.3, .unit = UNIT_FRACTION,
                    .doc = "How far tapering strokes reach from the blacks towards the light, fraction of the "
                           "way to what faces it; 0: there are none."),
    PARAM_FLOAT_ROW(toon, spacing, .def = 3.5, .min = 0.5, .max = 50, .soft_max = 9, .unit = UNIT_PT,
                    .only_if = "feather>0", .doc = "Distance of those strokes from each other, at most."),
    PARAM_FLOAT_ROW(toon, spotted, .def = 0, .min = 0, .max = 4, .soft_max = 1, .unit = UNIT_FRACTION,
                    .only_if = "blacks>0",
                    .doc = "How much more is filled with ink in corners and clefts, which see little of the sky "
                           "(scene.occlusion), and of what is dark itself."),
    PARAM_COLOUR_ROW(toon, ink, .def_colour = {13 / 255.0F, 11 / 255.0F, 18 / 255.0F, 1}, .only_if = "blacks>0",
                     .doc = "Ink of the blacks."),
    PARAM_FLOAT_ROW(toon, reflected, .def = 0, .min = 0, .max = 2, .soft_max = 0.6, .unit = UNIT_FRACTION,
                    .doc = "How much lighter the darkest tone is where it looks to what throws light back, opposite "
                           "the first light: a step of its own in the colour of shade; 0: there is none."),
    PARAM_BOOL_ROW(toon, seed_blur, .def = 0,
                   .doc = "Smooths tone borders by blurring the shade map as Nienhaus (2005) does, instead of by the "
                          "border's own distance."),
};

static int rounds_of(const void *values)
{
    return form_rounds((double)((const toon *)values)->smoothing);
}

static const pass passes[] = {
    FORM_PASSES(rounds_of),
    {.name = "blur tones",
     .shader = "surface/toon_blur.frag",
     .reads = {TARGET_SHADE, TARGET_ID},
     .writes = TARGET_SHADE,
     .when = "seed_blur"},
};

const technique surface_toon = {
    .name = "toon",
    .doc = "Flat tones with antialiased borders, from the sum of all lights.",
    .example = "{\"surface\": {\"technique\": \"toon\", \"bands\": 4}, \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(toon),
    .channels = CHANNEL_ID,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    /* Unsmoothed, borders are measured by derivatives, which a G-buffer does not have where two surfaces meet. */
    .surface = &(const surface_row){.shader = "surface/toon.glsl",
                                    .forward_when = "smoothing=0",
                                    .deferred_when = "smoothing>0"},
};
