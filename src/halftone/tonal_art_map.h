/* Tonal art maps: strokes of a lighter tone are all in every darker one, and strokes of a coarser mip level in
 * every finer one. Großmann 2011, section 3.2.3; Müller, section 3; rows Großmann 3 to 5, P16 to P20, P39; after
 * Praun 2001. */
#ifndef LIMNER_HALFTONE_TONAL_ART_MAP_H
#define LIMNER_HALFTONE_TONAL_ART_MAP_H

#include "base/mip_chain.h"
#include "stroke_texture/stroke_image.h"
#include "stroke_texture/strokes.h"

typedef enum tam_placement { TAM_BEST_FIT, TAM_STRIPS, TAM_PLACEMENT_COUNT } tam_placement;
extern const char *const tam_placement_names[TAM_PLACEMENT_COUNT + 1];

typedef struct tam_options {
    int    side;    /* of level 0, a power of two, 8 … 1024; 256 */
    int    tones;   /* 2 … 16; 6. Tone i of n inks (i + 1) / (n + 1) of the surface, times `darkest` × (n + 1) / n */
    double darkest; /* ink of the last tone, 0.05 … 0.98 */
    double width; /* texels, 0.5 … side / 4, the same on all levels; both ends run out to nothing over so many widths,
                     however long the stroke is (P16) */
    double length; /* longest stroke in the square, 0.05 … 1; lengths are 30 … 100 % of it, the longer ones on coarse
                      levels */
    double
        opacity; /* 0.1 … 1. 1: hatching; below: gradation, where strokes cover each other and each takes this fraction
                  * of what is left up to the darkest that graphite gets, half way from `darkest` to black (P20, P32) */
    bool           cross;  /* from the middle tone on also across, until there is as much of both directions */
    double         grain;  /* 0 … 1: strokes are streaked as graphite is, and get lighter towards their ends */
    float          uneven; /* wobble of direction, 0 … 1; the most is a slope of 0.16 */
    tam_placement  placement;
    const strokes *drawn; /* not NULL: these are placed instead, in the order of their light priorities and down to the
                           * level of the others, with round ends, until a tone is reached or there are none left (P39:
                           * dots and other shapes) */
    const stroke_image
            *image; /* not NULL: what strokes look like, ends included; of its ink a stroke takes `opacity` */
    uint32_t seed;
} tam_options;

/* What the strokes are drawn with. */
stroke_brush tonal_art_map_brush(const tam_options *options);

/* R8, one layer a tone, lightest first; 255 is paper; levels with fewer than 8 texels a side are of the tone's
 * grey. Pixel by pixel, ink never gets less towards darker tones, and strokes of a level are in all finer ones.
 * Errors: LMN_USAGE, LMN_MEMORY. `kept` may be NULL; else it gets per stroke what was placed: light = tone it
 * appears in first as 1 − tone index / tones, perspective = by coarsest level k, 1 − 0.75 × 2^−k; layer 1: across.
 * It is the caller's even when it is empty. */
lmn_status tonal_art_map(mip_chain *out, strokes *kept, const tam_options *options, lmn_error *error);

#endif
