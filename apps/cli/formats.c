#include "formats.h"

#include <stdio.h>
#include <string.h>

bool format_find(lmn_format_info *out, const char *ending)
{
    for (size_t i = 0; lmn_format_at(i, out); i++)
        if (strcmp(out->ending, ending) == 0)
            return true;
    *out = (lmn_format_info){.ending = ""};
    return false;
}

static bool is_of(const lmn_format_info *f, format_sort sort)
{
    return sort == FORMATS_ALL || f->vectors == (sort == FORMATS_VECTORS);
}

const char *format_standard(bool vectors)
{
    lmn_format_info f;
    for (size_t i = 0; lmn_format_at(i, &f); i++)
        if (f.vectors == vectors)
            return f.ending;
    return "";
}

const char *format_list(char out[FORMAT_LIST_SIZE], format_sort sort, bool dots)
{
    lmn_format_info f;
    size_t          count = 0, written = 0, used = 0;
    for (size_t i = 0; lmn_format_at(i, &f); i++)
        count += is_of(&f, sort);
    out[0] = '\0';
    for (size_t i = 0; lmn_format_at(i, &f) && used < FORMAT_LIST_SIZE; i++)
        if (is_of(&f, sort)) {
            const char *before = written == 0 ? "" : written + 1 < count ? ", " : " or ";
            used += (size_t)snprintf(out + used, FORMAT_LIST_SIZE - used, "%s%s", before, f.ending + (dots ? 0 : 1));
            written++;
        }
    return out;
}
