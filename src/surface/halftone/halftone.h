/* What all halftoning techniques have in common: which tone a position shall have, where strokes lie on surfaces, and
 * ink and paper. Their structs begin with this one and their tables with these rows; the shaders beside this file
 * read them. */
#ifndef LIMNER_SURFACE_HALFTONE_HALFTONE_H
#define LIMNER_SURFACE_HALFTONE_HALFTONE_H

#include "technique/technique.h"

/* What strokes are tied to. */
typedef enum halftone_coordinates {
    COORDINATES_AXES,      /* planes through the model's space, which stand askew so that hardly a face lies in one */
    COORDINATES_TRIPLANAR, /* the model as it is seen along the axis that a face looks to */
    COORDINATES_SCREEN,    /* the picture itself */
    /* What follows is known only while the geometry is drawn. */
    COORDINATES_UV,        /* texture coordinates; models without any: triplanar */
    COORDINATES_CURVATURE, /* across the direction in which a surface bends most */
    COORDINATES_LAPPED,    /* patches that overlap, laid along the direction in which a surface bends */
    COORDINATES_FORM_MESH, /* the page, turned in patches along the direction in which the mesh bends */
    /* And this only afterwards. */
    COORDINATES_FORM /* the same by the picture's normals and depth */
} halftone_coordinates;
#define HALFTONE_FORWARD_WHEN  "coordinates=uv,curvature,lapped,form-mesh"
#define HALFTONE_DEFERRED_WHEN "coordinates=form"
extern const char *const halftone_coordinate_names[];

typedef enum halftone_inks { INKS_ONE, INKS_TWO, INKS_CMYK } halftone_inks;
extern const char *const halftone_ink_names[];

typedef struct halftone_values {
    int32_t coordinates, inks;
    float   angle, shadow, light, contrast, texture;
    colour  ink, second_ink, paper;
    float   ink_tint, paper_tint, paper_light, patch;
    int32_t directions_on_page;
} halftone_values;

/* Passes of every technique whose values begin with these. */
#define HALFTONE_PASSES                                                                                                \
    {.name = "directions",                                                                                             \
     .shader = "surface/halftone/direction.frag",                                                                      \
     .reads = {TARGET_NORMAL_DEPTH, TARGET_ID},                                                                        \
     .writes = TARGET_DIRECTION,                                                                                       \
     .when = HALFTONE_DEFERRED_WHEN,                                                                                   \
     .prepares = true},                                                                                                \
    {                                                                                                                  \
        .name = "smooth directions", .shader = "surface/halftone/direction_smooth.frag",                               \
        .reads = {TARGET_DIRECTION, TARGET_NORMAL_DEPTH}, .writes = TARGET_DIRECTION, .repeat = 2,                     \
        .when = HALFTONE_DEFERRED_WHEN, .prepares = true                                                               \
    }

/* Of a technique whose values begin with these. */
mesh_needs halftone_needs(const void *values);

#define HALFTONE_ROWS(DEFAULT_COORDINATES)                                                                             \
    PARAM_ENUM_ROW(                                                                                                    \
        halftone_values, coordinates, .names = halftone_coordinate_names, .def = (DEFAULT_COORDINATES),                \
        .variant = true,                                                                                               \
        .doc =                                                                                                         \
            "What strokes are tied to: axes, planes askew through the model; triplanar, the model seen "               \
            "along its axes; screen, the "                                                                             \
            "picture; uv, texture coordinates; curvature, the direction in which it bends; lapped, patches that are "  \
            "laid along it; form, straight strokes on the page, "                                                      \
            "each patch turned along the direction in which the surface bends there, and form-mesh, the same "         \
            "measured "                                                                                                \
            "on the mesh instead of the picture."),                                                                    \
        PARAM_FLOAT_ROW(halftone_values, patch, .def = 0.1, .min = 0.01, .max = 1, .soft_min = 0.03, .soft_max = 0.3,  \
                        .unit = UNIT_FRACTION, .cpu_only = true, .only_if = "coordinates=lapped",                      \
                        .doc = "Radius of patches, fraction of a mesh's diagonal."),                                   \
        PARAM_INT_ROW(halftone_values, directions_on_page, .was = "ways_on_page", .def = 12, .min = 2, .max = 64,      \
                      .soft_max = 24, .unit = UNIT_COUNT, .variant = true, .only_if = "coordinates=form-mesh,form",    \
                      .doc = "How many directions strokes of form and form-mesh can lie on the page."),                \
        PARAM_FLOAT_ROW(halftone_values, angle, .def = 0, .min = -360, .max = 360, .soft_min = -90, .soft_max = 90,    \
                        .unit = UNIT_DEGREES, .as_turn = true, .doc = "Turns the strokes on the surface."),            \
        PARAM_FLOAT_ROW(halftone_values, shadow, .def = 0.05, .min = -1, .max = 1, .soft_min = 0,                      \
                        .unit = UNIT_FRACTION,                                                                         \
                        .doc = "Tone without any light: 0 is as black as the strokes can make it, 1 white."),          \
        PARAM_FLOAT_ROW(halftone_values, light, .def = 1.1, .min = -1, .max = 4, .soft_min = 0, .soft_max = 2,         \
                        .unit = UNIT_FRACTION,                                                                         \
                        .doc = "Tone in full light; above 1 the lit side is free of strokes for some way."),           \
        PARAM_FLOAT_ROW(halftone_values, contrast, .def = 1, .min = 0.1, .max = 8, .soft_max = 3, .logarithmic = true, \
                        .doc = "Bends the way from shadow to light: above 1 more is dark."),                           \
        PARAM_FLOAT_ROW(halftone_values, texture, .toggles = true, .def = 0.4, .min = 0, .max = 1,                     \
                        .unit = UNIT_FRACTION,                                                                         \
                        .doc = "Fraction of the model's own brightness, textures too, in the tone."),                  \
        PARAM_COLOUR_ROW(halftone_values, ink, .def_colour = {0.09f, 0.09f, 0.11f, 1},                                 \
                         .doc = "Colour of strokes. Lighter than the paper, strokes stand for light instead of "       \
                                "shade. cmyk: of the black one."),                                                     \
        PARAM_COLOUR_ROW(halftone_values, paper, .can_auto = true, .def_auto = true, .auto_ground = true,              \
                         .doc = "Colour between strokes; auto takes the page's ground."),                              \
        PARAM_FLOAT_ROW(halftone_values, paper_tint, .toggles = true, .def = 0, .min = 0, .max = 1,                    \
                        .unit = UNIT_FRACTION, .doc = "Fraction of the model's own colour in the paper."),             \
        PARAM_FLOAT_ROW(halftone_values, paper_light, .def = 1, .min = 0, .max = 1, .unit = UNIT_FRACTION,             \
                        .only_if = "paper_tint", .doc = "How far light shades that colour; 0 leaves it flat.")

/* And of those that print: with one ink, two or four. */
#define HALFTONE_INK_ROWS                                                                                              \
    PARAM_ENUM_ROW(halftone_values, inks, .names = halftone_ink_names, .variant = true,                                \
                   .doc = "one ink; two: the second one for the lighter half of all tones; cmyk: four inks that mix "  \
                          "to the model's colours, each "                                                              \
                          "at an angle of its own."),                                                                  \
        PARAM_COLOUR_ROW(halftone_values, second_ink, .def_colour = {0.72f, 0.36f, 0.22f, 1}, .only_if = "inks=two",   \
                         .doc = "Colour of the second ink."),                                                          \
        PARAM_FLOAT_ROW(halftone_values, ink_tint, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,                \
                        .only_if = "inks=one,two", .doc = "Fraction of the model's own colour in the ink.")

#endif
