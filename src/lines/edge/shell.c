/* shell: outlines by shifted back faces (Raskar and Cohen 1999). Großmann 2011, section 3.2.4.1, where the line's
 * width cannot be chosen; here faces that look away are moved across the page, by the line's width in pixels, and
 * ink is where they come into sight: beside an outline, on nothing or on what lies farther. They move away from the
 * body they belong to, so that no flat face has ink; how much a line costs does not depend on its width. Sections
 * and solids have no shells. */
#include "lines/lines.h"
#include "stroke/ribbon.h"

typedef struct shell {
    lines_common common;
} shell;

static const pass passes[] = {
    {.name = "shell", .geometry = true, .enlarge = "width", .shell = true, .writes = TARGET_STROKES},
    {.name = "edges",
     .shader = "lines/edge/shell.frag",
     .reads = {TARGET_DEPTH, TARGET_STROKES},
     .writes = TARGET_EDGE},
    LINES_PASSES_CONTRAST,
};

static void shell_as_strokes(stroke_options *options, stroke_style *style, const void *values)
{
    lines_as_strokes(options, style, values);
    options->creases = options->intersections = false;
}

const technique lines_shell = {
    .name = "shell",
    .doc = "Outlines outside closed bodies, wholly beside them, from their far faces moved outwards; at hard edges "
           "they are narrower and have gaps at corners.",
    .example = "{\"lines\": {\"operator\": \"shell\", \"width\": 4}, \"surface\": \"flat\"}",
    .params_size = sizeof(shell),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    LINES_TARGETS,
    .lines = &(const lines_row){.as_strokes = shell_as_strokes},
};
