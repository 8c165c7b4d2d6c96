/* stick: chalk, charcoal and crayon, laid with the side of the stick. Broad strokes follow the form, over what has been
 * rubbed smooth before; the paper's teeth take what a stroke leaves, the highest first. Strokes are a tonal art map
 * (Praun 2001), directions those of the coordinates (Müller, section 4), averaged over whole planes. Which layers lie
 * over each other is the medium's: one colour, a warm one and a cool one, or white and black on toned paper. Teeth
 * are thresholds of a stroke's tone, as in Durand 2001. */
#include "base/random.h"
#include "halftone/paper.h"
#include "halftone/tonal_art_map.h"

#include <math.h>
#include <string.h>

#include "surface/halftone/halftone.h"
#include "surface/on_ground.h"
#include "surface/surface.h"

typedef struct stick_values {
    halftone_values common;
    int32_t         medium, tooth_paper, map_seed;
    float           darkest, scale, width, length, vary, smear, tooth, tooth_size, gloss, accent, lean, opacity;
} stick_values;

enum { SIDE = 256, TONES = 6, MEDIUM_TONED = 2, ROUNDS = 4, STREAM = 0x571c };

static const char *const medium_names[] = {"one", "pair", "toned", NULL};

static const param params[] = {
    HALFTONE_ROWS(COORDINATES_FORM),
    PARAM_ENUM_ROW(stick_values, medium, .names = medium_names, .variant = true,
                   .doc = "one: a single colour; pair: second_ink first and ink over it, the more the darker; toned: "
                          "ink for what is lighter than the paper and second_ink for what is darker."),
    PARAM_COLOUR_ROW(halftone_values, second_ink, .def_colour = {0.96f, 0.88f, 0.76f, 1},
                     .only_if = "medium=pair,toned", .doc = "Colour of the other stick."),
    PARAM_FLOAT_ROW(halftone_values, ink_tint, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Fraction of the model's own colour in the sticks'."),
    PARAM_FLOAT_ROW(stick_values, darkest, .def = 0.9, .min = 0.2, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much of the paper the darkest tone covers."),
    PARAM_FLOAT_ROW(stick_values, vary, .def = 12, .min = 0, .max = 60, .soft_max = 30, .unit = UNIT_DEGREES,
                    .doc = "How far the two times that a surface is gone over turn away from each other."),
    PARAM_FLOAT_ROW(stick_values, lean, .toggles = true, .def = 30, .min = -90, .max = 90, .unit = UNIT_DEGREES,
                    .only_if = "coordinates=form",
                    .doc = "How far strokes turn on faces that look to the right, and the other way on those that look "
                           "to the left."),
    PARAM_FLOAT_ROW(stick_values, scale, .def = 0.75, .min = 0.1875, .max = 12, .soft_min = 0.375, .soft_max = 3,
                    .unit = UNIT_PT, .logarithmic = true,
                    .doc = "Size of a texel of the strokes: how coarse they are."),
    PARAM_FLOAT_ROW(stick_values, width, .def = 8, .min = 1, .max = 32, .soft_max = 16, .cpu_only = true,
                    .doc = "Width of strokes in texels."),
    PARAM_FLOAT_ROW(stick_values, length, .def = 0.35, .min = 0.06, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "Length of the longest strokes, fraction of 256 texels."),
    PARAM_FLOAT_ROW(stick_values, opacity, .def = 0.7, .min = 0.2, .max = 0.9, .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "How much of what is left of the paper a stroke covers: strokes of much stand alone, those "
                           "of little lie over each other."),
    PARAM_FLOAT_ROW(stick_values, smear, .def = 0.3, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc =
                        "Fraction of the darkest tone that is rubbed smooth under the strokes; less of lighter ones."),
    PARAM_FLOAT_ROW(stick_values, tooth, .def = 0.7, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How far the paper's teeth break strokes up."),
    PARAM_ENUM_ROW(stick_values, tooth_paper, .names = paper_names, .def = PAPER_ROUGH, .cpu_only = true,
                   .doc = "The paper whose teeth these are."),
    PARAM_FLOAT_ROW(stick_values, tooth_size, .def = 1.5, .min = 0.375, .max = 24, .soft_max = 6, .unit = UNIT_PT,
                    .logarithmic = true, .doc = "Size of the finest teeth."),
    PARAM_FLOAT_ROW(stick_values, gloss, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Strength of the highlights that an eraser pulls out, or that are set last in white."),
    PARAM_FLOAT_ROW(stick_values, accent, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much darker clefts and places of contact get than their tone; needs occlusion."),
    PARAM_INT_ROW(stick_values, map_seed, .def = 0, .min = 0, .max = 1000000, .soft_max = 100, .cpu_only = true,
                  .doc = "Other strokes of the same kind."),
};

/* --- what is made --------------------------------------------------------------------------------------- */

static void describe_strokes(text *out, const void *values)
{
    const stick_values *v = values;
    text_append(out, "4 width=%.6g length=%.6g opacity=%.6g seed=%d", (double)v->width, (double)v->length,
                (double)v->opacity, v->map_seed);
}

/* What the side of a stick leaves at once: heavier along one of its edges, set down hard and lifted again, each of its
 * fibres as far as it touches. */
static lmn_status make_side(stroke_image *out, uint32_t seed, lmn_error *error)
{
    enum { COLUMNS = 192, ROWS = 20 };
    static const double RAGGED = 0.07, LIGHT_EDGE = 0.5, LIFTED = 0.3, UNEVEN = 0.35;
    float               ink[COLUMNS * ROWS];
    random_source       r = random_start(seed, STREAM);
    for (int y = 0; y < ROWS; y++) {
        double across = (y + 0.5) / ROWS, edge = fmin(fmin(y + 0.75, ROWS - y - 0.25) / 1.5, 1);
        double first = RAGGED * random_unit(&r), last = 1 - RAGGED * random_unit(&r);
        double fibre = edge * (1 - LIGHT_EDGE * across) * (1 - UNEVEN * random_unit(&r));
        for (int x = 0; x < COLUMNS; x++) {
            double along = (x + 0.5) / COLUMNS, inside = fmin(along - first, last - along) * COLUMNS / 4;
            ink[y * COLUMNS + x] = (float)(fibre * (1 - LIFTED * along) * fmax(0, fmin(inside, 1)));
        }
    }
    return stroke_image_of_ink(out, ink, COLUMNS, ROWS, error);
}

static lmn_status make_strokes(mip_chain *out, const void *values, lmn_error *error)
{
    const stick_values *v = values;
    stroke_image        side;
    const tam_options   options = {.side = SIDE,
                                   .tones = TONES,
                                   .darkest = 0.9,
                                   .width = (double)v->width,
                                   .length = (double)v->length,
                                   .opacity = (double)v->opacity,
                                   .uneven = 0.5f,
                                   .grain = 0.5,
                                   .placement = TAM_BEST_FIT,
                                   .image = &side,
                                   .seed = (uint32_t)v->map_seed};
    memset(out, 0, sizeof *out);
    lmn_status status = make_side(&side, options.seed, error);
    if (status == LMN_OK)
        status = tonal_art_map(out, NULL, &options, error);
    stroke_image_release(&side);
    out->fact = 0.9f; /* which the shader tells tones by */
    return status;
}

static void describe_teeth(text *out, const void *values)
{
    const stick_values *v = values;
    text_append(out, "3 %s", paper_names[v->tooth_paper]);
}

static lmn_status make_teeth(mip_chain *out, const void *values, lmn_error *error)
{
    const stick_values *v = values;
    paper               sheet;
    lmn_status          status = paper_create(&sheet, (paper_kind)v->tooth_paper, 0, error);
    if (status == LMN_OK)
        status = paper_texture(out, &sheet, error);
    paper_release(&sheet);
    return status;
}

static const texture_source textures[] = {
    {.name = "tones", .describe = describe_strokes, .make = make_strokes, .kept = true},
    {.name = "teeth", .when = "tooth_paper", .describe = describe_teeth, .make = make_teeth, .kept = true},
};

/* --- how it is drawn ------------------------------------------------------------------------------------ */

static const pass passes[] = {
    {.name = "directions",
     .shader = "surface/halftone/direction.frag",
     .reads = {TARGET_NORMAL_DEPTH, TARGET_ID},
     .writes = TARGET_DIRECTION,
     .when = HALFTONE_DEFERRED_WHEN,
     .prepares = true},
    {.name = "smooth directions",
     .shader = "surface/halftone/direction_smooth.frag",
     .reads = {TARGET_DIRECTION, TARGET_NORMAL_DEPTH},
     .writes = TARGET_DIRECTION,
     .repeat = ROUNDS,
     .when = HALFTONE_DEFERRED_WHEN,
     .prepares = true},
    {.name = "lean",
     .shader = "surface/stick_lean.frag",
     .reads = {TARGET_DIRECTION, TARGET_NORMAL_DEPTH},
     .writes = TARGET_DIRECTION,
     .when = "coordinates=form&lean",
     .prepares = true},
};

/* Black is there for shadows on any toned paper. */
static bool stick_on_ground(const void *values, colour ground)
{
    const stick_values *v = values;
    halftone_values     dark = v->common;
    if (v->medium == MEDIUM_TONED)
        dark.ink = dark.second_ink;
    return draws_ground(&dark, ground);
}

const technique surface_stick = {
    .name = "stick",
    .doc = "Chalk, charcoal and crayon: broad strokes along the form, over smears, on the teeth of a paper.",
    .example = "{\"surface\": {\"technique\": \"stick\", \"smear\": 0.5}, \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(stick_values),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .textures = textures,
    .texture_count = PARAM_COUNT(textures),
    .surface = &(const surface_row){.shader = "surface/stick.glsl",
                                    .direct = true,
                                    .forward_when = HALFTONE_FORWARD_WHEN,
                                    .deferred_when = HALFTONE_DEFERRED_WHEN,
                                    .on_ground = stick_on_ground,
                                    .needs = halftone_needs},
};
