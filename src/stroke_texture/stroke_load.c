/* Stroke textures by the endings of their files. */
#include <string.h>

#include "base/file.h"
#include "stroke_texture/strokes.h"

lmn_status strokes_load(strokes *out, const char *path, lmn_error *error)
{
    char      ending[8];
    file_data data;
    *out = (strokes){.width = 1};
    file_ending(path, ending, sizeof ending);
    bool svg = strcmp(ending, ".svg") == 0;
    if (!svg && strcmp(ending, ".stx") != 0) {
        error_in_file(error, LMN_UNSUPPORTED, path, 0, "strokes are not read from files that end in '%s'", ending);
        error_hint(error, "give a .stx file, or a drawing as .svg");
        return LMN_UNSUPPORTED;
    }
    lmn_status status = file_load(&data, path, error);
    if (status != LMN_OK)
        return status;
    const char *bytes = (const char *)data.data;
    status =
        svg ? strokes_read_svg(out, path, bytes, data.size, error) : strokes_read(out, path, bytes, data.size, error);
    file_data_release(&data);
    if (status == LMN_OK)
        strokes_wrap(out);
    return status;
}
