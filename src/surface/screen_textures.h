/* What `screen` makes its textures from. */
#ifndef LIMNER_SURFACE_SCREEN_TEXTURES_H
#define LIMNER_SURFACE_SCREEN_TEXTURES_H

#include "halftone/screen.h"
#include "surface/halftone/halftone.h"

typedef enum screen_scheme { SCHEME_BINARY, SCHEME_SMOOTH, SCHEME_SHARP, SCHEME_MULTIPLY } screen_scheme;

typedef struct screen_values {
    halftone_values common;
    param_words     screen, indication;
    int32_t         scheme, detail, indicate, frames, pattern_seed;
    float           gain, scale, width, repeat, relief, indication_strength, wobble, uneven, change;
    bool            centred, equalised, whole;
} screen_values;

/* Is it a pattern, a procedure, or a file of a kind that can be read? Errors: LMN_USAGE. */
lmn_status screen_check_name(const char *name, lmn_error *error);

/* For screens that are named `material`. */
bool       screen_by_material(void *values, const char *strokes);
void       screen_describe(text *out, const void *values);
lmn_status screen_make(mip_chain *out, const void *values, lmn_error *error);
/* Per share that a level is mixed with the next one (17 rows, 0 … 1) and per darkness (64, 0 … 1): the darkness that
 * leaves so much ink on the page, with the pixels that the values' lengths are in. */
lmn_status screen_make_curve(mip_chain *out, const void *values, lmn_error *error);
lmn_status screen_make_relief(mip_chain *out, const void *values, lmn_error *error);
lmn_status screen_make_warp(mip_chain *out, const void *values, lmn_error *error);
void       screen_describe_indication(text *out, const void *values);
lmn_status screen_make_indication(mip_chain *out, const void *values, lmn_error *error);

#endif
