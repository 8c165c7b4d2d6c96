/* The sticky error, and what is known of the context. */
#include "gpu/gpu_private.h"

#include <stdarg.h>
#include <stdio.h>

void gpu_fail(gpu *g, lmn_status status, const char *format, ...)
{
    if (g->failed)
        return;
    char message[sizeof g->error.message];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    g->failed = true;
    error_set(&g->error, status, "%s", message);
}

bool gpu_failed(const gpu *g)
{
    return g->failed;
}

lmn_status gpu_check(gpu *g, lmn_error *error)
{
    if (!g->failed)
        return LMN_OK;
    g->failed = false;
    if (error)
        *error = g->error;
    return g->error.status;
}

void gpu_finish(gpu *g)
{
    glFinish();
    g->indices_in_flight = 0;
}

const gpu_facts *gpu_facts_of(const gpu *g)
{
    return &g->facts;
}

uint64_t gpu_draw_count(const gpu *g)
{
    return g->draws;
}
