/* tones: the sum of the lights picks one of a few colours, with hard borders, and facades are laid out on walls.
 * Nienhaus 2005, section 4.8 (n-tone shading, procedural facades); Großmann 2011, section 3.2.1 (a look-up table with
 * any number of steps); rows Großmann 1, C05, C07. */
#include "surface/surface.h"

typedef enum facade_style {
    FACADE_NONE,
    FACADE_AUTO,
    FACADE_RESIDENTIAL,
    FACADE_OFFICE,
    FACADE_INDUSTRIAL
} facade_style;
typedef enum ground_storey { GROUND_STOREY_LIKE, GROUND_STOREY_SHOPS, GROUND_STOREY_BLANK } ground_storey;

static const char *const facade_names[] = {"none", "auto", "residential", "office", "industrial", NULL};
static const char *const ground_storey_names[] = {"like", "shops", "blank", NULL};

typedef struct tones {
    palette palette;
    float   tint, bias;
    int32_t facade, ground_storey;
    float   storey, bay, occupancy, frame, bars;
    colour  glass, lit, frame_colour;
} tones;

static const param params[] = {
    PARAM_PALETTE_ROW(
        tones, palette,
        .def_palette = {3, {{0.42f, 0.45f, 0.52f, 1}, {0.74f, 0.75f, 0.76f, 1}, {0.97f, 0.96f, 0.92f, 1}}},
        .as_light = true, .doc = "The tones, darkest first; light is split evenly between them."),
    PARAM_FLOAT_ROW(tones, tint, .def = 1, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How far the model's own colour tints the tones."),
    PARAM_FLOAT_ROW(tones, bias, .def = 0, .min = -1, .max = 1,
                    .doc = "Moves the borders: positive widens the lit tones."),
    PARAM_ENUM_ROW(tones, facade, .names = facade_names,
                   .doc = "What is laid out on upright faces: windows one by one and a door, bands of glass, or high "
                          "and wide industrial windows; auto: as the building's use is, which the file says (function, "
                          "usage, class, building). As many storeys as the file says (storeysAboveGround, "
                          "building:levels) or as there is room for; calm where they get too small to be seen."),
    PARAM_FLOAT_ROW(tones, storey, .def = 3, .min = 0.01, .max = 1000, .soft_min = 2.4, .soft_max = 6,
                    .only_if = "facade",
                    .doc = "Height of a storey, in the model's unit, where the file does not say how many there are."),
    PARAM_FLOAT_ROW(tones, bay, .def = 3, .min = 0.01, .max = 1000, .soft_min = 1.5, .soft_max = 8, .only_if = "facade",
                    .doc = "Distance of windows along a wall, in the model's unit; a whole number of them fits."),
    PARAM_ENUM_ROW(tones, ground_storey, .names = ground_storey_names, .only_if = "facade",
                   .doc = "What the lowest storey has instead: shop windows, or nothing."),
    PARAM_COLOUR_ROW(tones, glass, .def_colour = {0.36f, 0.44f, 0.53f, 1}, .as_light = true, .only_if = "facade",
                     .doc = "Colour of windows in the lightest tone."),
    PARAM_FLOAT_ROW(tones, occupancy, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .only_if = "facade",
                    .doc = "Fraction of the windows behind which there is light."),
    PARAM_COLOUR_ROW(tones, lit, .def_colour = {1, 0.86f, 0.5f, 1}, .only_if = "facade&occupancy",
                     .doc = "Their colour, in any tone."),
    PARAM_FLOAT_ROW(tones, frame, .def = 0.5, .min = 0, .max = 12, .soft_max = 1.5, .unit = UNIT_PT,
                    .only_if = "facade",
                    .doc = "Width of the line around windows and doors, a tenth of theirs at most; 0: none."),
    PARAM_FLOAT_ROW(tones, bars, .def = 0, .min = 0, .max = 12, .soft_max = 1.5, .unit = UNIT_PT, .only_if = "facade",
                    .doc = "Width of the bars that part windows into panes, once these are large enough to be seen, in "
                           "the colour of frames; 0: none."),
    PARAM_COLOUR_ROW(tones, frame_colour, .def_colour = {0.16f, 0.16f, 0.19f, 1}, .only_if = "facade",
                     .doc = "Its colour."),
};

static mesh_needs needs(const void *values)
{
    return (mesh_needs){.walls = ((const tones *)values)->facade != FACADE_NONE};
}

const technique surface_tones = {
    .name = "tones",
    .doc = "A few flat colours chosen by the light, and facades on walls.",
    .example = "{\"surface\": {\"technique\": \"tones\", \"palette\": [\"#203040\", \"#8090a0\", \"#f0f0e8\"]}}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(tones),
    /* Small triangles shade more than their pixels: what is asked of the light is asked once for each that is seen. */
    .surface = &(const surface_row){.shader = "surface/tones.glsl",
                                    .direct = true,
                                    .deferred_when = "facade",
                                    .detail = "surface/facade.glsl",
                                    .needs = needs},
};
