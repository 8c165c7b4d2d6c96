#include "trace.h"

#include <glib.h>
#include <stdarg.h>
#include <stdio.h>

static FILE *out; /* written once, before there is a window */

static gboolean beat(gpointer last)
{
    gint64 now = g_get_monotonic_time(), *before = last;
    if (*before && now - *before > 20000)
        trace_event("gap ms=%.1f", (double)(now - *before) / 1e3);
    *before = now;
    return G_SOURCE_CONTINUE;
}

void trace_begin(void)
{
    static gint64 last;
    const char   *fd = g_getenv("LIMNER_VIEW_TRACE");
    out = fd ? fdopen((int)g_ascii_strtoll(fd, NULL, 10), "w") : NULL;
    if (out && g_getenv("LIMNER_VIEW_HEARTBEAT"))
        g_timeout_add(4, beat, &last);
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
