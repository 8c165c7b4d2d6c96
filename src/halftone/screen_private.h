/* What the files that make screens share. */
#ifndef LIMNER_HALFTONE_SCREEN_PRIVATE_H
#define LIMNER_HALFTONE_SCREEN_PRIVATE_H

#include "halftone/screen.h"

/* How dark texels are, before they are bytes: 0 is paper, INK_MOST the first to be inked. Finer than bytes, so that
 * strokes whose priorities differ little keep their order when a screen is equalised. */
enum { INK_MOST = 65535, INK_TONES = INK_MOST + 1 };

/* Screen values for texels in the order of their ink: the fraction below v becomes v. Texels of equal ink stay equal,
 * since they are of one stroke. `tones` is room for INK_TONES numbers. */
void ink_equalise(uint8_t *out, const uint16_t *ink, size_t count, uint32_t *tones);
/* Screen values without that: 255 × (1 − ink). */
void ink_encode(uint8_t *out, const uint16_t *ink, size_t count);

static inline bool is_power_of_two(int n)
{
    return n > 0 && (n & (n - 1)) == 0;
}

/* Ranks 0 … side² − 1 of a dispersed order in which no texels of near ranks are near each other, also around the
 * border; by void and cluster. */
lmn_status blue_noise_ranks(uint32_t *ranks, int side, lmn_error *error);
/* The position of a texel in Bayer's order, 0 … side² − 1; side is a power of two. */
uint32_t bayer_rank(uint32_t x, uint32_t y, int side);

/* --- screen_components.c: marks of painted screens, texels that hang together --- */

typedef struct screen_marks {
    int32_t *label; /* a texel's mark on the level at hand, or −1 */
    size_t  *order; /* marks that follow each other lie apart */
    double  *ink;   /* of each mark */
    bool    *gone;
    size_t   count;
} screen_marks;

/* The marks of a square of a power of two texels that repeats. False: memory is gone; then, too, release. */
bool screen_marks_find(screen_marks *m, const uint16_t *ink, int side);
void screen_marks_release(screen_marks *m);
/* The next coarser level: the darkest of four that belongs to a mark. `ink` may be `finer`. */
void screen_marks_reduce(screen_marks *m, uint16_t *ink, const uint16_t *finer, int half);
/* Takes away whole marks until the mean ink is about `fraction`, 0 … 1. */
void screen_marks_thin(screen_marks *m, uint16_t *ink, int side, double fraction);

#endif
