/* Pictures in files' formats to pixels. */
#ifndef LIMNER_FENCE_IMAGE_READ_H
#define LIMNER_FENCE_IMAGE_READ_H

#include <stdbool.h>

#include "base/error.h"

typedef struct image_pixels {
    uint32_t width, height;
    uint8_t *rgba;   /* row 0 on top, straight alpha; free with mem_free */
    int      halved; /* how often width and height were halved so that it fits; 0: as the file has it */
} image_pixels;

/* PNG, JPEG or WebP to RGBA8, decoded behind the fence. A picture of more than `most_bytes` is halved until it fits
 * (0: never). Errors: LMN_FORMAT, LMN_LIMIT, LMN_UNSUPPORTED, LMN_MEMORY, LMN_CANCELLED; then *out is empty. */
lmn_status image_read(image_pixels *out, const unsigned char *bytes, size_t size, size_t most_bytes, lmn_error *error);
/* The same of a file, as large as it is; messages name it. Also LMN_READ. */
lmn_status image_load(image_pixels *out, const char *path, lmn_error *error);

/* Does the path end as pictures do that can be read? */
bool image_is_named(const char *path);

/* How light a pixel is, of its encoded values: Rec. 709. */
static inline uint8_t image_luma(const uint8_t rgb[3])
{
    return (uint8_t)((54 * rgb[0] + 183 * rgb[1] + 19 * rgb[2] + 128) >> 8);
}

/* Half as wide and high, each pixel the mean of four in linear light; in place. The block keeps its size. */
void image_halve(image_pixels *image);

#endif
