#include "base/warnings.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "base/work.h"

enum { WARNINGS_MAX = 256, WARNING_TEXT_SIZE = 512 };

const char *warning_code_text(warning_code code)
{
    static const char *const names[] = {
#define X(name, text) text,
        WARNING_CODES(X)
#undef X
    };
    return (unsigned)code < WARNING_CODE_COUNT ? names[code] : "unknown";
}

/* True when the list had no such warning. */
static bool count_again(warnings *list, warning_code code, const char *message, size_t count)
{
    for (size_t i = 0; i < list->count; i++)
        if (list->items[i].code == code && strcmp(list->items[i].text, message) == 0) {
            list->items[i].count += count;
            return false;
        }
    return true;
}

static void add(warnings *list, warning_code code, const char *message, size_t count)
{
    if (!count_again(list, code, message, count))
        return;
    if (list->count >= WARNINGS_MAX ||
        !mem_grow((void **)&list->items, &list->capacity, list->count + 1, sizeof *list->items))
        return;
    char *copy = mem_copy_text(message);
    if (copy)
        list->items[list->count++] = (warning){code, copy, count};
}

void warnings_add(warnings *list, warning_code code, const char *format, ...)
{
    char    message[WARNING_TEXT_SIZE];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    text_escape_controls(message, sizeof message);
    if (!list || length < 0 || !count_again(list, code, message, 1))
        return;
    work_log(LMN_LOG_WARNING, warning_code_text(code), message);
    add(list, code, message, 1);
}

void warnings_fold(warnings *list, warning_code code, const char *beginning, const char *what)
{
    char   message[WARNING_TEXT_SIZE];
    size_t kept = 0, first = 0, kinds = 0;
    for (size_t i = 0; i < list->count; i++)
        if (list->items[i].code == code && strncmp(list->items[i].text, beginning, strlen(beginning)) == 0)
            first = kinds++ ? first : i;
    if (kinds < 2)
        return;
    snprintf(message, sizeof message, "%zu %s, the first of them: %.400s", kinds, what, list->items[first].text);
    char *copy = mem_copy_text(message);
    if (!copy)
        return;
    for (size_t i = 0; i < list->count; i++) {
        bool folded = list->items[i].code == code && strncmp(list->items[i].text, beginning, strlen(beginning)) == 0;
        if (folded)
            mem_free(list->items[i].text);
        if (!folded || i == first)
            list->items[kept++] = folded ? (warning){code, copy, 1} : list->items[i];
    }
    list->count = kept;
}

void warnings_append(warnings *list, const warnings *more)
{
    for (size_t i = 0; i < more->count; i++)
        add(list, more->items[i].code, more->items[i].text, more->items[i].count);
}

void warnings_release(warnings *list)
{
    for (size_t i = 0; i < list->count; i++)
        mem_free(list->items[i].text);
    mem_free(list->items);
    memset(list, 0, sizeof *list);
}
