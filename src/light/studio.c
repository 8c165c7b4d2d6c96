/* studio: a key light that goes with the viewer, a weaker fill light from the other side and, where a look wants it, a
 * rim light from behind; or the file's own lights. */
#include "light/light.h"
#include "cut/cut.h"

static const char *const source_names[] = {"studio", "file", NULL};
static const char *const round_names[] = {"false", "true", "forms", NULL};
static const char *const tone_range_names[] = {"none", "auto", NULL};
static const char *const ground_names[] = {"none", "contact", "cast", NULL};

/* Percentages need no bounds to be well-formed. */
static lmn_status check_cut(const char *text, lmn_error *error)
{
    cut ignored;
    return cut_parse(&ignored, text, (box3){{0, 0, 0}, {1, 1, 1}}, error);
}

static const param params[] = {
    PARAM_DIRECTION_ROW(scene_values, light_direction, .def_direction = {-0.45f, 0.75f, 0.85f}, .min = -1e6, .max = 1e6,
                        .cpu_only = true,
                        .doc = "Direction towards the key light as the viewer sees it: right, up, to the viewer."),
    PARAM_FLOAT_ROW(scene_values, fill, .def = 0.25, .min = 0, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "Strength of a fill light from the other side."),
    PARAM_FLOAT_ROW(scene_values, rim, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "Strength of a light from behind, on the side of the page that the key light is not on: it "
                           "lifts shaded borders off what is beside them, as reflected light does."),
    PARAM_FLOAT_ROW(scene_values, crease_angle, .def = 30, .min = 0, .max = 180, .unit = UNIT_DEGREES, .cpu_only = true,
                    .doc = "Faces that meet at less are smoothed where a model brings no normals."),
    PARAM_ENUM_ROW(scene_values, round, .names = round_names, .cpu_only = true,
                   .doc = "true: coarse meshes are drawn as the curved surfaces that their normals tell of, outlines "
                          "included; flat faces and sharp edges stay. forms: only cages of heads, figures and the like "
                          "that are shaded smooth all over; what is constructed keeps its facets."),
    PARAM_ENUM_ROW(scene_values, lights, .names = source_names, .cpu_only = true,
                   .doc = "studio: the lights above; file: the model's lights, if it has any."),
    PARAM_FLOAT_ROW(scene_values, light_scale, .def = 1, .min = 0, .max = 1000, .soft_max = 4, .cpu_only = true,
                    .doc = "Multiplies all lights."),
    PARAM_BOOL_ROW(
        scene_values, shadows, .def = 0, .cpu_only = true,
        .doc =
            "The first light throws shadows, if it shines from one direction; with halftones they are denser strokes."),
    PARAM_FLOAT_ROW(scene_values, shadow_softness, .def = 0, .min = 0, .max = 60, .soft_max = 20, .unit = UNIT_DEGREES,
                    .cpu_only = true, .only_if = "shadows",
                    .doc = "How wide the light is as the model sees it: the farther a shadow falls, the softer its "
                           "border; 0 is hard, the sun has 0.5."),
    PARAM_FLOAT_ROW(scene_values, occlusion, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "How much darker corners and clefts get, which see little of the sky: ambient occlusion; "
                           "with halftones denser strokes."),
    PARAM_FLOAT_ROW(
        scene_values, occlusion_radius, .def = 0.1, .min = 0.001, .max = 1, .soft_min = 0.02, .soft_max = 0.4,
        .unit = UNIT_FRACTION, .logarithmic = true, .cpu_only = true, .only_if = "occlusion",
        .doc = "How far off something may stand to keep the sky from a place, fraction of the model's diagonal."),
    PARAM_ENUM_ROW(scene_values, tone_range, .names = tone_range_names, .cpu_only = true,
                   .doc = "auto: the lightest of what is seen is drawn as full light and the darkest as no light, so "
                          "that halftones and pencils use all their tones on any model."),
    PARAM_ENUM_ROW(scene_values, ground, .names = ground_names, .cpu_only = true,
                   .doc = "contact: the model stands on a ground, which is darker where it is touched or nearly so; "
                          "pencils and printed screens draw that, others lay a tone. cast: the first light throws "
                          "the model's shadow there, as soft as shadow_softness, as a tone, where most of it stands on "
                          "one level; soft ones are drawn by pencils, sticks, stippling and printed screens. Not "
                          "seen from below, nor in sections."),
    PARAM_FLOAT_ROW(scene_values, ground_strength, .def = 0.55, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .cpu_only = true, .only_if = "ground",
                    .doc = "How dark the ground is where it is touched, or where no light falls."),
    PARAM_FLOAT_ROW(scene_values, ground_reach, .def = 0.15, .min = 0.005, .max = 1, .soft_min = 0.03, .soft_max = 0.4,
                    .unit = UNIT_FRACTION, .logarithmic = true, .cpu_only = true, .only_if = "ground",
                    .doc = "Height over the ground in which a shadow fades to a third, fraction of the model's "
                           "diagonal; the higher, the softer it is, too. A cast one by ground_fade."),
    PARAM_FLOAT_ROW(scene_values, ground_fade, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .only_if = "ground=cast",
                    .doc = "How much paler a cast shadow gets with the height of what throws it: 0 it is even, 1 what "
                           "is thrown from high up is gone. Its border gets softer as it fades, strokes run out."),
    PARAM_BOOL_ROW(scene_values, ground_flat, .def = 0, .cpu_only = true, .only_if = "ground",
                   .doc = "The shadow is one flat tone with a border, instead of one that fades; a cast one is two "
                          "tones."),
    PARAM_COLOUR_ROW(scene_values, ground_colour, .def_colour = {0.09f, 0.09f, 0.12f, 1}, .cpu_only = true,
                     .only_if = "ground", .doc = "Colour of the shadow where it is a tone."),
    PARAM_FLOAT_ROW(scene_values, ground_edge, .def = 0, .min = 0, .max = 12, .soft_max = 2, .unit = UNIT_PT,
                    .cpu_only = true, .only_if = "ground=cast",
                    .doc = "Width of the line along the border of the shadow; 0: none. Soft shadows have none."),
    PARAM_FLOAT_ROW(scene_values, ground_hatch, .def = 0, .min = 0, .max = 50, .soft_max = 9, .unit = UNIT_PT,
                    .cpu_only = true, .only_if = "ground=cast",
                    .doc = "Distance of the strokes that the shadow is drawn with, as broad as it is dark and tapered "
                           "at its border; 0: a tone."),
    PARAM_FLOAT_ROW(scene_values, ground_angle, .def = 0, .min = -180, .max = 180, .unit = UNIT_DEGREES,
                    .cpu_only = true, .only_if = "ground_hatch",
                    .doc = "Direction of these strokes on the page: 0 is level, 90 upright."),
    PARAM_FLOAT_ROW(scene_values, ground_smoothing, .def = 0, .min = 0, .max = 60, .soft_max = 18, .unit = UNIT_PT,
                    .cpu_only = true, .only_if = "ground=cast",
                    .doc = "The border of a hard shadow on the ground is smoothed over this radius, and small scraps "
                           "of shadow that nothing near throws are left out; 0: it is as it falls."),
    PARAM_FLOAT_ROW(scene_values, focus, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "Depth focus: fraction of the ink that lines and strokes lose away from the depth that is "
                           "looked at; the paper stays what it is."),
    PARAM_FLOAT_ROW(
        scene_values, focus_at, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
        .only_if = "focus",
        .doc = "The depth with all its ink, fraction of the model's depth: 0 is the nearest place, 1 the farthest."),
    PARAM_FLOAT_ROW(scene_values, focus_depth, .def = 0.8, .min = 0.01, .max = 2, .soft_max = 1, .unit = UNIT_FRACTION,
                    .cpu_only = true, .only_if = "focus",
                    .doc = "How far away from there the most ink is lost, fraction of the model's depth."),
    PARAM_FLOAT_ROW(scene_values, depth_cue, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "Fraction of their colourfulness that filled surfaces lose at the farthest place, less in "
                           "front of it; how light they are stays."),
    PARAM_TEXT_ROW(scene_values, datum, .example = "height",
                   .doc = "An attribute that files state about parts, shown as their colour: a ramp for numbers, a "
                          "colour each for words. A height that is not stated is that of the part's top."),
    PARAM_PALETTE_ROW(scene_values, datum_palette,
                      .def_palette = {5,
                                      {{0.98f, 0.92f, 0.75f, 1},
                                       {0.96f, 0.75f, 0.46f, 1},
                                       {0.89f, 0.51f, 0.35f, 1},
                                       {0.70f, 0.30f, 0.36f, 1},
                                       {0.38f, 0.19f, 0.36f, 1}}},
                      .cpu_only = true, .only_if = "datum",
                      .doc = "The colours of the ramp from the least to the most, or of the words one by one."),
    PARAM_TEXT_ROW(scene_values, datum_words, .example = "house,office", .only_if = "datum",
                   .doc = "Words that get the colours in this order, separated by commas, and by | where several "
                          "share one; empty: the most frequent first, and numbers are numbers."),
    PARAM_FLOAT_ROW(scene_values, datum_from, .def = 0, .min = -1e9, .max = 1e9, .soft_min = 0, .soft_max = 100,
                    .cpu_only = true, .only_if = "datum",
                    .doc = "Number with the first colour; where it is not below the other end, both ends are those of "
                           "the parts that are drawn."),
    PARAM_FLOAT_ROW(scene_values, datum_to, .def = 0, .min = -1e9, .max = 1e9, .soft_min = 0, .soft_max = 100,
                    .cpu_only = true, .only_if = "datum", .doc = "Number with the last colour."),
    PARAM_INT_ROW(scene_values, datum_classes, .def = 0, .min = 0, .max = 16, .soft_max = 8, .unit = UNIT_COUNT,
                  .cpu_only = true, .only_if = "datum",
                  .doc = "Numbers fall into so many classes of one colour each; 0: colours go over into each other."),
    PARAM_COLOUR_ROW(scene_values, datum_other, .def_colour = {0.85f, 0.85f, 0.85f, 1}, .cpu_only = true,
                     .only_if = "datum", .doc = "Colour of parts that have no value; none: their own."),
    PARAM_TEXT_ROW(scene_values, cut, .example = "x=55%", .check = check_cut,
                   .doc = "What is cut away: planes and boxes separated by ';', such as x, -z=40% or "
                          "box=50%,0%,50%:100%,100%,100%; see draw.md."),
    PARAM_TEXT_ROW(scene_values, cut_keep, .example = "ball", .is_selector = true, .only_if = "cut",
                   .doc = "Selector of parts that are not cut through, as draughtsmen leave shafts and bolts whole."),
    PARAM_FLOAT_ROW(
        scene_values, cut_hatch, .def = 6.75, .min = 0, .max = 150, .soft_max = 22.5, .unit = UNIT_PT, .cpu_only = true,
        .only_if = "cut",
        .doc = "Distance of the lines that hatch cut faces; 0 draws none. Neighbouring parts differ a little."),
    PARAM_FLOAT_ROW(scene_values, cut_angle, .def = 45, .min = -180, .max = 180, .unit = UNIT_DEGREES, .cpu_only = true,
                    .only_if = "cut",
                    .doc = "Angle of these lines; each part turns it further, so that neighbours differ."),
    PARAM_FLOAT_ROW(scene_values, cut_width, .def = 0.75, .min = 0.075, .max = 48, .soft_max = 4.5, .unit = UNIT_PT,
                    .cpu_only = true, .only_if = "cut", .doc = "Width of these lines."),
    PARAM_COLOUR_ROW(scene_values, cut_colour, .def_colour = {0.13f, 0.13f, 0.15f, 1}, .cpu_only = true,
                     .only_if = "cut", .doc = "Colour of these lines."),
    PARAM_COLOUR_ROW(scene_values, cut_fill, .can_auto = true, .def_auto = true, .cpu_only = true, .only_if = "cut",
                     .doc = "Colour of cut faces; auto takes the part's own, nearly white, none leaves them white."),
};

static const technique studio = {
    .name = "studio",
    .doc = "Light and geometry preparation.",
    .example = "{\"surface\": \"pencil\", \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(scene_values),
};

static const technique *const techniques[] = {&studio};

const kind kind_scene = {
    .id = KIND_SCENE,
    .name = "scene",
    .doc = "Light and geometry preparation, for the whole look.",
    .techniques = techniques,
    .technique_count = PARAM_COUNT(techniques),
    .standard = &studio,
    .selector_key = "technique",
    .look_wide = true,
};
