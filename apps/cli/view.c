/* limner view: the viewer's window, which is a program of its own, so that the command does without GTK. */
#include "cli.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct view_values {
    const char *look;
} view_values;

static const option options[] = {
    {"look", 'l', OPTION_TEXT, offsetof(view_values, look), "NAME|FILE",
     "Look to begin with: one of `limner looks`, or a file. Default: edges, or that of the last time without INPUT."},
};

/* It lies beside the command. False when the command does not know where it is itself. */
static bool find_viewer(char *out, size_t size)
{
    ssize_t length = readlink("/proc/self/exe", out, size - 1);
    if (length <= 0)
        return false;
    out[length] = 0;
    char *slash = strrchr(out, '/');
    if (!slash || (size_t)(slash - out) + sizeof "/limner-viewer" > size)
        return false;
    memcpy(slash, "/limner-viewer", sizeof "/limner-viewer");
    return true;
}

static int run(const word_list *inputs, const void *values)
{
    const view_values *v = values;
    char               program[4096];
    const char       **words = calloc(inputs->count + 5, sizeof *words);
    size_t             count = 0;
    if (!words)
        return message_out_of_memory();
    if (!find_viewer(program, sizeof program) || access(program, X_OK) != 0) {
        free(words);
        lmn_error error = {.status = LMN_UNSUPPORTED, .message = "the viewer is not installed"};
        snprintf(error.hint, sizeof error.hint,
                 "install the package limner-viewer; `limner draw` writes pictures without it");
        return message_error(&error);
    }
    words[count++] = program;
    if (v->look) {
        words[count++] = "--look";
        words[count++] = v->look;
    }
    words[count++] = "--"; /* files may begin with a dash */
    for (size_t i = 0; i < inputs->count; i++)
        words[count++] = inputs->items[i];
    fflush(NULL);
    execv(program, (char *const *)(void *)words);
    lmn_error error = {.status = LMN_UNSUPPORTED};
    snprintf(error.message, sizeof error.message, "%.200s cannot be started: %s", program, strerror(errno));
    free(words);
    return message_error(&error);
}

const command command_view = {
    .name = "view",
    .inputs = "[INPUT…]",
    .summary = "Show models in a window, try looks, and export what is seen.",
    .detail = "Without INPUT it goes on where it was left. docs/VIEWER.md tells what it can do.",
    .options = options,
    .option_count = OPTION_COUNT(options),
    .values_size = sizeof(view_values),
    .inputs_min = 0,
    .inputs_max = (size_t)-1,
    .run = run,
};
