/* streak-map: what moves dissolves into strokes along its way, as dense as it covers the page. Großmann 2011, section
 * 5; rows 52 to 57. */
#include "halftone/tonal_art_map.h"
#include "motion/along.h"
#include "motion/motion.h"

typedef struct streak_map_values {
    motion_common common;
    int32_t       samples, tones, map_seed;
    float         scale, width, length, uneven, darkest, patch, ink_tint;
    colour        ink;
    bool          over;
} streak_map_values;

enum { SIDE = 256 };

static const param params[] = {
    PARAM_INT_ROW(
        streak_map_values, samples, .def = 32, .min = 2, .max = 64, .soft_min = 8, .soft_max = 64, .unit = UNIT_COUNT,
        .doc = "How many samples along the way a pixel takes at most; with fewer, the strokes' density changes "
               "in steps."),
    PARAM_BOOL_ROW(streak_map_values, over, .def = 0, .variant = true,
                   .doc = "The object stays whole, and strokes are behind it alone."),
    PARAM_COLOUR_ROW(streak_map_values, ink, .def_colour = {0.1f, 0.1f, 0.1f, 1}, .only_if = "ink_tint<1",
                     .doc = "Colour of strokes that do not take the object's."),
    PARAM_FLOAT_ROW(streak_map_values, ink_tint, .def = 1, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much of the object's colour strokes have."),
    PARAM_INT_ROW(streak_map_values, tones, .def = 6, .min = 2, .max = 16, .soft_max = 8, .unit = UNIT_COUNT,
                  .cpu_only = true, .doc = "Number of tones that are drawn between none and whole."),
    PARAM_FLOAT_ROW(streak_map_values, scale, .def = 0.75, .min = 0.375, .max = 12, .soft_max = 3, .unit = UNIT_PT,
                    .logarithmic = true,
                    .doc = "Pixels that a texel of the map takes, so how coarse strokes and their distances are."),
    PARAM_FLOAT_ROW(streak_map_values, width, .def = 2, .min = 0.6, .max = 16, .soft_max = 6, .cpu_only = true,
                    .doc = "Width of strokes in texels."),
    PARAM_FLOAT_ROW(streak_map_values, length, .def = 0.9, .min = 0.06, .max = 1, .unit = UNIT_FRACTION,
                    .cpu_only = true, .doc = "Length of the longest strokes, fraction of the map's side."),
    PARAM_FLOAT_ROW(streak_map_values, uneven, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "How much strokes differ in direction; 0: all lie along the motion."),
    PARAM_FLOAT_ROW(streak_map_values, darkest, .def = 0.85, .min = 0.06, .max = 0.97, .unit = UNIT_FRACTION,
                    .cpu_only = true, .doc = "Ink of the darkest tone; what covers more closes."),
    PARAM_FLOAT_ROW(streak_map_values, patch, .def = 48, .min = 6, .max = 768, .soft_max = 192, .unit = UNIT_PT,
                    .logarithmic = true, .doc = "Side of the areas in which all strokes have one direction."),
    PARAM_INT_ROW(streak_map_values, map_seed, .def = 0, .min = 0, .max = 1000000, .soft_max = 100, .cpu_only = true,
                  .doc = "Other strokes of the same kind."),
};

static tam_options options_of(const streak_map_values *v)
{
    return (tam_options){.side = SIDE,
                         .tones = v->tones,
                         .darkest = (double)v->darkest,
                         .width = (double)v->width,
                         .length = (double)v->length,
                         .opacity = 1,
                         .uneven = v->uneven,
                         .placement = TAM_BEST_FIT,
                         .seed = (uint32_t)v->map_seed};
}

static void describe(text *out, const void *values)
{
    const streak_map_values *v = values;
    text_append(out, "streaks 1 tones=%d width=%.6g length=%.6g darkest=%.6g uneven=%.6g seed=%d", v->tones,
                (double)v->width, (double)v->length, (double)v->darkest, (double)v->uneven, v->map_seed);
}

static lmn_status make(mip_chain *out, const void *values, lmn_error *error)
{
    tam_options options = options_of(values);
    lmn_status  status = tonal_art_map(out, NULL, &options, error);
    out->fact = (float)options.darkest; /* which the shader tells tones by */
    return status;
}

static const texture_source textures[] = {{.name = "tones", .describe = describe, .make = make, .kept = true}};

static const pass passes[] = {
    ALONG_NEAREST_PASS,
    {.name = "cells", .shader = "motion/cells.frag", .reads = {TARGET_NEAREST}, .writes = TARGET_CELLS},
    {.name = "streaks",
     .shader = "motion/streak_map.frag",
     .reads = {ALONG_READS, TARGET_CELLS},
     .writes = TARGET_PAGE,
     .blend = BLEND_OVER,
     .depth = true},
};

const technique motion_streak_map = {
    .name = "streak-map",
    .doc = "What moves dissolves into strokes along its way, denser where it was longer.",
    .example = "{\"motion\": {\"technique\": \"streak-map\"}, \"surface\": \"lit\", \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(streak_map_values),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .targets = along_targets,
    .target_count = ALONG_TARGETS,
    .textures = textures,
    .texture_count = PARAM_COUNT(textures),
    .motion = &(const motion_row){.steps = along_steps, .stretched = true},
};
