/* What patterns of strokes are made with. */
#ifndef LIMNER_STROKE_TEXTURE_GENERATE_H
#define LIMNER_STROKE_TEXTURE_GENERATE_H

#include "stroke_texture/strokes_private.h"

typedef struct position {
    double u, v;
} position;

enum { SWAY_WAVES = 6 };

/* A smooth displacement that repeats with the square: how a hand drifts while it fills an area. Neighbours drift
 * together. */
typedef struct sway {
    double amplitude[SWAY_WAVES], phase[SWAY_WAVES];
    int    u[SWAY_WAVES], v[SWAY_WAVES];
} sway;

/* A pattern in the making; the first failure sticks. */
typedef struct generator {
    strokes      *out;
    size_t        count; /* of strokes, about */
    double        length, uneven;
    uint32_t      seed;
    random_source chance;
    bool          failed;
} generator;

void generate_stroke(generator *g, position from, position to, int32_t layer);
/* A curve as chords. */
void generate_curve(generator *g, const position *points, size_t count, int32_t layer);
/* Positions evenly spread over the torus, every beginning of them too; from `uneven` 0 to 1 ever less evenly. */
void generate_positions(generator *g, position *out, size_t count, double uneven);

/* rough: 1 … 4, the shortest wave's frequency. */
sway   sway_of(random_source *chance, double amplitude, int rough);
double sway_at(const sway *s, position at);

/* One series of hatching along closed lines of the torus with the direction (along_u, along_v): 1,0 · 0,1 · 1,1 ·
 * 1,−1. */
void generate_hatching(generator *g, int along_u, int along_v, size_t count, int32_t layer);

void pattern_parallel(generator *g);
void pattern_cross(generator *g);
void pattern_contour(generator *g);
void pattern_brick(generator *g);
void pattern_stipple(generator *g);
void pattern_scribble(generator *g);
void pattern_random(generator *g);

#endif
