/* Halftone screens: textures whose grey is the light up to which ink stays, with mip levels that keep strokes as
 * wide and as dense on the screen at any distance. Freudenberg 2003, chapter 6; rows IM-01 to IM-14, IM-17, IM-18.
 * Low values are ink of high priority, so that a screen looks like the drawing (IM-10): a texel of value v is inked
 * where light + v ≤ 1; 255 is never inked. */
#ifndef LIMNER_HALFTONE_SCREEN_H
#define LIMNER_HALFTONE_SCREEN_H

#include "base/mip_chain.h"
#include "stroke_texture/strokes.h"

/* Which way strokes get mip levels. */
typedef enum screen_detail {
    DETAIL_KEPT, /* each level drawn again with strokes as wide, fewer of them: p_p ≥ 1 − 2^−k, whole strokes (IM-13).
                  * Half of the strokes, each half as long, on a quarter of the texels: the tone stays. Dots do not get
                  * shorter: they stay where p_p ≥ 1 − 4^−k. Round ends are shortened by what they cover more on a
                  * coarse level; a curve of several chords is one stroke. */
    DETAIL_MINIMUM, /* the darkest of four parents: wide but fuzzy (IM-05), for comparison */
    DETAIL_AVERAGE, /* box filter, as drivers do it: grey far away (IM-01), for comparison */
    DETAIL_NEAREST, /* one of four parents, as without levels: patterns that are not there (IM-01), for comparison */
    DETAIL_COUNT
} screen_detail;
extern const char *const screen_detail_names[DETAIL_COUNT + 1];

typedef struct screen_options {
    int           side;  /* of level 0, a power of two */
    stroke_brush  brush; /* width in texels, on all levels */
    screen_detail detail;
    bool equalised; /* the fraction of texels below v is v on every level, up to the level's darkest tone (IM-14); see
                       screen_equalise */
    int levels; /* with strokes (DETAIL_KEPT); what follows is white. 0: as long as a stroke is longer than it is wide,
                 * dots: while a level is four times as wide */
} screen_options;

/* R8, value 1 − light priority, antialiased towards white. The darkest of several strokes owns a texel, so that
 * those of high priority lie on top and their light rims do not bite into what is below. Priorities above 1 are
 * black, 0 and below are left out. Errors: LMN_LIMIT, LMN_MEMORY. */
lmn_status screen_of_strokes(mip_chain *out, const strokes *s, const screen_options *options, lmn_error *error);

/* The warp map that belongs to that screen (IM-18): RG16F, nearest; per texel, rims included, the middle of the
 * stroke that owns it (the one whose value the screen has there; of a curve, its middle) minus the texel's own
 * position, in the square, the shortest way around the border; 0 where there is no stroke. Relative, so that it may be
 * tiled (IM-20). Strokes should be shorter than the square. */
lmn_status screen_warp(mip_chain *out, const strokes *s, const screen_options *options, lmn_error *error);

/* Normals for strokes (IM-17): RG8, xy of unit normals as 0 … 255 for −1 … 1 (128: none), from the slope of strokes
 * that are pressed into the surface: the flank on a stroke's left side leans to the right. Levels as the screen's.
 * `steep`: slope at a stroke's border. */
lmn_status screen_normals(mip_chain *out, const strokes *s, const screen_options *options, double steep,
                          lmn_error *error);

/* Hatch map (IM-02): 1 × side texels, since lines run along u; each one texel thick, `spacing` texels apart on
 * every level that has room, so that each line of level k lies exactly on every second one of level k − 1, with its
 * lower edge. `centred`: two texels that straddle the line, so that the middles agree. Smaller levels are of the
 * mean grey, or white. The side must be 1, 2, 4, 8 … times the spacing, that at least 2, centred 3. R8. Errors:
 * LMN_LIMIT, LMN_MEMORY. */
lmn_status screen_hatch_map(mip_chain *out, int side, int spacing, bool centred, bool white_end, lmn_error *error);

/* Ink map (IM-04): black where there is ink, per level the strokes with p_p ≥ 1 − 2^−k, as wide on every level. For
 * colour × ink (IM-07). R8. Priorities of light do not matter, but strokes below 0 are left out; `equalised` is
 * ignored. Errors: LMN_LIMIT, LMN_MEMORY. */
lmn_status screen_ink_map(mip_chain *out, const strokes *s, const screen_options *options, lmn_error *error);

/* Screens without strokes. The period is in texels of each level, so that the spacing on the screen stays (IM-11). */
typedef enum screen_procedure {
    PROCEDURE_LINES, /* along u, of triangular profile: line width follows tone, as in engravings. They sway by a texel,
                        so that tone has no steps */
    PROCEDURE_DOTS,  /* clustered dots on a square grid that is turned by 45°, two in a square of the period */
    PROCEDURE_ORDERED,    /* Bayer's matrix of the period's side, which has as many tones as texels */
    PROCEDURE_BLUE_NOISE, /* void and cluster */
    PROCEDURE_COUNT
} screen_procedure;
extern const char *const screen_procedure_names[PROCEDURE_COUNT + 1];

/* All of them equalised: the fraction of texels below v is v. side and period: powers of two, the period 2 … 256 and
 * within the side. Blue noise has no period: it is made on 64 × 64 texels and repeated. Levels that are narrower
 * than a period have the pattern of a narrower one. Errors: LMN_USAGE, LMN_LIMIT, LMN_MEMORY. */
lmn_status screen_of_procedure(mip_chain *out, screen_procedure procedure, int side, int period, lmn_error *error);

/* A painted screen (IM-12). RGBA pixels, row 0 on top. One picture: its luminance over white is the screen. Several
 * layers: layer i, the first the most important, is compressed to g_i … 1 with g_i even in 0 … 1 − 1/gain, the
 * first on top. Levels by `detail` (KEPT: darkest of four, and whole marks, texels that hang together, are left out
 * until there is as much ink as on level 0; where nearly everything hangs together, stretches of lines). Pictures
 * are resampled to `side`. Errors: LMN_FORMAT (not square), LMN_LIMIT, LMN_MEMORY. */
typedef struct screen_layer {
    const uint8_t *rgba;
    uint32_t       width, height;
} screen_layer;
lmn_status screen_of_layers(mip_chain *out, const screen_layer *layers, size_t count, double gain, int side,
                            screen_detail detail, lmn_error *error);

/* Levels that were drawn one by one (IM-04), the finest first: picture k is level k, resampled to half the side of the
 * one before; further levels are paper. Errors: as above. */
lmn_status screen_of_levels(mip_chain *out, const screen_layer *levels, size_t count, int side, lmn_error *error);

/* Normals that were painted (IM-17): red and green of a picture are x to the right and y up of unit normals, 0 … 255
 * for −1 … 1, row 0 on top. Slopes are `steep` times what is painted; levels are means. RG8. Errors: as above. */
lmn_status screen_normals_of_picture(mip_chain *out, const screen_layer *picture, double steep, int side,
                                     lmn_error *error);

/* Makes the tone of each level linear in place, antialiased greys included (IM-14): texels keep their order, and
 * the fraction below v becomes v until there is no more ink; then it stays. So the same light gives the same tone on
 * all levels. Texels of equal value stay equal, since they are of one stroke: the tone is off by up to half of the
 * largest such group. To use strokes that ink the fraction s for the whole range of light, threshold 1 − s × (1 −
 * light). R8 only. Errors: LMN_USAGE, LMN_MEMORY. */
lmn_status screen_equalise(mip_chain *screen, lmn_error *error);

/* Fraction of ink of a level for a light 0 … 1 by the threshold schemes of IM-08 (gain 0: binary) and IM-09, for tests
 * and tables. 255 is paper in all of them, so that a screen has 255 amounts of ink, not 256. */
double screen_ink(const mip_chain *screen, int level, double light, double gain, bool centred);

#endif
