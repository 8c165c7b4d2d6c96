/* The sticky error, and what is known of the context. */
#include "gpu/gpu_private.h"

#include <stdarg.h>
#include <stdio.h>

#include "base/clock.h"

/* The first failure stays. `file`: NULL where no text is to blame. */
static void fail(gpu *g, lmn_status status, const char *file, int line, const char *format, va_list arguments)
{
    char message[sizeof g->error.message];
    if (g->failed)
        return;
    vsnprintf(message, sizeof message, format, arguments);
    g->failed = true;
    if (file)
        error_in_file(&g->error, status, file, line, "%s", message);
    else
        error_set(&g->error, status, "%s", message);
}

void gpu_fail(gpu *g, lmn_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fail(g, status, NULL, 0, format, arguments);
    va_end(arguments);
}

void gpu_fail_in(gpu *g, lmn_status status, const char *file, int line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fail(g, status, file, line, format, arguments);
    va_end(arguments);
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
    /* What is sent anew with each call is not asked about there. */
    if (glGetError() == GL_OUT_OF_MEMORY)
        gpu_fail(g, LMN_MEMORY, "the driver ran out of memory");
    g->indices_in_flight = 0;
    g->pixels_in_flight = 0;
    g->finished_ms = clock_ms();
}

const gpu_capabilities *gpu_capabilities_of(const gpu *g)
{
    return &g->capabilities;
}

bool gpu_has_lists(const gpu *g)
{
    return g->capabilities.lists && g->capabilities.max_storage_mib >= 16;
}

uint64_t gpu_draw_count(const gpu *g)
{
    return g->draws;
}
