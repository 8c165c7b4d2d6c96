/* What hangs on a shadow by a thin neck. */
#ifndef LIMNER_LIGHT_APPENDAGES_H
#define LIMNER_LIGHT_APPENDAGES_H

#include <stdbool.h>
#include <stdint.h>

/* Texels as scraps_drop takes them: what is as small as a scrap and hangs on something larger by a neck that is thinner
 * than about half of `radius` goes with its neck, unless something near throws some of it or it reaches the picture's
 * border. The border of the rest stays as it is. False: no memory. */
bool appendages_cut(uint8_t *texels, int width, int height, double radius);

#endif
