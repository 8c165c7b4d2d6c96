/* Writes the manual pages and completions into a folder: limner_pages FOLDER DATE COMMAND…
 * The COMMANDs are those for whose pages the build waits; when the command has others it says so and writes nothing. */
#include "pages.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static FILE *open_page(const char *folder, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *out = fopen(path, "w");
    if (!out) {
        fprintf(stderr, "limner_pages: %s: %s\n", path, strerror(errno));
        exit(EXIT_OUTPUT);
    }
    return out;
}

static void close_page(FILE *out)
{
    bool failed = ferror(out) != 0;
    if (fclose(out) == 0 && !failed)
        return;
    fprintf(stderr, "limner_pages: %s\n", strerror(errno));
    exit(EXIT_OUTPUT);
}

static bool is_expected(char **names, int count)
{
    int i = 0;
    while (i < count && commands[i] && strcmp(commands[i]->name, names[i]) == 0)
        i++;
    return i == count && !commands[i];
}

int main(int count, char **arguments)
{
    if (count < 4 || !is_expected(arguments + 3, count - 3)) {
        fputs("limner_pages: these are not the command's subcommands in their order; mend tools/pages/CMakeLists.txt\n",
              stderr);
        return EXIT_USAGE;
    }
    const char *folder = arguments[1], *date = arguments[2];
    static const struct {
        const char *name;
        void (*write)(FILE *out);
    } scripts[] = {{"limner.bash", write_bash}, {"_limner", write_zsh}, {"limner.fish", write_fish}};
    for (size_t i = 0; i < OPTION_COUNT(scripts); i++) {
        FILE *out = open_page(folder, scripts[i].name);
        scripts[i].write(out);
        close_page(out);
    }
    for (size_t i = 0; commands[i]; i++) {
        char name[64];
        snprintf(name, sizeof name, "limner-%s.1", commands[i]->name);
        FILE *out = open_page(folder, name);
        write_command_manual(out, commands[i], date);
        close_page(out);
    }
    FILE *out = open_page(folder, "limner.1");
    write_manual(out, date);
    close_page(out);
    out = open_page(folder, "limner-look.5");
    write_look_manual(out, date);
    close_page(out);
    return EXIT_DONE;
}
