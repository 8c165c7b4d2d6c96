/* The fence: other people's decoders run in a child process that has nothing but the bytes it is given, so that a
 * fault there is an error for one file. The child is a copy of this process that has closed what was open, whose
 * memory is limited, and whom the kernel refuses everything but computing and answering (seccomp, where there is
 * one): no files, no network, no processes. It is started with the first request of the outermost work
 * (base/work.h) and kept for its others; one that dies is replaced at the next request. */
#ifndef LIMNER_FENCE_FENCE_H
#define LIMNER_FENCE_FENCE_H

#include <stdint.h>

#include "base/error.h"

/* Bytes that grow; for answers and requests. Zero-initialise; `bytes` is freed with mem_free. */
typedef struct fence_bytes {
    unsigned char *bytes;
    size_t         size, capacity;
    bool           failed; /* memory was gone: what was put since is missing */
} fence_bytes;

void fence_put(fence_bytes *to, const void *bytes, size_t size);
void fence_put_u32(fence_bytes *to, uint32_t value);
void fence_put_text(fence_bytes *to, const char *text); /* its length first; NULL is "" */

/* Takes from the front of bytes, and never beyond their end: then everything is 0, and `ended` is set. */
typedef struct fence_reader {
    const unsigned char *at, *end;
    bool                 ended;
} fence_reader;

fence_reader fence_read(const void *bytes, size_t size);
const void  *fence_take(fence_reader *r, size_t size); /* NULL at the end */
uint32_t     fence_take_u32(fence_reader *r);
char        *fence_take_text(fence_reader *r); /* owned by the caller; NULL at the end or without memory */

/* What runs behind the fence. It knows nothing but the request, and calls nothing that opens files. */
typedef lmn_status (*fence_fn)(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error);

/* Runs `fn`; `what` names it in messages: "the PNG reader". The answer belongs to the caller, also when there is an
 * error: then it is empty. Errors: those of `fn`; LMN_FORMAT when it crashed; LMN_LIMIT when it took too long or
 * too much memory; LMN_MEMORY; LMN_CANCELLED. */
lmn_status fence_call(fence_bytes *answer, fence_fn fn, const char *what, const fence_bytes *request, lmn_error *error);

/* The same for what runs apart even where decoders run in this process: work that may take very long, because only
 * a process can be stopped at any moment, and readers that end the process on some files. */
lmn_status fence_call_always(fence_bytes *answer, fence_fn fn, const char *what, const fence_bytes *request,
                             lmn_error *error);

/* The same with a library that opens files of its own before it can work (its plugins, tables, other libraries): a
 * child for this call alone, in which `prepare` runs before it is fenced and before it has the request. */
typedef void (*fence_prepare)(void);
lmn_status fence_call_prepared(fence_bytes *answer, fence_fn fn, fence_prepare prepare, const char *what,
                               const fence_bytes *request, lmn_error *error);

/* How the child is fenced, for people: "seccomp and limits" or "limits". */
const char *fence_kind(void);

#endif
