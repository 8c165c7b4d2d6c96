/* A loop over independent pieces on a few threads. Results never depend on how many: a piece writes only its own. */
#ifndef LIMNER_BASE_THREADS_H
#define LIMNER_BASE_THREADS_H

#include <stddef.h>

/* Works on the elements begin … end−1. */
typedef void (*threads_fn)(size_t begin, size_t end, void *user);

/* Calls `fn` for ranges that cover 0 … count−1 and returns when all are done. Ranges of fewer than `smallest`
 * elements are not split further. When no thread can be had the calling one does the work. */
void threads_for(size_t count, size_t smallest, threads_fn fn, void *user);

#endif
