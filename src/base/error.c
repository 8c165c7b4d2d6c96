#include "base/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"

static void format_into(char *text, size_t size, const char *format, va_list arguments)
{
    if (vsnprintf(text, size, format, arguments) < 0)
        text[0] = '\0';
    text_escape_controls(text, size);
}

static void copy_into(char *text, size_t size, const char *source)
{
    size_t length = source ? strlen(source) : 0;
    if (length >= size)
        length = size - 1;
    if (length)
        memcpy(text, source, length);
    text[length] = '\0';
}

lmn_status error_set(lmn_error *error, lmn_status status, const char *format, ...)
{
    if (!error)
        return status;
    memset(error, 0, sizeof *error);
    error->status = status;
    va_list arguments;
    va_start(arguments, format);
    format_into(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
    return status;
}

lmn_status error_in_file(lmn_error *error, lmn_status status, const char *file, int line, const char *format, ...)
{
    if (!error)
        return status;
    memset(error, 0, sizeof *error);
    error->status = status;
    error->line = line;
    copy_into(error->file, sizeof error->file, file);
    va_list arguments;
    va_start(arguments, format);
    format_into(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
    return status;
}

void error_file(lmn_error *error, const char *file)
{
    if (error)
        copy_into(error->file, sizeof error->file, file);
}

void error_hint(lmn_error *error, const char *format, ...)
{
    if (!error)
        return;
    va_list arguments;
    va_start(arguments, format);
    format_into(error->hint, sizeof error->hint, format, arguments);
    va_end(arguments);
}

lmn_status error_memory(lmn_error *error)
{
    return error_set(error, LMN_MEMORY, "out of memory");
}

const char *lmn_status_text(lmn_status status)
{
    switch (status) {
    case LMN_OK: return "done";
    case LMN_USAGE: return "wrong argument";
    case LMN_READ: return "cannot be read";
    case LMN_FORMAT: return "wrong content";
    case LMN_LIMIT: return "limit exceeded";
    case LMN_UNSUPPORTED: return "not supported";
    case LMN_WRITE: return "cannot be written";
    case LMN_GL: return "no usable OpenGL";
    case LMN_MEMORY: return "out of memory";
    case LMN_CANCELLED: return "cancelled";
    case LMN_INTERNAL: return "internal defect";
    }
    return "unknown status";
}
