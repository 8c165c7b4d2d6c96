/* What the tests of strokes share. */
#ifndef LIMNER_TESTS_STROKES_SUPPORT_H
#define LIMNER_TESTS_STROKES_SUPPORT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "base/memory.h"
#include "stroke_texture/strokes.h"

static inline void near_or_fail(double value, double wanted, double tolerance, int line)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("line %d: %.9g instead of %.9g", line, value, wanted);
}
#define assert_near(value, wanted, tolerance) near_or_fail((double)(value), wanted, tolerance, __LINE__)

static inline strokes pattern(stroke_pattern p, size_t count, float uneven, uint32_t seed)
{
    strokes         s;
    lmn_error       error = {0};
    pattern_options options = {.pattern = p, .count = count, .uneven = uneven, .seed = seed};
    assert_int_equal(strokes_generate(&s, &options, &error), LMN_OK);
    return s;
}

static inline bool same_bits(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

#endif
