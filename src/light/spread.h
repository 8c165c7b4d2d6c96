/* A covered shape with a soft border. */
#ifndef LIMNER_LIGHT_SPREAD_H
#define LIMNER_LIGHT_SPREAD_H

#include <stdbool.h>
#include <stdint.h>

/* Texels of four bytes: the third becomes the first, spread by a Gaussian, nearly, of a standard deviation of half a
 * radius. False: no memory. */
bool coverage_spread(uint8_t *texels, int width, int height, double radius);

#endif
