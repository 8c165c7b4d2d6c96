/* The table of formats. */
#include "export/export.h"

#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"

/* The first of each sort is the one of standard output. */
const export_format export_formats[] = {
    {".png", "Pixels, 8 bits for each of red, green, blue and opacity.", .ground = true, .pictures = true,
     .write_pixels = export_png},
    {".svg", "Vectors for screens, in groups to edit.", .ground = true, .pictures = true, .areas = true, .title = true,
     .write_sheet = export_svg},
    {".pdf", "Vectors for print, on one page.", .ground = true, .pictures = true, .areas = true, .title = true,
     .write_sheet = export_pdf},
    {".dxf", "Lines alone, for CAD programs: release 2000, in millimetres.", .write_sheet = export_dxf},
};
const size_t export_format_count = sizeof export_formats / sizeof *export_formats;

enum { ENDINGS_MAX = 8 };

/* The endings of sheets, or of pixels; returns how many. */
static size_t endings_of(bool sheets, const char *out[ENDINGS_MAX])
{
    size_t count = 0;
    for (size_t i = 0; i < export_format_count && count < ENDINGS_MAX; i++)
        if ((export_formats[i].write_sheet != NULL) == sheets)
            out[count++] = export_formats[i].ending;
    return count;
}

static lmn_status unknown(const char *path, const char *format, bool sheets, lmn_error *error)
{
    const char *known[ENDINGS_MAX], *sort = sheets ? "sheets" : "pictures";
    size_t      count = endings_of(sheets, known);
    lmn_status  status = error_in_file(error, LMN_USAGE, path, 0, "cannot write '%s' %s", format, sort);
    const char *nearest = text_nearest(format, known, count);
    text        list = {0};
    for (size_t i = 0; i < count; i++)
        text_append(&list, "%s%s", i == 0 ? "" : i + 1 < count ? ", " : " or ", known[i]);
    char *listed = text_take(&list);
    if (nearest)
        error_hint(error, "did you mean '%s'?", nearest);
    else if (listed)
        error_hint(error, "%s are written as %s", sort, listed);
    mem_free(listed);
    return status;
}

lmn_status export_choose(const export_format **out, const char *path, const char *format, bool sheets, lmn_error *error)
{
    char        ending[16];
    const char *known[ENDINGS_MAX];
    endings_of(sheets, known);
    if (!format)
        file_ending(path, ending, sizeof ending);
    const char *wanted = format ? format : strcmp(path, "-") == 0 ? known[0] : ending;
    const char *name = *wanted == '.' ? wanted + 1 : wanted;
    for (size_t i = 0; i < export_format_count; i++)
        if ((export_formats[i].write_sheet != NULL) == sheets && strcmp(export_formats[i].ending + 1, name) == 0) {
            *out = &export_formats[i];
            return LMN_OK;
        }
    return unknown(path, wanted, sheets, error);
}
