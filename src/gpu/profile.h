/* Times of passes, between two finishes, in frames of their own. */
#ifndef LIMNER_GPU_PROFILE_H
#define LIMNER_GPU_PROFILE_H

#include "gpu/gpu.h"

enum { PASS_TIMES_MAX = 64 };

/* Time of one pass, summed over figures of the same name: as it passes, and as all threads compute. */
typedef struct gpu_pass_time {
    char     name[48];
    double   ms, cpu_ms;
    uint64_t draws;
} gpu_pass_time;

typedef struct gpu_profile {
    gpu          *g;
    bool          on; /* finish after each pass and keep its time */
    gpu_pass_time times[PASS_TIMES_MAX];
    size_t        count;
} gpu_profile;

typedef struct stopwatch {
    double   start, cpu_start;
    uint64_t draws;
} stopwatch;

stopwatch watch_start(const gpu_profile *p);
void      watch_stop(gpu_profile *p, stopwatch w, const char *group, const char *name);

#endif
