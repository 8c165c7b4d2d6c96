/* What the files of stroke textures share. */
#ifndef LIMNER_STROKE_TEXTURE_STROKES_PRIVATE_H
#define LIMNER_STROKE_TEXTURE_STROKES_PRIVATE_H

#include "base/limits.h"
#include "base/random.h"
#include "stroke_texture/strokes.h"

/* A number as short as it can be, with a point whatever the locale; text_parse_double gives it back exactly. */
void stroke_write_number(text *out, float value);

/* Is `next` the chord that goes on where `one` ends? */
bool stroke_goes_on(const texture_stroke *one, const texture_stroke *next);

/* What a brush's grain leaves of the ink of a stroke of this length, on the mean. */
double stroke_grain_mean(double grain, double texels);

lmn_status strokes_too_many(const char *name, int line, lmn_error *error);

/* --- stroke_spread.c: order in which things are spread most evenly over the torus --- */

/* Points that belong to items; the points of one item follow each other. */
typedef struct spread_point {
    float  u, v;
    size_t item;
} spread_point;

/* Writes the first `wanted` items to `order`, each the one that is then farthest from all before it (mean distance
 * of its points to theirs, around the corners). The first one, and the winner among equals, are chosen by the seed.
 * Every item has a point. False: memory is gone. */
bool spread_order(size_t *order, size_t wanted, const spread_point *points, size_t point_count, size_t item_count,
                  uint32_t seed);

#endif
