/* Allocation through one door, so that limits hold (base/work.h) and tests can make the n-th call fail, and
 * arithmetic on sizes that cannot wrap. */
#ifndef LIMNER_BASE_MEMORY_H
#define LIMNER_BASE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>

#include "limner/memory.h"

/* All return NULL when memory is gone; size 0 gives a pointer that can be freed. mem_calloc checks the product. */
void *mem_alloc(size_t size);
void *mem_calloc(size_t count, size_t size);
void *mem_realloc(void *block, size_t size);
void  mem_free(void *block);
char *mem_copy_text(const char *text); /* NULL text gives NULL */
void *mem_copy(const void *block, size_t size);
/* Grows an array to hold at least `count` elements (doubling). False when memory is gone; then nothing changed. */
bool mem_grow(void **array, size_t *capacity, size_t count, size_t element_size);

/* False on overflow, and then *out is SIZE_MAX. */
bool size_mul(size_t a, size_t b, size_t *out);
bool size_add(size_t a, size_t b, size_t *out);

/* All blocks come from here; a copy is kept. False when one was made before, or this was called before. */
bool mem_use(const lmn_allocator *allocator);
/* In a child process: malloc from here on, whoever gave memory in the parent. */
void mem_enter_child(void);

/* For tests: the n-th allocation from now fails, as do all later ones until 0 is set. */
void mem_fail_at(long n);

#endif
