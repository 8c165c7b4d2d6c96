/* The picture of one stroke, which all strokes are drawn with. Müller, section 3; row P16. */
#ifndef LIMNER_STROKE_TEXTURE_STROKE_IMAGE_H
#define LIMNER_STROKE_TEXTURE_STROKE_IMAGE_H

#include <stdbool.h>

#include "base/error.h"
#include "base/text.h"

/* The largest that is read, pixels; and the least ink that it may have, as a fraction of its area: with less, as many
 * strokes were needed as nobody waits for. */
enum { STROKE_IMAGE_LONGEST = 4096, STROKE_IMAGE_HIGHEST = 512 };
#define STROKE_IMAGE_LEAST_INK 0.05

/* The stroke goes from left to right. Its first and last quarters are its ends: they keep their proportions at any
 * length of the stroke; what lies between is stretched. */
typedef struct stroke_image {
    int     columns, rows;
    double *sums; /* of the ink of all pixels above and left: rows + 1 rows of columns + 1 */
} stroke_image;

/* Is it a picture's name (.png, .jpg, .webp), or the word split? */
bool stroke_image_is_named(const char *name);
/* Appends what decides the image's content: the file's bytes. */
void stroke_image_describe(text *out, const char *name);
/* Reads the picture, behind the fence, or makes the one that is called split: two lines beside each other. Ink is how
 * dark a pixel is over white paper, 0 … 1. Errors name the file and say what to do: those of image_load; LMN_LIMIT
 * beyond the sizes above; LMN_FORMAT where the picture is higher than wide or has too little ink. */
lmn_status stroke_image_load(stroke_image *out, const char *name, lmn_error *error);
/* Of ink as fractions 0 … 1, the upper row first. Errors: LMN_MEMORY. */
lmn_status stroke_image_of_ink(stroke_image *out, const float *ink, int columns, int rows, lmn_error *error);
void       stroke_image_release(stroke_image *image);

/* A stroke that the image is laid on: both in texels. */
typedef struct stroke_extent {
    double length, width;
} stroke_extent;

/* Mean ink of a square of one texel that lies along the stroke: `along` from its start, `left` of its axis, texels.
 * Beside the stroke there is none. */
double stroke_image_at(const stroke_image *image, const stroke_extent *stroke, double along, double left);
/* Mean ink of the whole stroke. */
double stroke_image_mean(const stroke_image *image, const stroke_extent *stroke);

#endif
