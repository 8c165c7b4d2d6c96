/* The table of surface techniques. */
#include "surface/surface.h"

static const technique *const techniques[] = {
    &surface_lambert,     &surface_flat,          &surface_lit,      &surface_tones,  &surface_toon,
    &surface_watercolour, &surface_gooch,         &surface_textured, &surface_mirror, &surface_hatch,
    &surface_screen,      &surface_tonal_art_map, &surface_dots,     &surface_pencil, &surface_stipple,
    &surface_strokes,     &surface_lines,         &surface_wax,      &surface_relief, &surface_stick,
};

const kind kind_surface = {
    .id = KIND_SURFACE,
    .name = "surface",
    .doc = "How area is filled.",
    .techniques = techniques,
    .technique_count = PARAM_COUNT(techniques),
    .standard = &surface_lambert,
    .selector_key = "technique",
};
