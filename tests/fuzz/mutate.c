/* What the mutators share, and those of files that begin with something else than their text. */
#include <math.h>
#include <string.h>

#include "fuzz.h"

uint32_t fuzz_random(uint32_t *state, uint32_t limit)
{
    *state = *state * 1664525u + 1013904223u;
    return (uint32_t)(((uint64_t)(*state ^ *state >> 15) * limit) >> 32);
}

double fuzz_number(uint32_t *state, double before)
{
    static const double extremes[] = {0,
                                      1,
                                      -1,
                                      2,
                                      3,
                                      4,
                                      0.5,
                                      -0.5,
                                      7,
                                      8,
                                      255,
                                      256,
                                      65535,
                                      65536,
                                      1e-300,
                                      1e-38,
                                      1e-12,
                                      1e-6,
                                      1e6,
                                      1e12,
                                      1e18,
                                      1e38,
                                      1e39,
                                      1e300,
                                      -1e300,
                                      2147483647,
                                      2147483648.0,
                                      4294967295.0,
                                      4294967296.0,
                                      9007199254740993.0,
                                      5120,
                                      5121,
                                      5123,
                                      5125,
                                      5126};
    switch (fuzz_random(state, 6)) {
    case 0: return before + 1;
    case 1: return before - 1;
    case 2: return -before;
    case 3: return before * (fuzz_random(state, 2) ? 1.0000001 : 1000);
    default: return extremes[fuzz_random(state, sizeof extremes / sizeof *extremes)];
    }
}

/* Picks the mutator of the model's format; sometimes changes the choices instead. */
size_t fuzz_mutate_draw(uint8_t *bytes, size_t size, size_t most, unsigned seed)
{
    uint32_t state = seed;
    if (size <= DRAWING_CHOICES || most <= DRAWING_CHOICES)
        return LLVMFuzzerMutate(bytes, size, most);
    if (fuzz_random(&state, 3) == 0) {
        /* The first choice is the format, which would make the model unreadable. */
        bytes[1 + fuzz_random(&state, DRAWING_CHOICES - 1)] = (uint8_t)fuzz_random(&state, 256);
        return size;
    }
    uint8_t     *model = bytes + DRAWING_CHOICES;
    const size_t length = size - DRAWING_CHOICES, capacity = most - DRAWING_CHOICES, format = bytes[0] % 5;
    const size_t now = format == 0   ? fuzz_mutate_gltf(model, length, capacity, seed + 1)
                       : format == 1 ? fuzz_mutate_csg(model, length, capacity, seed + 1)
                                     : LLVMFuzzerMutate(model, length, capacity);
    return now + DRAWING_CHOICES;
}
