#include "base/memory.h"

#include <malloc.h>
#include <stdatomic.h>
#include <stddef.h>
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

/* --- where it comes from -------------------------------------------------------------------------------- */

/* Settled by the first block, or by the caller before; then never changed but in child processes. */
typedef enum memory_source { SOURCE_OPEN = 0, SOURCE_MALLOC, SOURCE_CALLER, SOURCE_CHILD } memory_source;
static atomic_int    source;
static lmn_allocator caller; /* from SOURCE_CALLER on */

/* Stands before blocks that may be the caller's, who does not tell how large they are. */
typedef union head {
    struct {
        size_t size;
        bool   plain; /* malloc's, of a child process */
    };
    max_align_t alignment;
} head;

static memory_source where(void)
{
    int now = atomic_load_explicit(&source, memory_order_acquire);
    if (now != SOURCE_OPEN)
        return (memory_source)now;
    return atomic_compare_exchange_strong(&source, &now, SOURCE_MALLOC) ? SOURCE_MALLOC : (memory_source)now;
}

bool mem_use(const lmn_allocator *allocator)
{
    int open = SOURCE_OPEN;
    if (atomic_load(&source) != SOURCE_OPEN)
        return false;
    caller = *allocator;
    return atomic_compare_exchange_strong(&source, &open, SOURCE_CALLER);
}

void mem_enter_child(void)
{
    int from = SOURCE_CALLER;
    atomic_compare_exchange_strong(&source, &from, SOURCE_CHILD);
}

static size_t size_of(void *block)
{
    return where() == SOURCE_MALLOC ? malloc_usable_size(block) : ((head *)block - 1)->size;
}

static void *take(size_t size)
{
    memory_source from = where();
    size_t        whole;
    if (from == SOURCE_MALLOC)
        return malloc(size);
    if (!size_add(size, sizeof(head), &whole))
        return NULL;
    head *made = from == SOURCE_CHILD ? malloc(whole) : caller.alloc(whole, caller.user);
    if (!made)
        return NULL;
    made->size = size;
    made->plain = from == SOURCE_CHILD;
    return made + 1;
}

/* In a child process the caller's blocks stay: its allocator may be in the middle of something there. */
static void give(void *block)
{
    memory_source from = where();
    if (from == SOURCE_MALLOC || !block) {
        free(block);
        return;
    }
    head *made = (head *)block - 1;
    if (made->plain)
        free(made);
    else if (from == SOURCE_CALLER)
        caller.release(made, caller.user);
}

static void *resize(void *block, size_t size)
{
    memory_source from = where();
    size_t        whole;
    if (from == SOURCE_MALLOC)
        return realloc(block, size);
    if (!block)
        return take(size);
    if (!size_add(size, sizeof(head), &whole))
        return NULL;
    head *before = (head *)block - 1;
    if (from == SOURCE_CHILD && !before->plain) {
        void *moved = take(size);
        return moved ? memcpy(moved, block, before->size < size ? before->size : size) : NULL;
    }
    head *made = before->plain ? realloc(before, whole) : caller.resize(before, whole, caller.user);
    if (!made)
        return NULL;
    made->size = size;
    return made + 1;
}

/* --- what is counted and may fail ----------------------------------------------------------------------- */

static void *counted(void *block)
{
    if (block)
        work_count((long long)size_of(block));
    return block;
}

void *mem_alloc(size_t size)
{
    return must_fail() || !work_has_memory(size) ? NULL : counted(take(size ? size : 1));
}

/* Fresh pages of malloc are 0 without being touched. */
static void *take_cleared(size_t bytes)
{
    if (where() == SOURCE_MALLOC)
        return calloc(1, bytes);
    void *block = take(bytes);
    return block ? memset(block, 0, bytes) : NULL;
}

void *mem_calloc(size_t count, size_t size)
{
    size_t bytes;
    if (must_fail() || !size_mul(count, size, &bytes) || !work_has_memory(bytes))
        return NULL;
    return counted(take_cleared(bytes ? bytes : 1));
}

void *mem_realloc(void *block, size_t size)
{
    long long before = block ? (long long)size_of(block) : 0;
    if (must_fail() || (size > (size_t)before && !work_has_memory(size)))
        return NULL;
    void *moved = resize(block, size ? size : 1);
    if (moved)
        work_count((long long)size_of(moved) - before);
    return moved;
}

void mem_free(void *block)
{
    if (block)
        work_count(-(long long)size_of(block));
    give(block);
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
