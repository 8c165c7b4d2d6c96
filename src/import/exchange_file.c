#define _GNU_SOURCE /* memmem */
#include "import/exchange_file.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

exchange_kind exchange_file_kind(const file_data *file)
{
    static const char first[] = "ISO-10303-21";
    const char       *at = (const char *)file->data, *end = at + (file->size < 65536 ? file->size : 65536);
    while (at < end && isspace((unsigned char)*at))
        at++;
    if ((size_t)(end - at) < sizeof first || memcmp(at, first, sizeof first - 1) != 0)
        return EXCHANGE_NONE;
    const char *schema = memmem(at, (size_t)(end - at), "FILE_SCHEMA", 11);
    const char *quote = schema ? memchr(schema, '\'', (size_t)(end - schema)) : NULL;
    return quote && end - quote >= 4 && strncasecmp(quote + 1, "IFC", 3) == 0 ? EXCHANGE_IFC : EXCHANGE_STEP;
}
