/* What the programs of this folder share that measure through the library. */
#ifndef LIMNER_BENCH_MEASURE_H
#define LIMNER_BENCH_MEASURE_H

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "limner/limner.h"

static inline double measure_ms(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static inline void must(lmn_status status, const lmn_error *error)
{
    if (status == LMN_OK)
        return;
    fprintf(stderr, "bench: %s %s\n", error->file, error->message);
    exit(1);
}

/* Of doubles, for qsort. */
static inline int measure_compare(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

#endif
