/* The table of compositions. */
#include "compose/compose.h"

const target_row layer_nearer_row = {"t_nearer_row", TEXEL_RGBA16F};

static const technique *const techniques[] = {&compose_opaque,    &compose_superimpose, &compose_merged,
                                              &compose_blueprint, &compose_wire,        &compose_xray};

const kind kind_compose = {
    .id = KIND_COMPOSE,
    .name = "compose",
    .doc = "How a figure meets the page.",
    .techniques = techniques,
    .technique_count = PARAM_COUNT(techniques),
    .standard = &compose_opaque,
    .selector_key = "technique",
};
