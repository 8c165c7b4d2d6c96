/* strokes: lines with geometry, from the edges of meshes instead of from pictures. Freudenberg 2003, chapters 5 and
 * 7; rows OE-05 to OE-08, EX-12 to EX-14. */
#include "lines/stroke/strokes.h"

#include <math.h>

static const char *const contour_names[] = {"none", "edges", "smooth", NULL};
static const char *const brush_names[] = {"pen", "brush", "pencil", "charcoal", NULL};
static const char *const hidden_names[] = {"none", "solid", "dashed", NULL};
static const char *const visibility_names[] = {"auto", "exact", "sampled", NULL};

/* A row of a member of a member. */
#define ROW(KEY, FIELD, TYPE, CTYPE, ...)                                                                              \
    {                                                                                                                  \
        .key = KEY, .type = TYPE, .offset = PARAM_OFFSET(strokes_values, FIELD, CTYPE), .cpu_only = true, __VA_ARGS__  \
    }
#define FLAG(KEY, FIELD, ...)   ROW(KEY, FIELD, PARAM_BOOL, bool, __VA_ARGS__)
#define NUMBER(KEY, FIELD, ...) ROW(KEY, FIELD, PARAM_FLOAT, float, __VA_ARGS__)
#define CHOICE(KEY, FIELD, ...) ROW(KEY, FIELD, PARAM_ENUM, int32_t, __VA_ARGS__)

static const param params[] = {
    CHOICE("contours", options.contours, .names = contour_names, .def = CONTOURS_EDGES,
           .doc = "Outlines: none; along edges of the mesh, exactly around what is there; or smooth, where the surface "
                  "that is meant turns away."),
    FLAG("creases", options.creases, .def = 1, .doc = "Lines where faces meet at more than scene.crease_angle."),
    FLAG("borders", options.borders, .def = 1, .doc = "Lines where a surface ends."),
    FLAG("materials", options.materials, .def = 1, .doc = "Lines where a part's material changes."),
    FLAG("intersections", options.intersections, .def = 1, .doc = "Lines where surfaces run through each other."),
    FLAG("drawn", options.drawn, .def = 1, .doc = "Lines that the file brings: glTF's lines, the \"l\" of OBJ."),
    NUMBER("suggestive", options.suggestive, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
           .doc = "Suggestive contours: lines where an outline would appear if the eye moved a little; 1 draws the "
                  "strongest, less draws more, 0 none."),
    NUMBER("ridges", options.ridges, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
           .doc = "Lines along rounded ridges; 1 draws the sharpest, less draws more, 0 none."),
    NUMBER("valleys", options.valleys, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
           .doc = "Lines along rounded valleys; 1 draws the sharpest, less draws more, 0 none."),
    NUMBER("apparent", options.apparent, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
           .doc =
               "Apparent ridges: lines where what is seen bends most; 1 draws the strongest, less draws more, 0 none."),
    ROW("refine", options.refine, PARAM_INT, int32_t, .def = 0, .min = 0, .max = 3, .soft_max = 2, .unit = UNIT_COUNT,
        .doc = "Times surfaces are refined before their lines are found: coarse ones become round, edges sharper than "
               "scene.crease_angle stay sharp. Each time makes four "
               "triangles of one. What fills the picture keeps the surface that it has."),
    ROW("curve", options.curve, PARAM_INT, int32_t, .def = 0, .min = 0, .max = 4, .soft_max = 3, .unit = UNIT_COUNT,
        .doc = "Times outlines, borders and creases are refined as curves, from corner to corner; 0 leaves them as "
               "straight as they are."),
    NUMBER("round", options.round, .def = 0, .min = 0, .max = 24, .soft_max = 3, .unit = UNIT_PT, .only_if = "curve=0",
           .doc = "Outlines, borders, creases and lines of the file that stand for curves are drawn as curves, with "
                  "visibility exact, and leave the mesh for it by no more than this; straight lines and corners stay "
                  "as they are."),
    NUMBER("shortest", options.shortest, .def = 0.75, .min = 0, .max = 150, .soft_max = 15, .unit = UNIT_PT,
           .along = true, .doc = "Lines shorter than this are left out."),
    NUMBER("crowd", options.crowd, .def = 0.5625, .min = 0, .max = 12, .soft_max = 3, .unit = UNIT_PT,
           .doc = "Lines that run all their length this close to more important ones are left out; 0 keeps them all."),
    NUMBER(
        "detail", options.detail, .def = 0.75, .min = 0, .max = 1, .unit = UNIT_FRACTION,
        .doc =
            "How many lines are drawn where they crowd, with visibility exact: the least important ones go first, "
            "whole, small pieces keep their outlines alone, and short lines that belong to nothing go; 1 draws all."),
    NUMBER("simplify", options.simplify, .def = 0.075, .min = 0, .max = 6, .soft_max = 1.5, .unit = UNIT_PT,
           .doc = "How far points of lines may move so that fewer are needed."),
    NUMBER("crease_width", style.crease_width, .def = 0.7, .min = 0.1, .max = 2, .soft_max = 1, .unit = UNIT_FRACTION,
           .doc = "Width of all lines that are no outlines, fraction of the width."),
    NUMBER("cover", style.cover, .def = 0.3, .min = 0.02, .max = 1, .soft_min = 0.1, .soft_max = 1,
           .unit = UNIT_FRACTION,
           .doc = "Lines that crowd get finer, so that they cover no more than this of the page around them, with "
                  "visibility exact; at 1 all keep their width."),
    CHOICE("brush", style.brush, .names = brush_names, .doc = "What the lines are drawn with."),
    NUMBER("taper", style.taper, .def = 0, .min = 0, .max = 150, .soft_max = 45, .unit = UNIT_PT, .along = true,
           .doc = "Length over which lines thin out towards their ends; 0 leaves them as wide as they are."),
    NUMBER("pressure", style.pressure, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
           .doc = "How much the width varies along a line."),
    NUMBER("wobble", style.wobble, .def = 0, .min = 0, .max = 24, .soft_max = 4.5, .unit = UNIT_PT,
           .doc = "How far lines stray, as if drawn by hand."),
    NUMBER("wobble_length", style.wobble_length, .def = 30, .min = 1.5, .max = 300, .soft_max = 120, .unit = UNIT_PT,
           .along = true, .only_if = "wobble", .doc = "How far apart the waves of straying lines are."),
    ROW("repeats", style.repeats, PARAM_INT, int32_t, .def = 1, .min = 1, .max = 8, .soft_min = 1, .soft_max = 4,
        .unit = UNIT_COUNT, .doc = "Times each line is drawn, from corner to corner."),
    NUMBER("repeat_apart", style.repeat_apart, .def = 1.5, .min = 0, .max = 24, .soft_max = 6, .unit = UNIT_PT,
           .only_if = "repeats>1", .doc = "How far repeated lines differ at their ends."),
    NUMBER("repeat_turn", style.repeat_turn, .def = 2.5, .min = 0, .max = 45, .soft_max = 10, .unit = UNIT_DEGREES,
           .only_if = "repeats>1",
           .doc = "By how much repeated lines may differ in direction; 0: by any angle that brings their ends no "
                  "farther apart."),
    NUMBER("repeat_least", style.repeat_least, .def = 0, .min = 0, .max = 300, .soft_max = 60, .unit = UNIT_PT,
           .along = true, .only_if = "repeats>1",
           .doc = "Lines shorter than this, and those that crowd, are drawn once, those twice as long as often as any; "
                  "0: all are drawn as often."),
    NUMBER("repeat_fade", style.repeat_fade, .def = 1, .min = 0.05, .max = 1, .unit = UNIT_FRACTION,
           .only_if = "repeats>1", .doc = "Opacity of each repetition, fraction of that of the one before."),
    NUMBER("pull", style.pull, .def = 0, .min = 0, .max = 1500, .soft_max = 300, .unit = UNIT_PT, .along = true,
           .doc =
               "Longest curve that is drawn in one go: longer ones are drawn in several, which overlap; 0 draws from "
               "corner to corner."),
    NUMBER("overshoot_most", style.overshoot_most, .def = 0.15, .min = 0.01, .max = 1, .soft_max = 0.5,
           .unit = UNIT_FRACTION, .only_if = "repeats>1",
           .doc = "Lines run on by no more than this fraction of their own length."),
    {.key = "hidden",
     .type = PARAM_ENUM,
     .offset = PARAM_OFFSET(strokes_values, style.hidden, int32_t),
     .names = hidden_names,
     .variant = true,
     .doc = "Lines behind surfaces: none, solid or dashed."},
    {.key = "hidden_colour",
     .type = PARAM_COLOUR,
     .offset = PARAM_OFFSET(strokes_values, style.hidden_colour, colour),
     .def_colour = {0.42f, 0.46f, 0.52f, 1},
     .only_if = "hidden",
     .doc = "Colour of hidden lines."},
    NUMBER("hidden_width", style.hidden_width, .def = 0.9, .min = 0.375, .max = 24, .soft_max = 3, .unit = UNIT_PT,
           .only_if = "hidden", .doc = "Width of hidden lines."),
    NUMBER("hidden_dash", style.hidden_dash, .def = 4.5, .min = 0.375, .max = 150, .soft_max = 18, .unit = UNIT_PT,
           .along = true, .only_if = "hidden=dashed", .doc = "Length of the dashes of hidden lines."),
    NUMBER("hidden_gap", style.hidden_gap, .def = 3, .min = 0.375, .max = 150, .soft_max = 18, .unit = UNIT_PT,
           .along = true, .only_if = "hidden=dashed", .doc = "Length of the gaps between the dashes of hidden lines."),
    NUMBER("hidden_fade", style.hidden_fade, .def = 0.8, .min = 0, .max = 1, .unit = UNIT_FRACTION, .only_if = "hidden",
           .doc = "Opacity of hidden lines is multiplied by it with each body more in front of them."),
    ROW("hidden_depth", style.hidden_depth, PARAM_INT, int32_t, .def = 0, .min = 0, .max = 64, .soft_max = 8,
        .unit = UNIT_COUNT, .only_if = "hidden",
        .doc = "Surfaces that may lie in front of hidden lines; 0 is any number."),
    NUMBER("hidden_crowd", style.hidden_crowd, .def = 0, .min = 0, .max = 48, .soft_max = 9, .unit = UNIT_PT,
           .along = true, .only_if = "hidden",
           .doc = "Hidden lines keep this far apart, the more important ones staying; 0 draws all."),
    CHOICE("visibility", visibility, .names = visibility_names,
           .doc = "How lines know where they are hidden: exact, by geometry, with chains of lines that styles run "
                  "along; sampled, edge by edge from the depth of "
                  "the picture, which is faster; auto takes the faster one where contours and style allow it."),
};

static const pass passes[] = {
    {.name = "strokes", .strokes = true, .reads = {TARGET_DEPTH}, .writes = TARGET_EDGE},
    LINES_PASSES_CONTRAST,
};

static void own_strokes(stroke_options *options, stroke_style *style, const void *values)
{
    *options = strokes_options_of(values);
    *style = strokes_style_of(values);
}

const technique lines_strokes = {
    .name = "strokes",
    .doc = "Lines with geometry: outlines, creases and borders of the mesh itself, drawn as strokes.",
    .example = "{\"lines\": {\"operator\": \"strokes\", \"visibility\": \"exact\"}, \"surface\": \"flat\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(strokes_values),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .lines = &(const lines_row){.own_ink = true, .as_strokes = own_strokes},
};

stroke_style strokes_style_of(const strokes_values *v)
{
    const lines_common *c = &v->common;
    stroke_style        s = v->style;
    for (int i = 0; i < STROKE_CLASS_COUNT; i++) {
        int channel = strokes_channel((stroke_class)i);
        s.colours[i] = channel == 0 ? c->colour : channel == 1 ? c->inner_colour : c->id_colour;
    }
    s.width = c->width;
    s.overshoot = c->overshoot;
    s.dash = c->dash;
    s.gap = c->gap;
    s.halo = c->halo;
    return s;
}

stroke_options strokes_options_of(const strokes_values *v)
{
    stroke_options w = v->options;
    w.hidden = v->style.hidden != HIDDEN_NONE;
    w.width = v->common.width;
    return w;
}

bool strokes_need_chains(const strokes_values *v)
{
    const stroke_style   *s = &v->style;
    const stroke_options *w = &v->options;
    bool                  kinds = stroke_options_bend(w) || w->curve > 0;
    bool style = s->brush != BRUSH_PEN || s->taper > 0 || s->pressure > 0 || s->wobble > 0 || s->repeats > 1 ||
                 s->hidden != HIDDEN_NONE;
    return kinds || style || s->pull > 0 || v->common.overshoot > 0 || v->common.dash > 0 || v->common.halo > 0;
}
