/* lines: engraved lines along the form, which swell where it is dark and cross in the dark. Freudenberg 2003, section
 * 5.4; evenly spaced lines after Jobard and Lefer 1997, on the directions of field/direction_field.h. */
#include <math.h>

#include "base/text.h"
#include "surface/marks.h"
#include "surface/surface.h"

static const param params[] = {
    MARK_ROWS(180, "Lines along the diagonal, one beside the other, where all are there,"),
    PARAM_FLOAT_ROW(surface_lines_values, scale, .def = 3.75, .min = 0.75, .max = 150, .soft_min = 1.5, .soft_max = 15,
                    .unit = UNIT_PT, .doc = "Distance of lines on the page; it stays between 0.7 and 1.4 times that."),
    PARAM_FLOAT_ROW(surface_lines_values, length, .toggles = true, .def = 0, .min = 0, .max = 2, .soft_max = 0.5,
                    .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "Mean length of lines, fraction of the model's diagonal; 0 lets them run on."),
    PARAM_FLOAT_ROW(surface_lines_values, uneven, .def = 0.35, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .cpu_only = true, .only_if = "length>0", .doc = "How much lines differ in length."),
    PARAM_FLOAT_ROW(surface_lines_values, groups, .toggles = true, .def = 0, .min = 0, .max = 4, .soft_max = 2,
                    .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "Breadth of groups in which lines begin and end together, as a hand hatches patch by patch, "
                           "in lengths of lines (where these run on, of 0.15); 0: each line by itself."),
    PARAM_FLOAT_ROW(surface_lines_values, overlap, .def = 0.3, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .cpu_only = true, .only_if = "groups>0",
                    .doc = "How far lines of a group run on into the next, at most, in lengths of lines."),
    PARAM_FLOAT_ROW(surface_lines_values, pressure, .toggles = true, .def = 0.6, .min = 0, .max = 1,
                    .unit = UNIT_FRACTION, .only_if = "groups>0",
                    .doc = "How firm lines of groups begin and how much they fade to where they end."),
    PARAM_FLOAT_ROW(surface_lines_values, patchy, .toggles = true, .def = 0.25, .min = 0, .max = 1,
                    .unit = UNIT_FRACTION, .only_if = "groups>0", .doc = "How much groups differ in darkness."),
    PARAM_FLOAT_ROW(surface_lines_values, stray, .toggles = true, .def = 0.6, .min = 0, .max = 4, .soft_max = 2,
                    .only_if = "groups>0",
                    .doc = "How far a group's lines leave the way of the form, all turned by some angle and each a "
                           "little by itself, in distances of lines."),
    PARAM_INT_ROW(surface_lines_values, series, .def = 2, .min = 1, .max = 4, .unit = UNIT_COUNT, .variant = true,
                  .doc = "Sets of lines that cross each other, later ones where it is darker."),
    PARAM_FLOAT_ROW(surface_lines_values, turn, .def = 50, .min = -180, .max = 180, .unit = UNIT_DEGREES,
                    .cpu_only = true, .only_if = "series>1", .doc = "Angle between one set of lines and the next."),
    PARAM_FLOAT_ROW(
        surface_lines_values, slant, .def = 0, .min = -90, .max = 90, .unit = UNIT_DEGREES, .cpu_only = true,
        .doc = "Angle between the first set of lines and the longer edges of flat faces; on round ones they "
               "lie along the form."),
    PARAM_FLOAT_ROW(surface_lines_values, crossed, .def = 0.55, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .only_if = "series>1", .doc = "Darkness from which sets cross."),
    PARAM_BOOL_ROW(surface_lines_values, steady, .def = 0, .variant = true, .only_if = "series>1",
                   .doc = "Sets but the last get no darker than where the next begins to cross them, as lines of a pen "
                          "do; else all swell on."),
    PARAM_FLOAT_ROW(surface_lines_values, room, .toggles = true, .def = 0, .min = 0, .max = 20, .soft_max = 6,
                    .doc = "Faces that are narrower than this, in distances of lines, have fewer, and none below half "
                           "of it; each further set needs as much more; 0: however narrow they are."),
    PARAM_FLOAT_ROW(surface_lines_values, black, .toggles = true, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .only_if = "room>0",
                    .doc = "Darkness from which faces without room for lines are black instead of bare; 0: never."),
    PARAM_FLOAT_ROW(
        surface_lines_values, gradient, .toggles = true, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
        .doc = "How much flat faces, which light alone leaves even, are darker on one side, upwards if they "
               "stand, and lighter on the other."),
    PARAM_FLOAT_ROW(surface_lines_values, sparse, .toggles = true, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Fraction of lines that go a little way from edges into what is bare."),
    PARAM_FLOAT_ROW(surface_lines_values, least, .def = 0.08, .min = 0, .max = 0.5, .unit = UNIT_FRACTION,
                    .doc = "Width, fraction of their distance, below which lines run out."),
    PARAM_FLOAT_ROW(surface_lines_values, widest, .def = 2, .min = 0.05, .max = 2, .soft_max = 1, .unit = UNIT_FRACTION,
                    .doc = "Width, fraction of their distance, that no line exceeds where others are far; 2: any."),
    PARAM_FLOAT_ROW(surface_lines_values, taper, .def = 2.5, .min = 0, .max = 100, .soft_max = 20,
                    .doc = "Length over which an end runs out, in distances of lines."),
    PARAM_FLOAT_ROW(surface_lines_values, tip, .def = 0.7, .min = 0.2, .max = 2,
                    .doc = "How ends run out: below 1 blunt as a knife's cut, 1 a wedge, above 1 a hair."),
    PARAM_FLOAT_ROW(surface_lines_values, join, .def = 1, .min = 0.1, .max = 2,
                    .doc = "Width, fraction of their distance, from which lines no longer run out where they end, "
                           "but join the next one; from half of it on they run out less."),
    PARAM_FLOAT_ROW(surface_lines_values, swell, .toggles = true, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Unevenness of widths from line to line."),
    PARAM_FLOAT_ROW(surface_lines_values, solid, .toggles = true, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Darkness from which the ground between lines is ink, too, as a woodcutter clears the "
                           "lights and a pen fills the deepest shade; 0: never. In pictures only."),
};

static void describe(text *out, const void *values)
{
    const surface_lines_values *v = values;
    text_append(out, "lines %d %d %.9g %.9g %.9g %.9g %d %.9g %.9g", v->common.count, v->common.pattern_seed,
                (double)v->length, (double)v->uneven, (double)v->groups, (double)v->overlap, v->series, (double)v->turn,
                (double)v->slant);
}

/* Levels from lines of which a few go over the whole to the closest; no more of these than a large surface has room
 * for. */
static lmn_status make(marks *out, const mark_surface *surface, double extent, const void *values, lmn_error *error)
{
    const double GROUPED = 0.15; /* length of lines of groups where none is given */
    enum { LINES_MOST = 1000, LENGTH_MOST = 800 /* diagonals, of a set */, LEVELS_MOST = 12 };
    const surface_lines_values *v = values;
    double                      apart = extent / fmin(v->common.count, LINES_MOST), area = mark_surface_area(surface);
    double                      length = extent * (v->groups > 0 && !(v->length > 0) ? GROUPED : (double)v->length);
    int                         levels = 1;
    apart = fmax(apart, area / fmax(extent * LENGTH_MOST, 1e-300));
    while (levels < LEVELS_MOST && ldexp(apart, levels) < extent / 5)
        levels++;
    return marks_streamlines(out, surface,
                             &(flow_options){.apart = apart,
                                             .levels = levels,
                                             .length = length,
                                             .uneven = v->uneven,
                                             .groups = (double)v->groups,
                                             .overlap = (double)v->overlap,
                                             .series = v->series,
                                             .turn = v->turn * (3.14159265f / 180),
                                             .slant = v->slant * (3.14159265f / 180),
                                             .sag = extent / 3000,
                                             .seed = (uint32_t)v->common.pattern_seed},
                             error);
}

static const mark_source source = {
    .describe = describe, .make = make, .vertex = "surface/marks_lines.vert", .fragment = "surface/marks_lines.frag"};

const technique surface_lines = {
    .name = "lines",
    .doc = "Engraved lines that lie along the form, keep their distance on the page and swell where it is dark.",
    .example = "{\"surface\": {\"technique\": \"lines\"}, \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(surface_lines_values),
    .channels = CHANNEL_NORMAL_DEPTH,
    .surface = &(const surface_row){.shader = "surface/marks_paper.glsl", .marks = &source},
};
