/* Pictures in files' formats to pixels. */
#ifndef LIMNER_BASE_IMAGE_READ_H
#define LIMNER_BASE_IMAGE_READ_H

#include <stdint.h>

#include "base/error.h"

typedef struct image_pixels {
    uint32_t width, height;
    uint8_t *rgba; /* row 0 on top, straight alpha; free with mem_free */
} image_pixels;

/* PNG, JPEG or WebP to RGBA8. Errors: LMN_FORMAT, LMN_LIMIT, LMN_UNSUPPORTED, LMN_MEMORY; then nothing is left in *out. */
lmn_status image_read(image_pixels *out, const unsigned char *bytes, size_t size, lmn_error *error);
/* The same of a file; messages name it. Also LMN_READ. */
lmn_status image_load(image_pixels *out, const char *path, lmn_error *error);

#endif
