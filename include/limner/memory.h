/* Where the library's memory comes from. */
#ifndef LIMNER_MEMORY_H
#define LIMNER_MEMORY_H

#include "limner/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* As malloc, realloc of a block that is there, and free of one. From any thread, several at once. Blocks are aligned
 * for every type, as those of malloc are; NULL says that there is no memory, and then the block stays what it was. */
typedef void *(*lmn_alloc_fn)(size_t size, void *user);
typedef void *(*lmn_resize_fn)(void *block, size_t size, void *user);
typedef void (*lmn_release_fn)(void *block, void *user);

/* What the library calls instead of those. Initialise with LMN_ALLOCATOR_INIT. */
typedef struct lmn_allocator {
    size_t         struct_size;
    lmn_alloc_fn   alloc;
    lmn_resize_fn  resize;
    lmn_release_fn release;
    void          *user;
} lmn_allocator;
#define LMN_ALLOCATOR_INIT                                                                                             \
    {                                                                                                                  \
        sizeof(lmn_allocator), NULL, NULL, NULL, NULL                                                                  \
    }

/* Takes all memory of the library from here: once in a process, before any call that makes something, and for as long
 * as the process lives. Limits (limner/limits.h) count what is asked for. What is freed by the caller (lmn_text_free,
 * lmn_bytes_free) or made for the library (lmn_file_alloc) is among it. Not among it is what other libraries take for
 * themselves (JSON, PNG, fonts, the driver), and what the child process for decoders takes, which calls none of this.
 * Errors: LMN_USAGE (NULL, also among the functions; memory is in use already). Since 0.1. */
LMN_API lmn_status lmn_allocator_set(const lmn_allocator *allocator, lmn_error *error);

#ifdef __cplusplus
}
#endif
#endif
