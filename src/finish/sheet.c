/* sheet: the page's ground, and the paper that what is drawn is rubbed onto. Müller, section 2.3; row P28. */
#include "finish/finish.h"

#include <math.h>

#include "halftone/paper.h"

static const char *const motion_names[] = {"fixed", "following", "zooming", NULL};

static const param params[] = {
    PARAM_COLOUR_ROW(sheet_values, ground, .def_colour = {1, 1, 1, 1}, .cpu_only = true,
                     .doc = "Colour of the page; none leaves it transparent."),
    PARAM_ENUM_ROW(sheet_values, paper, .names = paper_names, .cpu_only = true,
                   .doc = "What is drawn on: ink stays on the hills of its grain and leaves out the valleys, the "
                          "fainter the more. smooth, drawing (fine tooth), "
                          "rough, laid (ribs and chain lines) or canvas."),
    PARAM_FLOAT_ROW(sheet_values, grain, .def = 0.7, .min = 0, .max = 1, .unit = UNIT_FRACTION, .only_if = "paper",
                    .doc = "How much ink follows the grain."),
    PARAM_FLOAT_ROW(sheet_values, grain_size, .def = 1.5, .min = 1.125, .max = 24, .soft_max = 6, .unit = UNIT_PT,
                    .logarithmic = true, .cpu_only = true, .only_if = "paper",
                    .doc = "Size of the fine tooth; rough paper's hills, ribs and threads are a few times as large."),
    PARAM_FLOAT_ROW(sheet_values, pressure, .def = 0.9, .min = 0.3, .max = 1, .unit = UNIT_FRACTION, .only_if = "paper",
                    .doc = "1: where ink is full it fills the valleys, and tones stay what they are; below, the "
                           "darkest strokes are broken too, and lighter for it."),
    PARAM_COLOUR_ROW(sheet_values, ink, .def_colour = {NAN, NAN, NAN, 1}, .can_auto = true, .def_auto = true,
                     .cpu_only = true, .only_if = "paper",
                     .doc = "The strongest ink: the pencil's colour, beyond which hills do not go; auto: as far as "
                            "colours go, so that grey ink gets black specks."),
    PARAM_FLOAT_ROW(sheet_values, relief, .toggles = true, .def = 0, .min = 0, .max = 1, .soft_max = 0.3,
                    .unit = UNIT_FRACTION, .only_if = "paper",
                    .doc = "How much the bare paper shows its grain by light from the upper left."),
    PARAM_ENUM_ROW(sheet_values, motion, .names = motion_names, .variant = true, .only_if = "paper",
                   .doc = "fixed: the paper lies still under what moves; following: it goes, turns and rolls along "
                          "with the model; zooming: it also grows "
                          "with it, while finer grain appears."),
    PARAM_INT_ROW(sheet_values, paper_seed, .def = 0, .min = 0, .max = 1000000, .soft_max = 100, .cpu_only = true,
                  .only_if = "paper", .doc = "Another sheet of the same kind."),
    PARAM_TEXT_ROW(sheet_values, labels, .example = "name",
                   .doc = "An attribute that is written beside the parts that state it and are seen, with leaders; "
                          "'name' is what they are called. Labels keep clear of each other."),
    PARAM_TEXT_ROW(sheet_values, labels_by, .example = "height", .only_if = "labels",
                   .doc = "An attribute whose number says which labels are more important; empty: those of what shows "
                          "most."),
    PARAM_INT_ROW(sheet_values, labels_most, .def = 40, .min = 1, .max = 200, .soft_max = 80, .unit = UNIT_COUNT,
                  .cpu_only = true, .only_if = "labels", .doc = "How many labels there are at most."),
    PARAM_FLOAT_ROW(sheet_values, label_size, .def = 8, .min = 2, .max = 72, .soft_max = 16, .unit = UNIT_PT,
                    .cpu_only = true, .along = true,
                    .doc = "Size of letters in labels, the legend, and beside the north arrow and the scale bar."),
    PARAM_BOOL_ROW(sheet_values, legend, .def = 0, .cpu_only = true,
                   .doc = "The colours of scene.datum and what they mean, at the lower left."),
    PARAM_BOOL_ROW(sheet_values, north_arrow, .def = 0, .cpu_only = true,
                   .doc = "A needle that points north: along +Y where Z is up, along -Z where Y is."),
    PARAM_BOOL_ROW(sheet_values, scale_bar, .def = 0, .cpu_only = true,
                   .doc = "A bar as long as a round length, in parallel projection."),
};

static void describe(text *out, const void *values)
{
    const sheet_values *v = values;
    text_append(out, "2 %s seed=%d", paper_names[v->paper], v->paper_seed);
}

static lmn_status make(mip_chain *out, const void *values, lmn_error *error)
{
    const sheet_values *v = values;
    paper               sheet;
    lmn_status          status = paper_create(&sheet, (paper_kind)v->paper, (uint32_t)v->paper_seed, error);
    if (status == LMN_OK)
        status = paper_texture(out, &sheet, error);
    paper_release(&sheet);
    return status;
}

static const texture_source textures[] = {
    {.name = "paper", .when = "paper&grain", .describe = describe, .make = make, .kept = true}};

static const technique sheet = {
    .name = "sheet",
    .doc = "The page's ground and the paper's grain.",
    .example = "{\"surface\": \"lit\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(sheet_values),
    .textures = textures,
    .texture_count = PARAM_COUNT(textures),
};

static const technique *const techniques[] = {&sheet};

const kind kind_finish = {
    .id = KIND_FINISH,
    .name = "finish",
    .doc = "The sheet, for the whole look.",
    .techniques = techniques,
    .technique_count = PARAM_COUNT(techniques),
    .standard = &sheet,
    .selector_key = "technique",
    .look_wide = true,
};

void sheet_range(const sheet_values *values, const float ground[4], float less[4], float more[4])
{
    const colour c = values->ink;
    const float  ink[4] = {c.r, c.g, c.b, 1};
    for (int k = 0; k < 4; k++) {
        less[k] = isnan(c.r) ? ground[k] : fmaxf(ground[k] - ink[k], 0);
        more[k] = isnan(c.r) ? 1 - ground[k] : fmaxf(ink[k] - ground[k], 0);
    }
}

/* --- where the paper lies ------------------------------------------------------------------------------- */

static const double TURN = 6.283185307179586477;
static const double END = 0.5;   /* radians before and after the half turn in which the paper begins again */
static const double PIECE = 0.3; /* size of a grain over that of a piece */

static float fraction(double value)
{
    return (float)(value - floor(value));
}

/* A sheet of `tiles` a pixel that has gone so far from the middle of the model. */
static sheet_position lay_at(const sheet_view *view, double tiles, double u, double v)
{
    double a = tiles * cos(view->roll), b = -tiles * sin(view->roll);
    u -= a * view->anchor[0] - b * view->anchor[1];
    v -= b * view->anchor[0] + a * view->anchor[1];
    return (sheet_position){(float)a, (float)b, fraction(u), fraction(v)};
}

/* One octave, which rolls along like a ball of `radius` pixels. Its number shifts it, so that it is not the next
 * one magnified. */
static void roll_octave(sheet_lie *out, int index, const sheet_view *view, double tiles, double radius, double number)
{
    double around = radius * tiles, shift = 0.381966 * number, azimuth = view->azimuth;
    if (azimuth < END - TURN / 2)
        azimuth += TURN;
    out->octaves[index] = lay_at(view, tiles, around * azimuth + shift, around * view->elevation + shift);
    out->begin[index] = fraction(-TURN * around);
    out->begun = (float)fmax((azimuth - (TURN / 2 - END)) / (2 * END), 0);
}

sheet_lie sheet_lay(const sheet_values *values, const sheet_view *view)
{
    double    tiles = (double)PAPER_TEXELS_A_GRAIN / PAPER_SIDE / (double)values->grain_size;
    sheet_lie out = {.octaves = {{.a = (float)tiles}, {.a = (float)tiles}}};
    if (values->motion != SHEET_FIXED)
        out.pieces = lay_at(view, tiles * PIECE, 0, 0);
    if (values->motion == SHEET_FOLLOWING)
        roll_octave(&out, 0, view, tiles, view->radius * view->fitted, 0);
    if (values->motion != SHEET_ZOOMING)
        return out;
    /* Octave k has 2ᵏ times as many tiles a unit of the model. */
    double octave = log2(view->scale / view->fitted), coarse = floor(octave);
    for (int k = 0; k < 2; k++)
        roll_octave(&out, k, view, tiles * exp2(coarse + k - octave), view->radius * view->scale, coarse + k);
    out.finer = (float)(octave - coarse);
    return out;
}
