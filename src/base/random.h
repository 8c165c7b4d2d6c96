/* Random numbers that are the same everywhere for the same seed (splitmix64; Steele, Lea and Flood 2014). */
#ifndef LIMNER_BASE_RANDOM_H
#define LIMNER_BASE_RANDOM_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

typedef struct random_source {
    uint64_t state;
} random_source;

static inline uint64_t random_bits(random_source *r)
{
    uint64_t z = r->state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

/* Different purposes take different streams, so that a change to one leaves the others as they were. */
static inline random_source random_start(uint32_t seed, uint32_t stream)
{
    random_source r = {(uint64_t)seed << 32 | stream};
    random_bits(&r);
    return r;
}

/* [0, 1) */
static inline double random_unit(random_source *r)
{
    return (double)(random_bits(r) >> 11) * 0x1p-53;
}

/* [−1, 1) */
static inline double random_signed(random_source *r)
{
    return 2.0 * random_unit(r) - 1.0;
}

/* Like a hand's mistakes: mostly small, never above 1 (the mean of three). Standard deviation 1/3. */
static inline double random_hand(random_source *r)
{
    double sum = random_signed(r);
    sum += random_signed(r);
    sum += random_signed(r);
    return sum / 3.0;
}

/* 0 … count − 1 */
static inline size_t random_below(random_source *r, size_t count)
{
    return (size_t)(random_unit(r) * (double)count);
}

static inline void random_shuffle(random_source *r, size_t *items, size_t count)
{
    for (size_t i = count; i > 1; i--) {
        size_t j = random_below(r, i), kept = items[i - 1];
        items[i - 1] = items[j];
        items[j] = kept;
    }
}

#endif
