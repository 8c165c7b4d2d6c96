/* The table of techniques that perturb. */
#include "perturb/perturb.h"

static const technique *const techniques[] = {&perturb_uncertainty, &perturb_pencil};

const kind kind_perturb = {
    .id = KIND_PERTURB, .name = "perturb", .doc = "How exactly lines and fills are drawn.",
    .techniques = techniques, .technique_count = PARAM_COUNT(techniques), .standard = NULL,
    .selector_key = "technique",
};
