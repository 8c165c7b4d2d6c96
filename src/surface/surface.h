/* The kind "surface": how area is filled. A technique is a GLSL function `vec4 surface_colour(surface_point p)`. */
#ifndef LIMNER_SURFACE_SURFACE_H
#define LIMNER_SURFACE_SURFACE_H

#include "technique/technique.h"

extern const kind kind_surface;

extern const technique surface_lambert, surface_flat, surface_lit, surface_tones, surface_relief, surface_toon,
    surface_watercolour, surface_gooch, surface_textured, surface_mirror, surface_hatch, surface_screen,
    surface_tonal_art_map, surface_dots, surface_pencil, surface_stipple, surface_strokes, surface_lines, surface_wax,
    surface_stick;

#endif
