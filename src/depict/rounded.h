/* Ways as a broad pen draws them: no turn on the page is sharper than the pen is broad. Where a way turns back nearly
 * where it came from, it ends, and another begins beside the turn. */
#ifndef LIMNER_DEPICT_ROUNDED_H
#define LIMNER_DEPICT_ROUNDED_H

#include "depict/depict_private.h"

typedef struct rounded_run {
    size_t first, count; /* points */
} rounded_run;

/* Zero-initialise. */
typedef struct rounded_way {
    double (*points)[3]; /* in the world */
    size_t       point_count, point_capacity;
    rounded_run *runs;
    size_t       run_count, run_capacity;
    bool         failed; /* out of memory */
} rounded_way;

/* Of a polyline in the world for a line of this width, as the job's viewer sees it. Where nothing turns sharply the
 * points are those that were given. */
void rounded_make(rounded_way *out, const depict_job *j, const double (*points)[3], size_t count, double width);
void rounded_release(rounded_way *r);

#endif
