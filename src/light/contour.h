/* Contours of shapes in a picture, made as calm as a hand draws them. */
#ifndef LIMNER_LIGHT_CONTOUR_H
#define LIMNER_LIGHT_CONTOUR_H

#include <stdbool.h>
#include <stdint.h>

/* Texels of four bytes, of which the first is how much of the texel is covered, and covered anew: borders wobble no
 * longer over less than `radius` texels, but corners between straight lines stay corners. False: no memory. */
bool contours_calm(uint8_t *texels, int width, int height, double radius);

#endif
