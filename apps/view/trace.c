#include "trace.h"

#include <glib.h>
#include <stdarg.h>
#include <stdio.h>

static FILE *out; /* written once, before there is a window */

void trace_begin(void)
{
    const char *fd = g_getenv("LIMNER_VIEW_TRACE");
    out = fd ? fdopen((int)g_ascii_strtoll(fd, NULL, 10), "w") : NULL;
}

void trace_event(const char *format, ...)
{
    if (!out)
        return;
    va_list list;
    va_start(list, format);
    fprintf(out, "%" G_GINT64_FORMAT " ", g_get_monotonic_time());
    vfprintf(out, format, list);
    fputc('\n', out);
    fflush(out);
    va_end(list);
}
