/* watercolour: washes of thin pigment over white paper, one over the other where less light falls. Pigment is carried
 * to where a wash ends and flows as the water did; the more of it, the more light it takes (Bousseau, Kaplan, Thollot
 * and Sillion, "Interactive watercolor rendering with temporal coherence and abstraction", NPAR 2006: edge darkening
 * and turbulent flow; Curtis et al., "Computer-generated watercolor", SIGGRAPH 1997). Water that
 * runs back into a wash pushes its pigment before it (Curtis: back-runs). A shadow on the ground is a wash, too. */
#include "halftone/paper.h"

#include <string.h>

#include "surface/form.h"
#include "surface/surface.h"

typedef struct watercolour {
    int32_t washes;
    float   pale, deep, softness, pooling, pool, flow, flow_size, wander, reserve, granulation, saturation, smoothing;
    colour  shade, paper;
} watercolour;

static const param params[] = {
    PARAM_INT_ROW(watercolour, washes, .def = 3, .min = 1, .max = 8, .soft_min = 2, .soft_max = 5, .unit = UNIT_COUNT,
                  .doc = "Washes that are laid: the first over everything, each further one where less light falls."),
    PARAM_FLOAT_ROW(watercolour, pale, .def = 0.45, .min = 0, .max = 3, .soft_max = 1,
                    .doc = "Pigment of the first wash alone; 1 shows the model's own colour, 0 paper."),
    PARAM_FLOAT_ROW(watercolour, deep, .def = 1.1, .min = 0, .max = 4, .soft_max = 2.5,
                    .doc = "Pigment of all washes, where no light falls."),
    PARAM_COLOUR_ROW(watercolour, shade, .def_colour = {0.70f, 0.74f, 0.90f, 1},
                     .doc = "Colour that the further washes lay over the model's own: what white has in the shade."),
    PARAM_COLOUR_ROW(watercolour, paper, .can_auto = true, .def_auto = true, .auto_ground = true,
                     .doc = "Colour of the paper that shows through; auto takes the page's."),
    PARAM_FLOAT_ROW(watercolour, softness, .def = 1.5, .min = 0, .max = 60, .soft_max = 12, .unit = UNIT_PT,
                    .doc = "Width over which a wash ends inside a form; 0 is hard, much is wet in wet."),
    PARAM_FLOAT_ROW(watercolour, pooling, .def = 0.6, .min = 0, .max = 4, .soft_max = 1.5,
                    .doc = "How much more pigment there is where a wash ends, fraction of its own."),
    PARAM_FLOAT_ROW(watercolour, pool, .def = 3, .min = 0.25, .max = 30, .soft_max = 9, .unit = UNIT_PT,
                    .only_if = "pooling>0", .doc = "How far inside a wash that is to be seen."),
    PARAM_FLOAT_ROW(watercolour, flow, .def = 0.35, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How unevenly pigment lies: fraction by which there is more or less of it."),
    PARAM_FLOAT_ROW(watercolour, flow_size, .def = 48, .min = 3, .max = 500, .soft_max = 150, .unit = UNIT_PT,
                    .only_if = "flow>0", .doc = "Size of the places with more or less pigment."),
    PARAM_FLOAT_ROW(watercolour, wander, .def = 3, .min = 0, .max = 50, .soft_max = 9, .unit = UNIT_PT,
                    .doc = "How far the borders of washes stray from the light's."),
    PARAM_FLOAT_ROW(watercolour, reserve, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "The lightest fraction of the light, which is left as paper."),
    PARAM_FLOAT_ROW(watercolour, granulation, .toggles = true, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much of the pigment settles in the valleys of the paper."),
    PARAM_FLOAT_ROW(watercolour, saturation, .def = 1.15, .min = 0, .max = 3, .soft_max = 2,
                    .doc = "Saturation of the pigments."),
    PARAM_FLOAT_ROW(watercolour, smoothing, .def = 6, .min = 0.5, .max = 100, .soft_max = 40, .unit = UNIT_PT,
                    .doc = "Light is smoothed over this radius before washes are laid, textures over at most 12 pt "
                           "of it, within a part and not across creases; not in what is seen through."),
};

static int rounds_of(const void *values)
{
    return form_rounds((double)((const watercolour *)values)->smoothing);
}

static const pass passes[] = {FORM_PASSES(rounds_of)};

static void describe_valleys(text *out, const void *values)
{
    (void)values;
    text_append(out, "1");
}

static lmn_status make_valleys(mip_chain *out, const void *values, lmn_error *error)
{
    (void)values;
    paper sheet;
    memset(out, 0, sizeof *out);
    lmn_status status = paper_create(&sheet, PAPER_ROUGH, 1, error);
    if (status == LMN_OK)
        status = paper_texture(out, &sheet, error);
    paper_release(&sheet);
    return status;
}

static const texture_source textures[] = {
    {.name = "valleys", .when = "granulation", .describe = describe_valleys, .make = make_valleys, .kept = true}};

const technique surface_watercolour = {
    .name = "watercolour",
    .doc = "Washes of thin pigment on paper, darker where they end.",
    .example = "{\"surface\": {\"technique\": \"watercolour\", \"pooling\": 1}, \"lines\": \"strokes\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(watercolour),
    .channels = CHANNEL_ID,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .textures = textures,
    .texture_count = PARAM_COUNT(textures),
    .surface = &(const surface_row){.shader = "surface/watercolour.glsl",
                                    .deferred_when = "smoothing>0",
                                    .casts_on_ground = true},
};
