/* include/limner/memory.h: checks arguments and forwards. */
#include "limner/memory.h"

#include "api/complete.h"
#include "base/error.h"
#include "base/memory.h"

lmn_status lmn_allocator_set(const lmn_allocator *allocator, lmn_error *error)
{
    lmn_allocator full = LMN_ALLOCATOR_INIT;
    lmn_status    status = desc_complete(&full, sizeof full, allocator, "LMN_ALLOCATOR_INIT", error);
    if (status != LMN_OK)
        return status;
    if (!full.alloc || !full.resize || !full.release)
        return error_set(error, LMN_USAGE, "lmn_allocator_set: `%s` is NULL",
                         !full.alloc    ? "alloc"
                         : !full.resize ? "resize"
                                        : "release");
    if (mem_use(&full))
        return LMN_OK;
    error_set(error, LMN_USAGE, "lmn_allocator_set: memory is in use already");
    error_hint(error, "call it once, before anything else of Limner");
    return LMN_USAGE;
}
