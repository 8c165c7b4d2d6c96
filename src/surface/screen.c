/* screen: a halftone screen on the surface, whose grey says up to which light a stroke stays. Freudenberg 2003,
 * sections 6.1 to 6.6; rows IM-02 to IM-20, IM-28 to IM-30. */
#include "surface/indication.h"
#include "surface/on_ground.h"
#include "surface/screen_textures.h"
#include "surface/surface.h"

static const char *const scheme_names[] = {"binary", "smooth", "sharp", "multiply", NULL};
static const char *const indication_names[] = {"add", "limit", NULL};

static const param params[] = {
    HALFTONE_ROWS(COORDINATES_TRIPLANAR),
    HALFTONE_INK_ROWS,
    PARAM_TEXT_ROW(
        screen_values, screen, .example = "dots", .is_file = true, .check = screen_check_name,
        .doc = "The screen: a pattern of strokes (parallel, cross, contour, brick, stipple, scribble, "
               "random), a procedure (lines, dots, ordered, "
               "blue-noise, hatch-map), a file of strokes (.stx, .svg) or a painted one (.png, .jpg, .webp; "
               "NAME-1.png, NAME-2.png … are its layers, NAME-level-1.png and so on its coarser levels, half as "
               "large each, where an artist draws them; paper follows the last); material takes the strokes that lie "
               "beside each "
               "material's picture under its name (.stx). Empty: cross."),
    PARAM_ENUM_ROW(screen_values, scheme, .names = scheme_names, .def = SCHEME_SHARP, .variant = true,
                   .doc = "binary: hard thresholds; smooth: a ramp in the tone (Freudenberg 2003); sharp: a ramp of a "
                          "pixel at any zoom; multiply: all strokes, "
                          "whatever the light, over the lit colour."),
    PARAM_FLOAT_ROW(screen_values, gain, .def = 4, .min = 0.25, .max = 255, .soft_min = 1, .soft_max = 16,
                    .logarithmic = true, .only_if = "scheme=smooth", .doc = "Steepness of the ramp."),
    PARAM_BOOL_ROW(screen_values, centred, .def = 0, .only_if = "scheme=smooth",
                   .doc = "Puts the middle of the ramp at the threshold, which keeps the tone; Freudenberg's ramp ends "
                          "there and is 1 / (2 gain) lighter."),
    PARAM_FLOAT_ROW(screen_values, scale, .def = 5.25, .min = 0.75, .max = 150, .soft_min = 2.25, .soft_max = 30,
                    .unit = UNIT_PT, .doc = "Mean distance of strokes where all are there, or the period."),
    PARAM_FLOAT_ROW(screen_values, width, .def = 1.2, .min = 0.225, .max = 48, .soft_max = 4.5, .unit = UNIT_PT,
                    .doc = "Width of strokes; of no effect on procedures and painted screens."),
    PARAM_FLOAT_ROW(screen_values, repeat, .def = 1, .min = 0.001, .max = 1000, .soft_min = 0.25, .soft_max = 16,
                    .logarithmic = true, .only_if = "coordinates=uv",
                    .doc = "How often the screen is laid into a unit of texture coordinates."),
    PARAM_ENUM_ROW(screen_values, detail, .names = screen_detail_names, .cpu_only = true,
                   .doc =
                       "Far away: kept leaves out whole strokes and keeps the width of others; minimum, average and "
                       "nearest are the textbook's ways, for comparison: fuzzy, grey, and with patterns that are not "
                       "there."),
    PARAM_BOOL_ROW(screen_values, equalised, .def = 1, .cpu_only = true,
                   .doc = "Makes the fraction of ink follow the tone, as far as strokes can cover the surface; between "
                          "levels in sharp schemes."),
    PARAM_FLOAT_ROW(
        screen_values, relief, .def = 0, .min = -8, .max = 8, .soft_min = -2, .soft_max = 2,
        .doc = "Lights each stroke by itself, as a groove (or, below 0, a ridge) this steep: those towards "
               "the light go first. Painted screens take their slopes from NAME-normals.png beside them (red to "
               "the right, green up), times this."),
    PARAM_BOOL_ROW(screen_values, whole, .def = 0, .variant = true, .only_if = "coordinates=uv",
                   .doc = "Each stroke has the light of its middle, so that it is drawn whole or not at all."),
    PARAM_TEXT_ROW(
        screen_values, indication, .is_file = true, .example = "checker", .only_if = "coordinates=uv",
        .check = indication_check,
        .doc =
            "A picture on the texture coordinates (the second ones, where a model has such) that asks for more strokes "
            "where it is dark and fewer where it is light; middle grey changes nothing. checker shows how texture "
            "coordinates lie."),
    PARAM_ENUM_ROW(screen_values, indicate, .names = indication_names, .only_if = "coordinates=uv&indication",
                   .variant = true,
                   .doc = "add: lightens and darkens; limit: the picture is the lightest tone that is allowed, dark "
                          "places stay as they are."),
    PARAM_FLOAT_ROW(screen_values, indication_strength, .def = 1, .min = -8, .max = 8, .soft_min = 0, .soft_max = 2,
                    .only_if = "coordinates=uv&indication", .doc = "Weight of the indication."),
    PARAM_FLOAT_ROW(screen_values, wobble, .toggles = true, .def = 0, .min = 0, .max = 75, .soft_max = 7.5,
                    .unit = UNIT_PT, .along = true, .doc = "How far strokes waver."),
    PARAM_FLOAT_ROW(screen_values, uneven, .toggles = true, .def = 0.04, .min = 0, .max = 1, .soft_max = 0.5,
                    .unit = UNIT_FRACTION, .doc = "Unevenness of the tone."),
    PARAM_INT_ROW(screen_values, frames, .def = 1, .min = 1, .max = 16, .cpu_only = true, .only_if = "change>0",
                  .unit = UNIT_COUNT,
                  .doc = "Screens that follow each other in time, each drawn anew; of patterns only."),
    PARAM_FLOAT_ROW(screen_values, change, .a_second = true, .toggles = true, .def = 0, .min = 0, .max = 60,
                    .soft_max = 12,
                    .doc = "How often a second the screen, the waver and the unevenness change; 0 never."),
    PARAM_INT_ROW(screen_values, pattern_seed, .def = 0, .min = 0, .max = 1000000, .soft_max = 100, .cpu_only = true,
                  .doc = "Another pattern of the same kind."),
};

static const texture_source textures[] = {
    {.name = "screen", .describe = screen_describe, .make = screen_make, .kept = true},
    {.name = "curve",
     .when = "scheme=sharp&equalised",
     .describe = screen_describe,
     .make = screen_make_curve,
     .kept = true},
    {.name = "relief", .when = "relief", .describe = screen_describe, .make = screen_make_relief, .kept = true},
    {.name = "warp",
     .when = "whole&coordinates=uv",
     .describe = screen_describe,
     .make = screen_make_warp,
     .kept = true},
    {.name = "indication",
     .when = "coordinates=uv&indication",
     .describe = screen_describe_indication,
     .make = screen_make_indication},
};

static const pass passes[] = {HALFTONE_PASSES};

const technique surface_screen = {
    .name = "screen",
    .doc = "A halftone screen on the surface: strokes, dots or a painted texture that come and go with the tone.",
    .example = "{\"surface\": {\"technique\": \"screen\"}, \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(screen_values),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .textures = textures,
    .texture_count = PARAM_COUNT(textures),
    .surface = &(const surface_row){.shader = "surface/screen.glsl",
                                    .direct = true,
                                    .light_map_when = "whole&coordinates=uv",
                                    .forward_when = HALFTONE_FORWARD_WHEN,
                                    .deferred_when = HALFTONE_DEFERRED_WHEN,
                                    .on_ground = draws_ground,
                                    .needs = halftone_needs,
                                    .by_material = screen_by_material},
};
