/* pencil: graphite or coloured pencils that shade along the form: a tonal art map laid over itself several times,
 * with light, shadow, occlusion and texture as the tone. Müller, sections 1, 3 and 4.4; rows P20 to P24, P32 to
 * P34, P36, P37. */
#include "halftone/graphite.h"
#include "halftone/tonal_art_map.h"

#include <string.h>

#include "surface/halftone/halftone.h"
#include "surface/on_ground.h"
#include "surface/surface.h"

typedef struct pencil_values {
    halftone_values common;
    int32_t         shading, overlays, lead, map_seed;
    param_words     strokes;
    float           vary, scale, width, length, opacity, ragged, gloss;
    palette         pencils;
    bool            cross;
} pencil_values;

enum { SIDE = 256, TONES = 6, SHADING_GRADATION = 1 };

static const char *const shading_names[] = {"hatching", "gradation", NULL};

static lmn_status check_strokes(const char *name, lmn_error *error)
{
    if (stroke_image_is_named(name))
        return LMN_OK;
    return error_set(error, LMN_USAGE,
                     "strokes is '%.200s'; allowed are pictures of a stroke (.png, .jpg, .webp) and the word split",
                     name);
}

static const param params[] = {
    HALFTONE_ROWS(COORDINATES_FORM),
    PARAM_FLOAT_ROW(halftone_values, ink_tint, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Fraction of the model's own colour in the pencil's: with 1 each part has its own."),
    PARAM_ENUM_ROW(pencil_values, shading, .names = shading_names, .variant = true,
                   .doc = "hatching: strokes with gaps, in so many tones; gradation: strokes cover each other, and "
                          "tones pass into one another."),
    PARAM_INT_ROW(
        pencil_values, overlays, .def = 2, .min = 1, .max = 6, .soft_max = 4, .unit = UNIT_COUNT, .variant = true,
        .doc = "How often the surface is gone over; each time has its part of the darkness and turns a little."),
    PARAM_FLOAT_ROW(
        pencil_values, vary, .def = 0, .min = 0, .max = 90, .soft_max = 30, .unit = UNIT_DEGREES,
        .only_if = "overlays>1",
        .doc = "How far each time turns besides; on the page each has directions of its own between those of the "
               "others, which hides where they meet."),
    PARAM_ENUM_ROW(pencil_values, lead, .names = lead_grade_names, .def = LEAD_4B, .cpu_only = true,
                   .doc = "The lead, from hard and light to soft and dark."),
    PARAM_FLOAT_ROW(pencil_values, gloss, .toggles = true, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Strength of a small highlight that stays bare."),
    PARAM_PALETTE_ROW(pencil_values, pencils, .def_palette = {1, {{0, 0, 0, 1}}},
                      .doc = "With several colours, each time over takes the next, and they mix as coloured pencils "
                             "do; with one, ink is the colour."),
    PARAM_FLOAT_ROW(pencil_values, scale, .def = 0.75, .min = 0.1875, .max = 12, .soft_min = 0.375, .soft_max = 3,
                    .unit = UNIT_PT, .logarithmic = true,
                    .doc = "Pixels that a texel of the strokes takes: how coarse they are."),
    PARAM_FLOAT_ROW(pencil_values, width, .def = 1.6, .min = 0.6, .max = 16, .soft_max = 6, .cpu_only = true,
                    .doc = "Width of strokes in texels."),
    PARAM_FLOAT_ROW(pencil_values, length, .def = 0.6, .min = 0.06, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "Length of the longest strokes, fraction of 256 texels."),
    PARAM_FLOAT_ROW(pencil_values, opacity, .def = 0.7, .min = 0.2, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "How much of what is left of the paper a stroke covers; with gradation half as much."),
    PARAM_TEXT_ROW(pencil_values, strokes, .example = "split", .is_file = true, .check = check_strokes,
                   .doc = "A picture that all strokes are drawn with (.png, .jpg, .webp): one stroke from left to "
                          "right, dark on white or on nothing, cropped, 512 x 32 pixels for example, as high as width "
                          "says. Its first and last quarters keep their proportions at any length of a stroke, what "
                          "lies between is stretched. split shows how: two lines beside each other. Empty: strokes "
                          "that run out at their ends."),
    PARAM_FLOAT_ROW(pencil_values, ragged, .toggles = true, .def = 0, .min = 0, .max = 2, .soft_max = 1,
                    .unit = UNIT_FRACTION, .only_if = "shading=hatching",
                    .doc = "How far strokes begin and end before and behind the border between two tones, in tones; 0 "
                           "ends all of them there."),
    PARAM_BOOL_ROW(pencil_values, cross, .def = 0, .cpu_only = true,
                   .doc = "Darker tones are crossed by a second set of strokes."),
    PARAM_INT_ROW(pencil_values, map_seed, .def = 0, .min = 0, .max = 1000000, .soft_max = 100, .cpu_only = true,
                  .doc = "Other strokes of the same kind."),
};

static bool is_gradation(const pencil_values *v)
{
    return v->shading == SHADING_GRADATION;
}

static void describe(text *out, const void *values)
{
    const pencil_values *v = values;
    text_append(out, "2 shading=%d width=%.6g length=%.6g opacity=%.6g cross=%d seed=%d", v->shading, (double)v->width,
                (double)v->length, (double)v->opacity, v->cross, v->map_seed);
    if (v->strokes.text[0])
        stroke_image_describe(out, v->strokes.text);
}

/* What a stroke leaves of the paper. Its darkness is the shader's. */
static lmn_status make(mip_chain *out, const void *values, lmn_error *error)
{
    const pencil_values *v = values;
    const double         darkest = is_gradation(v) ? 0.9 : 0.82;
    const bool           shown = v->strokes.text[0] != '\0';
    stroke_image         image = {.sums = NULL};
    const tam_options    options = {.side = SIDE,
                                    .tones = TONES,
                                    .darkest = darkest,
                                    .width = (double)v->width,
                                    .length = (double)v->length,
                                    .opacity = (double)v->opacity * (is_gradation(v) ? 0.5 : 1),
                                    .cross = v->cross,
                                    .uneven = is_gradation(v) ? 0.6f : 0.3f,
                                    .placement = TAM_BEST_FIT,
                                    .image = shown ? &image : NULL,
                                    .seed = (uint32_t)v->map_seed};
    lmn_status           status = shown ? stroke_image_load(&image, v->strokes.text, error) : LMN_OK;
    memset(out, 0, sizeof *out);
    if (status == LMN_OK)
        status = tonal_art_map(out, NULL, &options, error);
    stroke_image_release(&image);
    out->fact = (float)darkest; /* which the shader tells tones by */
    return status;
}

static size_t numbers_of(const void *values, uint32_t seed, int width, int height, float out[][4])
{
    const pencil_values *v = values;
    (void)seed, (void)width, (void)height;
    out[0][0] = lead_darkest((lead_grade)v->lead);
    out[0][1] = out[0][2] = out[0][3] = 0;
    return 1;
}

static const texture_source textures[] = {{.name = "tones", .describe = describe, .make = make, .kept = true}};

static const pass passes[] = {HALFTONE_PASSES};

const technique surface_pencil = {
    .name = "pencil",
    .doc = "Pencil strokes along the form, gone over several times.",
    .example = "{\"surface\": {\"technique\": \"pencil\", \"gloss\": 0.2}, \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(pencil_values),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .textures = textures,
    .texture_count = PARAM_COUNT(textures),
    .numbers = numbers_of,
    .surface = &(const surface_row){.shader = "surface/pencil.glsl",
                                    .direct = true,
                                    .forward_when = HALFTONE_FORWARD_WHEN,
                                    .deferred_when = HALFTONE_DEFERRED_WHEN,
                                    .on_ground = draws_ground,
                                    .needs = halftone_needs},
};
