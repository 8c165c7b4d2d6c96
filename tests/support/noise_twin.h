/* The noise that sketches waver by, once more on the CPU: Perlin's gradient noise on a lattice, octave by octave, with
 * the gradients that the engine's hash gives. Only numbers are taken from the engine: the hash, the lattice's side
 * (0.69 of a wave) and shift, the gain. */
#ifndef TRUTH_NOISE_TWIN_H
#define TRUTH_NOISE_TWIN_H

#include <stdbool.h>
#include <stdint.h>

typedef struct noise_field {
    int      octaves; /* each half as long and half as strong as the one before */
    bool     turbulence;
    double   side;   /* of the longest octave's lattice */
    int      period; /* lattice positions after which that octave repeats in the plane; 0: it does not */
    uint32_t seed;
    double   gain;
} noise_field;

/* On the sheet: three components, −1 … 1. */
void noise_in_plane(const noise_field *f, double x, double y, double out[3]);

/* In space. */
void noise_in_space(const noise_field *f, const double position[3], double out[3]);

/* In space with waves of a length on the page: `level` is the binary logarithm of that length's lattice side, and
 * octaves whose sides are powers of two fade in and out. `side` and `period` of the field do not count. */
void noise_along_ladder(const noise_field *f, double level, const double position[3], double out[3]);

#endif
