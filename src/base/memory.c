#include "base/memory.h"

#include <malloc.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/work.h"

/* 0 = never fail; otherwise the number of allocations left until failure, 1 = the next fails. Set by tests only. */
static atomic_long allocations_left;

void mem_fail_at(long n)
{
    atomic_store(&allocations_left, n);
}

/* Work that is to stop gets no memory either: it then ends on the same ways as without any. */
static bool must_fail(void)
{
    if (work_stopped())
        return true;
    long left = atomic_load_explicit(&allocations_left, memory_order_relaxed);
    if (left == 0)
        return false;
    if (left == 1)
        return true;
    atomic_fetch_sub(&allocations_left, 1);
    return false;
}

static void *counted(void *block)
{
    if (block)
        work_count((long long)malloc_usable_size(block));
    return block;
}

void *mem_alloc(size_t size)
{
    return must_fail() || !work_has_memory(size) ? NULL : counted(malloc(size ? size : 1));
}

void *mem_calloc(size_t count, size_t size)
{
    size_t bytes;
    if (must_fail() || !size_mul(count, size, &bytes) || !work_has_memory(bytes))
        return NULL;
    return counted(calloc(count ? count : 1, size ? size : 1));
}

void *mem_realloc(void *block, size_t size)
{
    if (must_fail() || !work_has_memory(size))
        return NULL;
    long long before = block ? (long long)malloc_usable_size(block) : 0;
    void     *moved = realloc(block, size ? size : 1);
    if (moved)
        work_count((long long)malloc_usable_size(moved) - before);
    return moved;
}

void mem_free(void *block)
{
    if (block)
        work_count(-(long long)malloc_usable_size(block));
    free(block);
}

void *mem_copy(const void *block, size_t size)
{
    void *copy = mem_alloc(size);
    if (copy && size)
        memcpy(copy, block, size);
    return copy;
}

char *mem_copy_text(const char *text)
{
    return text ? mem_copy(text, strlen(text) + 1) : NULL;
}

bool mem_grow(void **array, size_t *capacity, size_t count, size_t element_size)
{
    if (count <= *capacity)
        return true;
    size_t wanted = *capacity ? *capacity : 16;
    while (wanted < count) {
        if (wanted > SIZE_MAX / 2)
            return false;
        wanted *= 2;
    }
    size_t bytes;
    if (!size_mul(wanted, element_size, &bytes))
        return false;
    void *grown = mem_realloc(*array, bytes);
    if (!grown)
        return false;
    *array = grown;
    *capacity = wanted;
    return true;
}

bool size_mul(size_t a, size_t b, size_t *out)
{
    if (__builtin_mul_overflow(a, b, out)) {
        *out = SIZE_MAX;
        return false;
    }
    return true;
}

bool size_add(size_t a, size_t b, size_t *out)
{
    if (__builtin_add_overflow(a, b, out)) {
        *out = SIZE_MAX;
        return false;
    }
    return true;
}
