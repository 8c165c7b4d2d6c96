/* tonal-art-map: a stack of hatched tones, each of which holds all strokes of the lighter ones, at any distance as wide. Notes: seed-grossmann rows 3 to 5, seed-pencil-city
 * P16 to P21; after Praun 2001. */
#include "halftone/tonal_art_map.h"

#include <math.h>

#include "surface/halftone/halftone.h"
#include "surface/surface.h"

typedef struct tonal_art_map_values {
    halftone_values common;
    int32_t tones, placement, blend, map_seed;
    float   scale, width, length, opacity, uneven, darkest;
    bool    cross;
} tonal_art_map_values;

enum { SIDE = 256 };

static const char *const blend_names[] = {"nearest", "between", NULL};

static const param params[] = {
    HALFTONE_ROWS(COORDINATES_TRIPLANAR),
    PARAM_INT_ROW(tonal_art_map_values, tones, .def = 6, .min = 2, .max = 16, .soft_max = 8, .unit = UNIT_COUNT, .cpu_only = true, .doc = "Number of tones that are drawn."),
    PARAM_ENUM_ROW(tonal_art_map_values, blend, .names = blend_names, .def = 1, .variant = true,
                   .doc = "nearest: each place has one of the tones, as in hatching; between: two of them mix."),
    PARAM_FLOAT_ROW(tonal_art_map_values, scale, .def = 1, .min = 0.25, .max = 16, .soft_min = 0.5, .soft_max = 4, .unit = UNIT_PX, .logarithmic = true,
                    .doc = "Pixels that a texel of the map takes, so how coarse strokes and their distances are."),
    PARAM_FLOAT_ROW(tonal_art_map_values, width, .def = 1.6, .min = 0.6, .max = 16, .soft_max = 6, .cpu_only = true, .doc = "Width of strokes in texels."),
    PARAM_FLOAT_ROW(tonal_art_map_values, length, .def = 0.6, .min = 0.06, .max = 1, .unit = UNIT_SHARE, .cpu_only = true,
                    .doc = "Length of the longest strokes, share of the map's side."),
    PARAM_FLOAT_ROW(tonal_art_map_values, opacity, .def = 1, .min = 0.11, .max = 1, .unit = UNIT_SHARE, .cpu_only = true,
                    .doc = "1: hatching; below, strokes cover each other and darken by it, as a pencil shades."),
    PARAM_FLOAT_ROW(tonal_art_map_values, darkest, .def = 0.85, .min = 0.06, .max = 0.97, .unit = UNIT_SHARE, .cpu_only = true, .doc = "Ink of the darkest tone."),
    PARAM_BOOL_ROW(tonal_art_map_values, cross, .def = 1, .cpu_only = true, .doc = "Darker tones are crossed by a second set of strokes."),
    PARAM_FLOAT_ROW(tonal_art_map_values, uneven, .def = 0.3, .min = 0, .max = 1, .unit = UNIT_SHARE, .cpu_only = true, .doc = "How much strokes differ in direction."),
    PARAM_ENUM_ROW(tonal_art_map_values, placement, .names = tam_placement_names, .cpu_only = true, .doc = "How strokes find their places: the best of many tries, or one in each strip."),
    PARAM_INT_ROW(tonal_art_map_values, map_seed, .def = 0, .min = 0, .max = 1000000, .soft_max = 100, .cpu_only = true, .doc = "Another map of the same kind."),
};

static void describe(text *out, const void *values)
{
    const tonal_art_map_values *v = values;
    text_append(out, "1 tones=%d width=%.6g length=%.6g opacity=%.6g darkest=%.6g cross=%d uneven=%.6g placement=%d seed=%d", v->tones, (double)v->width, (double)v->length,
                (double)v->opacity, (double)v->darkest, v->cross, (double)v->uneven, v->placement, v->map_seed);
}

static lmn_status make(mip_chain *out, const void *values, lmn_error *error)
{
    const tonal_art_map_values *v = values;
    const tam_wishes wishes = {.side = SIDE, .tones = v->tones, .darkest = (double)v->darkest, .width = (double)v->width, .length = (double)v->length,
                               .opacity = (double)v->opacity, .cross = v->cross, .uneven = v->uneven, .placement = (tam_placement)v->placement,
                               .seed = (uint32_t)v->map_seed};
    lmn_status status = tonal_art_map(out, NULL, &wishes, error);
    out->fact = (float)v->darkest; /* which the shader tells tones by */
    return status;
}

static const texture_source textures[] = {{.name = "tones", .describe = describe, .make = make, .kept = true}};

static const pass passes[] = {HALFTONE_PASSES};

const technique surface_tonal_art_map = {
    .name = "tonal-art-map", .doc = "Hatched tones that hold each other's strokes, made once and laid on the surface.",
    .example = "{\"surface\": {\"technique\": \"tonal-art-map\"}, \"lines\": \"discontinuity\"}",
    .params = params, .param_count = PARAM_COUNT(params), .params_size = sizeof(tonal_art_map_values),
    .surface = "surface/tonal_art_map.glsl", .direct = true, .forward_when = HALFTONE_FORWARD_WHEN, .deferred_when = HALFTONE_DEFERRED_WHEN, .passes = passes, .pass_count = PARAM_COUNT(passes), .wishes = halftone_wishes,
    .textures = textures, .texture_count = PARAM_COUNT(textures),
};
