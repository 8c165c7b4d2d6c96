#include "motion/seeds.h"

#include <math.h>

#include "base/random.h"

enum { STREAM_PLACES = 71, STREAM_JITTER = 72 };

double seed_radical_inverse(uint32_t base, uint32_t i)
{
    double sum = 0, digit = 1;
    for (; i > 0; i /= base) {
        digit /= base;
        sum += digit * (i % base);
    }
    return sum;
}

void seeds_place(seed_sequence sequence, size_t count, uint32_t seed, double (*out)[3])
{
    random_source r = random_start(seed, STREAM_PLACES);
    for (uint32_t i = 0; i < count; i++) {
        if (sequence == SEEDS_RANDOM) {
            for (int k = 0; k < 3; k++)
                out[i][k] = random_unit(&r);
        } else if (sequence == SEEDS_HAMMERSLEY) {
            out[i][0] = (double)i / (double)count;
            out[i][1] = seed_radical_inverse(2, i);
            out[i][2] = seed_radical_inverse(3, i);
        } else {
            out[i][0] = seed_radical_inverse(2, i + 1);
            out[i][1] = seed_radical_inverse(3, i + 1);
            out[i][2] = seed_radical_inverse(5, i + 1);
        }
    }
}

/* Numbers of a seed alone, or of all, at one tick. */
static random_source jitter_source(uint32_t seed, uint64_t number, uint32_t tick)
{
    random_source r = random_start(seed ^ (tick * 0x9E3779B9u), STREAM_JITTER);
    r.state += number * UINT64_C(0xD1342543DE82EF95);
    random_bits(&r);
    return r;
}

void seed_offset(seed_jitter jitter, size_t i, uint32_t seed, double ticks, double out[2])
{
    out[0] = out[1] = 0;
    if (jitter == JITTER_NONE)
        return;
    if (jitter != JITTER_DRIFT) {
        random_source r = jitter_source(seed, jitter == JITTER_EACH ? i + 1 : 0, (uint32_t)floor(ticks));
        out[0] = random_signed(&r);
        out[1] = random_signed(&r);
        return;
    }
    random_source r = jitter_source(seed, i + 1, 0);
    for (int k = 0; k < 2; k++) { /* two slow waves that have no common period */
        double first = random_unit(&r), second = random_unit(&r), turn = 6.283185307179586;
        out[k] = (sin(turn * (ticks / 7 + first)) + sin(turn * (ticks / 11.3 + second))) / 2;
    }
}
