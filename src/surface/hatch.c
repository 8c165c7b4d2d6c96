/* hatch: lines that are worked out where they are needed, at any zoom as dense and as wide on the page, and fixed
 * to the surface. Tone comes by their number or by their width. Freudenberg 2003, section 6.7 (its frequency and
 * taper mended, see hatch.glsl); rows IM-11, IM-21 to IM-27, IM-31. */
#include "surface/halftone/halftone.h"
#include "surface/surface.h"

typedef struct hatch {
    halftone_values common;
    int32_t         tone_by, series;
    float           scale, width, turn, length, gap, taper, wobble, uneven, loose, change;
} hatch;

static const char *const tone_names[] = {"number", "width", NULL};

static const param params[] = {
    HALFTONE_ROWS(COORDINATES_AXES),
    HALFTONE_INK_ROWS,
    PARAM_ENUM_ROW(
        hatch, tone_by, .names = tone_names, .variant = true,
        .doc = "Darker places have more lines (number), as in pen drawings, or wider ones (width), as in engravings."),
    PARAM_FLOAT_ROW(hatch, scale, .def = 4.5, .min = 0.75, .max = 150, .soft_min = 1.5, .soft_max = 22.5,
                    .unit = UNIT_PT,
                    .doc = "Distance of lines at which the next set begins to cross them; only deep shade brings them "
                           "closer. By width: distance everywhere, about."),
    PARAM_FLOAT_ROW(hatch, width, .def = 0.9, .min = 0.075, .max = 48, .soft_max = 4.5, .unit = UNIT_PT,
                    .only_if = "tone_by=number", .doc = "Width of the lines."),
    PARAM_INT_ROW(hatch, series, .def = 2, .min = 1, .max = 4, .unit = UNIT_COUNT, .variant = true,
                  .doc = "Sets of lines that cross each other in dark places."),
    PARAM_FLOAT_ROW(hatch, turn, .def = 60, .min = -180, .max = 180, .unit = UNIT_DEGREES, .as_turn = true,
                    .only_if = "series>1", .doc = "Angle between one set of lines and the next."),
    PARAM_FLOAT_ROW(hatch, length, .toggles = true, .def = 82.5, .min = 0, .max = 3000, .soft_max = 225,
                    .unit = UNIT_PT, .doc = "Mean length of strokes; 0 lets lines run on."),
    PARAM_FLOAT_ROW(hatch, gap, .def = 3.75, .min = 0, .max = 150, .soft_max = 22.5, .unit = UNIT_PT,
                    .only_if = "length>0", .doc = "Space between strokes on a line."),
    PARAM_FLOAT_ROW(hatch, taper, .def = 12, .min = 0, .max = 300, .soft_max = 45, .unit = UNIT_PT,
                    .only_if = "length>0", .doc = "Length over which a stroke runs out to its tips."),
    PARAM_FLOAT_ROW(hatch, wobble, .toggles = true, .def = 0.3, .min = 0, .max = 4, .soft_max = 1,
                    .unit = UNIT_FRACTION, .doc = "How far lines waver, fraction of their distance."),
    PARAM_FLOAT_ROW(hatch, uneven, .toggles = true, .def = 0.15, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Unevenness of the tone, which makes lines swell and thin."),
    PARAM_FLOAT_ROW(hatch, loose, .toggles = true, .def = 0.25, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much strokes differ in width and place."),
    PARAM_FLOAT_ROW(hatch, change, .a_second = true, .toggles = true, .def = 0, .min = 0, .max = 60, .soft_max = 12,
                    .doc = "How often a second the waver and the unevenness change; 0 never."),
};

static const pass passes[] = {HALFTONE_PASSES};

const technique surface_hatch = {
    .name = "hatch",
    .doc = "Hatching that stays as dense and as wide at any zoom, by the number or the width of its lines.",
    .example = "{\"surface\": {\"technique\": \"hatch\"}, \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(hatch),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .surface = &(const surface_row){.shader = "surface/hatch.glsl",
                                    .direct = true,
                                    .forward_when = HALFTONE_FORWARD_WHEN,
                                    .deferred_when = HALFTONE_DEFERRED_WHEN,
                                    .needs = halftone_needs},
};
