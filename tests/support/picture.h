/* PNG and PFM files for the tests, read and written without the engine's own code. All pictures have row 0 on top. */
#ifndef TRUTH_PICTURE_H
#define TRUTH_PICTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads a PNG as RGBA8 (greys and missing alpha are filled in). NULL when it cannot be read. Free with free. */
uint8_t *picture_read_rgba(const char *path, int *width, int *height);

/* Reads a 16-bit grey PNG. NULL when it is something else. Free with free. */
uint16_t *picture_read_grey16(const char *path, int *width, int *height);

/* Reads a PFM with the given number of channels and turns it upside down. NULL when it is something else. Free with
 * free. */
float *picture_read_pfm(const char *path, int channels, int *width, int *height);

bool picture_write_rgba(const char *path, const uint8_t *rgba, int width, int height);

/* PNG bytes in memory, for textures inside model files. Free with free. */
uint8_t *picture_encode_rgba(const uint8_t *rgba, int width, int height, size_t *size);

/* What a byte shows, 0 … 1, in which inks, papers and samples are mixed, and back to 0…255 without rounding. */
double picture_shown(uint8_t level);
double picture_level(double shown);
/* sRGB byte to light 0…1, and back to 0…255 without rounding. */
double picture_linear(uint8_t srgb);
double picture_srgb(double linear);

#endif
