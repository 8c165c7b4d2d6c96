/* sheet: the page's ground. */
#include "finish/finish.h"

static const param params[] = {
    PARAM_COLOUR_ROW(sheet_values, ground, .def_colour = {1, 1, 1, 1}, .cpu_only = true, .doc = "Colour of the page; none leaves it transparent."),
};

static const technique sheet = {
    .name = "sheet", .doc = "The page's ground.", .example = "{\"surface\": \"lit\"}",
    .params = params, .param_count = PARAM_COUNT(params), .params_size = sizeof(sheet_values),
};

static const technique *const techniques[] = {&sheet};

const kind kind_finish = {
    .id = KIND_FINISH, .name = "finish", .doc = "The sheet, for the whole look.",
    .techniques = techniques, .technique_count = PARAM_COUNT(techniques), .standard = &sheet,
    .selector_key = "technique", .look_wide = true,
};
