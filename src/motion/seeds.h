/* Seed points: where on the page streaks begin. Großmann 2011, sections 6.2.1, 6.3.2 and 6.3.6. */
#ifndef LIMNER_MOTION_SEEDS_H
#define LIMNER_MOTION_SEEDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum seed_sequence { SEEDS_RANDOM, SEEDS_HAMMERSLEY, SEEDS_HALTON } seed_sequence;

/* How seeds leave their positions: not at all, all alike, each by itself, or each wandering calmly. */
typedef enum seed_jitter { JITTER_NONE, JITTER_ALL, JITTER_EACH, JITTER_DRIFT } seed_jitter;

/* The digits of i in this base behind the point, in reverse order. */
double seed_radical_inverse(uint32_t base, uint32_t i);

/* The first `count` points of a sequence in the unit square, and a third coordinate that goes with none of the others:
 * three numbers each. Halton's begin with the index 1. */
void seeds_place(seed_sequence sequence, size_t count, uint32_t seed, double (*out)[3]);

/* By how much the i-th seed is off at this tick of time, from −1 to 1; drift goes on between ticks. */
void seed_offset(seed_jitter jitter, size_t i, uint32_t seed, double ticks, double out[2]);

#endif
