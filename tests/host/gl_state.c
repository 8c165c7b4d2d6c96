/* docs/reference/gl-state.md from the table of the state that Limner touches: prints it, or compares it with a file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/text.h"
#include "gpu/host_state.h"

static void add_version(text *out, const host_row *row, int version)
{
    if (version)
        text_append(out, "%d.%d", version / 10, version % 10);
    else
        text_append(out, "%s", row->extension && !row->compatibility ? "extension" : "–");
}

static void add_row(text *out, const host_row *row)
{
    bool constant = strncmp(row->name, "GL_", 3) == 0 && !strchr(row->name, ' ') && !strchr(row->name, ',');
    text_append(out, constant ? "| `%s` | %s | " : "| %s | %s | ", row->name, row->neutral);
    add_version(out, row, row->desktop);
    text_append(out, " | ");
    add_version(out, row, row->es);
    text_append(out, " | %s |\n", row->extension ? row->extension : "");
}

static char *page(void)
{
    text        out = {0};
    const char *group = "";
    text_append(
        &out, "# State of OpenGL that Limner touches\n\n"
              "In a context that a renderer has adopted ([EMBEDDING.md](../EMBEDDING.md)), each call saves these,\n"
              "brings them to what is said here, and gives them back at its end, on errors too. With `no_restore`\n"
              "they stay as drawing leaves them, which is not always what is said here. What is not in the table is\n"
              "neither changed nor looked at. Versions are those that have it; what a context lacks is left alone.\n\n"
              "This page is made from the table in `src/gpu/host_state.c`:\n"
              "`cmake --build --preset dev --target gl_state_page`.\n");
    for (size_t i = 0; i < host_row_count; i++) {
        if (strcmp(group, host_rows[i].group) != 0) {
            group = host_rows[i].group;
            text_append(
                &out,
                "\n## %s\n\n| state | while Limner draws | OpenGL | OpenGL ES | extension |\n|---|---|---|---|---|\n",
                group);
        }
        add_row(&out, &host_rows[i]);
    }
    text_append(&out,
                "\n## What cannot be given back\n\n"
                "- Error flags: those that are set when a call begins are lost (`glGetError` before it, where they "
                "matter).\n"
                "- Current values of vertex attributes that were given as integers come back as floats.\n"
                "- A program that was marked as deleted while it was in use is gone when another one is used.\n"
                "- In OpenGL ES with `GL_OES_viewport_array`: viewports beyond the first.\n\n"
                "## What must not be\n\n"
                "- Queries of `GL_SAMPLES_PASSED`, `GL_ANY_SAMPLES_PASSED`, "
                "`GL_ANY_SAMPLES_PASSED_CONSERVATIVE` and `GL_PRIMITIVES_GENERATED` that run: they would count what "
                "Limner draws. Calls refuse that (`LMN_USAGE`).\n"
                "- Conditional rendering, window rectangles and, before OpenGL 4.0, transform feedback that is "
                "active: contexts do not tell.\n");
    return text_take(&out);
}

int main(int count, char **arguments)
{
    char     *made = page();
    file_data there;
    if (!made)
        return 1;
    if (count < 2) {
        fputs(made, stdout);
        free(made);
        return 0;
    }
    if (file_load(&there, arguments[1], NULL) != LMN_OK || strcmp((const char *)there.data, made) != 0) {
        printf("%s is not current; make it anew: cmake --build --preset dev --target gl_state_page\n", arguments[1]);
        return 1;
    }
    file_data_release(&there);
    free(made);
    return 0;
}
