/* What the files of tonal art maps share: the pictures while they are being drawn. */
#ifndef LIMNER_HALFTONE_TONAL_ART_MAP_PRIVATE_H
#define LIMNER_HALFTONE_TONAL_ART_MAP_PRIVATE_H

#include "base/random.h"
#include "halftone/tonal_art_map.h"

enum { TAM_ALONG, TAM_ACROSS, TAM_DIRECTIONS };

/* One mip level of the tone at hand. It only gets darker: the picture of the next tone begins as the one of this. */
typedef struct tam_level {
    int    side;
    float *ink;                   /* 0 paper … limit */
    double sum;                   /* of ink */
    size_t count;                 /* of strokes */
    float *crowd[TAM_DIRECTIONS]; /* how near strokes of a direction are; NULL for drawn strokes */
} tam_level;

typedef struct tam {
    const tam_options *options;
    stroke_brush       brush;
    float              limit, opacity; /* of ink; fraction of what is left of it that one stroke takes */
    tam_level          levels[MIP_LEVELS_MAX];
    int                level_count; /* with strokes */
    random_source      random;
    strokes           *kept;                         /* or NULL */
    double             drawn_length[TAM_DIRECTIONS]; /* of all strokes of a direction */
    float             *crowding;                     /* by distance, CROWD_STEPS a texel */
    size_t             crowding_count;
    int                tone, level; /* being filled */
} tam;

double tam_target(const tam_options *w, int tone);
/* Mean ink that is missing at the level being filled. */
double tam_missing(const tam *t);
/* Mean ink that a stroke of this length would add to a level now, about. */
double tam_expected(const tam *t, int level, double length);
/* Draws a stroke into the level being filled and all finer ones, and keeps it. False: memory is gone. */
bool tam_put(tam *t, texture_stroke s, int direction);

/* --- tonal_art_map_position.c --- */

/* How strokes crowd each other at the tone being filled. Called once a tone. */
bool tam_set_crowding(tam *t);
void tam_add_crowd(tam *t, tam_level *level, const texture_stroke *s, int direction);
/* Fill the level being filled up to its tone. */
bool tam_fill_best(tam *t);
bool tam_fill_strips(tam *t);

#endif
