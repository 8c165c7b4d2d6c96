/* tonal-art-map: a stack of hatched tones, each of which holds all strokes of the lighter ones, at any distance as
 * wide. Großmann 2011, section 3.2.3; Müller, section 3; rows Großmann 3 to 5, P16 to P21; after Praun 2001. */
#include "halftone/tonal_art_map.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/store.h"
#include "surface/halftone/halftone.h"
#include "surface/on_ground.h"
#include "surface/surface.h"

typedef struct tonal_art_map_values {
    halftone_values common;
    param_words     strokes;
    int32_t         tones, placement, blend, map_seed;
    float           scale, width, length, opacity, grain, uneven, darkest, repeat;
    bool            cross;
} tonal_art_map_values;

enum { SIDE = 256 };

static const char *const blend_names[] = {"nearest", "between", NULL};

static lmn_status check_strokes(const char *name, lmn_error *error);

static const param params[] = {
    HALFTONE_ROWS(COORDINATES_TRIPLANAR),
    HALFTONE_INK_ROWS,
    PARAM_INT_ROW(tonal_art_map_values, tones, .def = 6, .min = 2, .max = 16, .soft_max = 8, .unit = UNIT_COUNT,
                  .cpu_only = true, .doc = "Number of tones that are drawn."),
    PARAM_ENUM_ROW(tonal_art_map_values, blend, .names = blend_names, .def = 1, .variant = true,
                   .doc = "nearest: each place has one of the tones, as in hatching; between: two of them mix."),
    PARAM_FLOAT_ROW(tonal_art_map_values, scale, .def = 0.75, .min = 0.1875, .max = 12, .soft_min = 0.375,
                    .soft_max = 3, .unit = UNIT_PT, .logarithmic = true,
                    .doc = "Pixels that a texel of the map takes, so how coarse strokes and their distances are."),
    PARAM_FLOAT_ROW(tonal_art_map_values, width, .def = 1.6, .min = 0.6, .max = 16, .soft_max = 6, .cpu_only = true,
                    .doc = "Width of strokes in texels."),
    PARAM_FLOAT_ROW(tonal_art_map_values, length, .def = 0.6, .min = 0.06, .max = 1, .unit = UNIT_FRACTION,
                    .cpu_only = true, .doc = "Length of the longest strokes, fraction of the map's side."),
    PARAM_FLOAT_ROW(tonal_art_map_values, opacity, .def = 1, .min = 0.11, .max = 1, .unit = UNIT_FRACTION,
                    .cpu_only = true,
                    .doc = "1: hatching; below, strokes cover each other and darken by it, as a pencil shades."),
    PARAM_FLOAT_ROW(tonal_art_map_values, grain, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "Streaks within strokes, as graphite leaves them, and less pressure towards their ends."),
    PARAM_TEXT_ROW(
        tonal_art_map_values, strokes, .example = "stipple", .is_file = true, .check = check_strokes,
        .doc = "Other shapes instead of strokes: stipple (dots), or a file (.stx, .svg), whose strokes are "
               "placed in the order of their light priorities "
               "and only as far away as their perspective priorities say, until there are none left; or the picture "
               "of a stroke (.png, .jpg, .webp, or the word split), which all are drawn with, as pencil's "
               "are."),
    PARAM_FLOAT_ROW(tonal_art_map_values, repeat, .toggles = true, .def = 0, .min = 0, .max = 1000, .soft_max = 16,
                    .only_if = "coordinates=uv",
                    .doc = "How often the map is laid into a unit of texture coordinates, at any distance; 0: as often "
                           "as keeps strokes as wide on the page."),
    PARAM_FLOAT_ROW(tonal_art_map_values, darkest, .def = 0.85, .min = 0.06, .max = 0.97, .unit = UNIT_FRACTION,
                    .cpu_only = true, .doc = "Ink of the darkest tone."),
    PARAM_BOOL_ROW(tonal_art_map_values, cross, .def = 1, .cpu_only = true,
                   .doc = "Darker tones are crossed by a second set of strokes."),
    PARAM_FLOAT_ROW(tonal_art_map_values, uneven, .def = 0.3, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .cpu_only = true, .doc = "How much strokes differ in direction."),
    PARAM_ENUM_ROW(tonal_art_map_values, placement, .names = tam_placement_names, .cpu_only = true,
                   .doc = "How strokes find their places: the best of many tries, or one in each strip."),
    PARAM_INT_ROW(tonal_art_map_values, map_seed, .def = 0, .min = 0, .max = 1000000, .soft_max = 100, .cpu_only = true,
                  .doc = "Another map of the same kind."),
};

/* --- what is placed ------------------------------------------------------------------------------------- */

static const char *const dots_name = "stipple";

static lmn_status check_strokes(const char *name, lmn_error *error)
{
    char ending[8];
    file_ending(name, ending, sizeof ending);
    if (strcmp(name, dots_name) == 0 || strcmp(ending, ".stx") == 0 || strcmp(ending, ".svg") == 0 ||
        stroke_image_is_named(name))
        return LMN_OK;
    return error_set(error, LMN_USAGE,
                     "strokes is '%.200s'; allowed are the words stipple and split, files of strokes (.stx, .svg) and "
                     "pictures of a stroke (.png, .jpg, .webp)",
                     name);
}

/* As many dots as cover what the darkest tone needs, and some more since they overlap. */
static lmn_status make_dots(strokes *out, const tonal_art_map_values *v, lmn_error *error)
{
    double dot = 0.785 * (double)v->width * (double)v->width, needed = -log(1 - (double)v->darkest) * SIDE * SIDE / dot;
    return strokes_generate(out,
                            &(pattern_options){.pattern = PATTERN_STIPPLE,
                                               .count = (size_t)(1.5 * needed / (double)v->opacity),
                                               .uneven = v->uneven,
                                               .seed = (uint32_t)v->map_seed},
                            error);
}

static void describe(text *out, const void *values)
{
    const tonal_art_map_values *v = values;
    file_data                   file;
    text_append(out,
                "2 tones=%d width=%.6g length=%.6g opacity=%.6g grain=%.6g darkest=%.6g cross=%d uneven=%.6g "
                "placement=%d seed=%d %s",
                v->tones, (double)v->width, (double)v->length, (double)v->opacity, (double)v->grain, (double)v->darkest,
                v->cross, (double)v->uneven, v->placement, v->map_seed, v->strokes.text);
    if (stroke_image_is_named(v->strokes.text))
        stroke_image_describe(out, v->strokes.text);
    else if (v->strokes.text[0] && strcmp(v->strokes.text, dots_name) != 0 &&
             file_load(&file, v->strokes.text, NULL) == LMN_OK) {
        text_append(out, " content=%016llx", (unsigned long long)store_hash(file.data, file.size));
        file_data_release(&file);
    }
}

static lmn_status make(mip_chain *out, const void *values, lmn_error *error)
{
    const tonal_art_map_values *v = values;
    const char                 *name = v->strokes.text;
    const bool                  shown = stroke_image_is_named(name);
    stroke_image                image = {.sums = NULL};
    strokes                     drawn = {.width = 1};
    tam_options                 options = {.side = SIDE,
                                           .tones = v->tones,
                                           .darkest = (double)v->darkest,
                                           .width = (double)v->width,
                                           .length = (double)v->length,
                                           .opacity = (double)v->opacity,
                                           .cross = v->cross,
                                           .grain = (double)v->grain,
                                           .uneven = v->uneven,
                                           .placement = (tam_placement)v->placement,
                                           .drawn = name[0] && !shown ? &drawn : NULL,
                                           .image = shown ? &image : NULL,
                                           .seed = (uint32_t)v->map_seed};
    memset(out, 0, sizeof *out);
    lmn_status status = !name[0]                       ? LMN_OK
                        : shown                        ? stroke_image_load(&image, name, error)
                        : strcmp(name, dots_name) == 0 ? make_dots(&drawn, v, error)
                                                       : strokes_load(&drawn, name, error);
    if (status == LMN_OK)
        status = tonal_art_map(out, NULL, &options, error);
    out->fact = (float)v->darkest; /* which the shader tells tones by */
    strokes_release(&drawn);
    stroke_image_release(&image);
    return status;
}

static const texture_source textures[] = {{.name = "tones", .describe = describe, .make = make, .kept = true}};

static const pass passes[] = {HALFTONE_PASSES};

const technique surface_tonal_art_map = {
    .name = "tonal-art-map",
    .doc = "Hatched tones that hold each other's strokes, made once and laid on the surface.",
    .example = "{\"surface\": {\"technique\": \"tonal-art-map\"}, \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(tonal_art_map_values),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .textures = textures,
    .texture_count = PARAM_COUNT(textures),
    .surface = &(const surface_row){.shader = "surface/tonal_art_map.glsl",
                                    .direct = true,
                                    .forward_when = HALFTONE_FORWARD_WHEN,
                                    .deferred_when = HALFTONE_DEFERRED_WHEN,
                                    .on_ground = draws_ground,
                                    .needs = halftone_needs},
};
