/* Scraps of shadow: what a draughtsman leaves out. */
#ifndef LIMNER_LIGHT_SCRAPS_H
#define LIMNER_LIGHT_SCRAPS_H

#include <stdbool.h>
#include <stdint.h>

/* Texels of four bytes: how dark it is, and not 0 where that is thrown by something near. Islands that are smaller than
 * a few squares of `radius` vanish, unless something near throws some of them or they reach the picture's border; such
 * holes are filled. False: no memory. */
bool scraps_drop(uint8_t *texels, int width, int height, double radius);

#endif
