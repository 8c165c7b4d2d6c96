/* traces: what moves draws lines behind it, as illustrators tell of motion in a still: speed lines from its trailing
 * side along the way that it came, and its contours where it has been. Großmann 2011, sections 3.3.2 and 3.3.3, after
 * Masuch, Schlechtweg and Schulz 1999 and Hanl; rows 15, 16, 18, 19, 21, 24, 25, 28 to 31, 77k. */
#include "motion/traces.h"

#include <math.h>

static const char *const origin_names[] = {"outline", "vertices", "circle", NULL};
static const char *const flow_names[] = {"parallel", "converging", NULL};
static const char *const ends_names[] = {"fading", "heavy", "wedges", NULL};
static const char *const figures_names[] = {"outlines", "bones", "points", "solids", "swept", NULL};
static const char *const brush_names[] = {"lines", "pen", "brush", "pencil", "charcoal", NULL};
static const char *const moments_names[] = {"times", "lengths", "telling", "auto", NULL};

#define COUNT(KEY, ...)  PARAM_INT_ROW(traces_values, KEY, .cpu_only = true, .unit = UNIT_COUNT, __VA_ARGS__)
#define NUMBER(KEY, ...) PARAM_FLOAT_ROW(traces_values, KEY, .cpu_only = true, __VA_ARGS__)

static const param params[] = {
    PARAM_COLOUR_ROW(traces_values, colour, .def_colour = {NAN, NAN, NAN, 1}, .can_auto = true, .def_auto = true,
                     .cpu_only = true, .doc = "Colour of what is drawn; auto takes that of the rule's lines."),
    NUMBER(width, .def = 1.2, .min = 0.075, .max = 24, .soft_max = 4.5, .unit = UNIT_PT,
           .doc = "Width of speed lines where they are widest."),
    COUNT(lines, .def = 24, .min = 0, .max = 2000, .soft_max = 100,
          .doc = "How many speed lines there are, over all that moves; 0 draws none."),
    PARAM_ENUM_ROW(
        traces_values, origin, .names = origin_names, .def = TRACES_OUTLINE, .cpu_only = true, .only_if = "lines>0",
        .doc =
            "Where speed lines begin: outline, at the rear of what moves, at heights that are spread "
            "unevenly; vertices, at the rearmost vertex of each of equal strips; circle, like outline, but around what "
            "comes nearer or goes away on a circle, evenly."),
    PARAM_ENUM_ROW(traces_values, ends, .names = ends_names, .def = TRACES_FADING, .cpu_only = true,
                   .only_if = "lines>0",
                   .doc = "How speed lines run out: fading, ever finer and fainter; heavy, finer from a strong "
                          "beginning; wedges, straight-sided from twice the width to nothing."),
    NUMBER(length, .def = 1, .min = 0.01, .max = 1, .unit = UNIT_FRACTION, .only_if = "lines>0",
           .doc = "Length of speed lines, fraction of the way during the exposure."),
    NUMBER(uneven, .def = 0.5, .min = 0, .max = 1, .unit = UNIT_FRACTION, .only_if = "lines>0",
           .doc = "How much speed lines differ in length and distance."),
    NUMBER(begin, .def = 3, .min = 0, .max = 150, .soft_max = 24, .unit = UNIT_PT, .only_if = "lines>0",
           .doc = "How far behind what moves speed lines begin."),
    COUNT(groups, .def = 1, .min = 1, .max = 8, .soft_max = 4, .only_if = "lines>0",
          .doc = "Lines side by side in place of each one."),
    NUMBER(group_apart, .def = 2.25, .min = 0.1, .max = 48, .soft_max = 9, .unit = UNIT_PT, .only_if = "groups>1",
           .doc = "How far apart those are."),
    NUMBER(probability, .def = 1, .min = 0, .max = 1, .unit = UNIT_FRACTION, .only_if = "lines>0",
           .doc = "With which probability each line is there, anew for each frame of a film."),
    COUNT(flow, .def = 0, .min = 0, .max = 2000, .soft_max = 100,
          .doc = "How many flow lines run behind what moves and on ahead of it, to where it goes; 0 draws none."),
    PARAM_ENUM_ROW(traces_values, flow_way, .names = flow_names, .def = TRACES_PARALLEL, .cpu_only = true,
                   .only_if = "flow>0", .doc = "Flow lines run side by side, or converge at a point ahead."),
    NUMBER(flow_length, .def = 0.3, .min = 0.01, .max = 2, .soft_max = 1, .unit = UNIT_FRACTION, .only_if = "flow>0",
           .doc = "How far ahead of what moves they run, fraction of the picture's longer side."),
    COUNT(contours, .def = 0, .min = 0, .max = 64, .soft_max = 12,
          .doc = "How many times the contours of what moves are drawn where it has been; 0 draws none."),
    PARAM_ENUM_ROW(traces_values, figures, .names = figures_names, .def = TRACES_OUTLINES, .cpu_only = true,
                   .only_if = "contours>0",
                   .doc =
                       "What is drawn of those times: outlines; bones, lines from joint to joint, of parts without a "
                       "skin their middle lines; points, marks at their ends alone; solids, a cone with round ends "
                       "in place of each limb; swept, one outline around all that was covered on the way."),
    PARAM_TEXT_ROW(traces_values, bones, .example = "*Leg*", .only_if = "figures=bones,points,solids",
                   .doc = "Which of them, by the names of joints and nodes, for example '*Leg*'; empty: all."),
    PARAM_ENUM_ROW(traces_values, moments, .names = moments_names, .def = TRACES_AT_TIMES, .cpu_only = true,
                   .only_if = "contours>0",
                   .doc = "Contours at equal times, farther apart where motion is fast; at equal lengths of the way; "
                          "telling, where most of what moves turns back, rebounds or stops, and in between where there "
                          "are fewer such moments; auto, only there."),
    NUMBER(cover, .def = 0.5, .min = 0, .max = 1, .unit = UNIT_FRACTION, .only_if = "moments=telling,auto",
           .doc = "How much of a figure at one moment may lie over that at another one, fraction of the smaller."),
    NUMBER(fade, .def = 0.75, .min = 0, .max = 1, .unit = UNIT_FRACTION, .only_if = "contours>0",
           .doc = "Opacity of each contour, fraction of the next newer one's."),
    NUMBER(contour_width, .def = 0.9, .min = 0.075, .max = 24, .soft_max = 4.5, .unit = UNIT_PT,
           .only_if = "contours>0", .doc = "Width of contours of the past."),
    NUMBER(contour_dash, .def = 0, .min = 0, .max = 75, .soft_max = 15, .unit = UNIT_PT, .only_if = "contours>0",
           .doc = "Length of their dashes, with gaps half as long; 0: unbroken."),
    PARAM_ENUM_ROW(traces_values, contour_brush, .names = brush_names, .def = 0, .cpu_only = true,
                   .only_if = "contours>0", .doc = "What they are drawn with; lines: as the rule's lines are."),
    PARAM_BOOL_ROW(traces_values, trailing, .def = 0, .cpu_only = true, .only_if = "contours>0",
                   .doc = "Only the side of contours that trails."),
    PARAM_BOOL_ROW(traces_values, in_front, .def = 0, .cpu_only = true, .only_if = "contours>0",
                   .doc = "They lie before what is there now instead of behind it."),
    PARAM_BOOL_ROW(traces_values, creases, .def = 0, .cpu_only = true, .only_if = "contours>0",
                   .doc = "Creases, too, where it has been."),
    COUNT(vibration, .def = 0, .min = 0, .max = 20, .soft_max = 5,
          .doc = "How many small arcs lie beside both sides of what swings to and fro at least once in the exposure; 0 "
                 "draws none."),
    NUMBER(vibration_apart, .def = 4.5, .min = 0.1, .max = 150, .soft_max = 24, .unit = UNIT_PT,
           .only_if = "vibration>0", .doc = "How far apart those are."),
};

const technique motion_traces = {
    .name = "traces",
    .doc = "Speed lines and contours of the past: what moves stays whole and draws lines behind it.",
    .example = "{\"motion\": {\"technique\": \"traces\", \"exposure\": 0.5, \"contours\": 3}, \"surface\": \"lit\", "
               "\"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(traces_values),
    .motion = &(const motion_row){.traces = true},
};
