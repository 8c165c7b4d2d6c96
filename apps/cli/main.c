/* limner: the command. Everything follows from the declarations of its subcommands. */
#include "cli.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *command_name_at(size_t index, const void *user)
{
    (void)user;
    return commands[index] ? commands[index]->name : NULL; /* asked in order, up to the end */
}

static void print_usage(void)
{
    printf("usage: limner COMMAND …\n\nDraws 3D models the way people draw.\n\ncommands:\n");
    for (size_t i = 0; commands[i]; i++)
        printf("  %-8s %s\n", commands[i]->name, commands[i]->summary);
    printf("\n`limner COMMAND --help` tells more about one; `limner --version` prints the version.\n"
           "A first picture: limner draw MODEL.glb --look toon\n");
}

static int run_command(const command *c, int count, char **arguments)
{
    word_list inputs = {0};
    bool      help = false;
    void     *values = calloc(1, c->values_size ? c->values_size : 1);
    if (!values)
        return message_out_of_memory();
    int status = options_parse(c, count, arguments, values, &inputs, &help);
    if (status == EXIT_DONE && help)
        options_print_usage(c);
    else if (status == EXIT_DONE)
        status = c->run(&inputs, values);
    options_release(c, values, &inputs);
    free(values);
    return status;
}

static int unknown_command(const char *name)
{
    char        hint[128] = "`limner --help` lists the commands";
    const char *near = options_nearest(name, command_name_at, NULL);
    if (near)
        snprintf(hint, sizeof hint, "did you mean 'limner %s'?", near);
    else if (strchr(name, '.'))
        snprintf(hint, sizeof hint, "to draw it: limner draw %.80s", name);
    return message_usage(hint, "there is no command '%.80s'", name);
}

static int run(int count, char **arguments)
{
    const char *name = count > 1 ? arguments[1] : "";
    if (strcmp(name, "--version") == 0) {
        printf("limner %s\n", lmn_version());
        return EXIT_DONE;
    }
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || (strcmp(name, "help") == 0 && count == 2)) {
        print_usage();
        return EXIT_DONE;
    }
    if (!*name)
        return message_usage("`limner --help` lists the commands", "no command is given");
    bool help = strcmp(name, "help") == 0;
    for (size_t i = 0; commands[i]; i++) {
        if (help && strcmp(arguments[2], commands[i]->name) == 0) {
            options_print_usage(commands[i]);
            return EXIT_DONE;
        }
        if (strcmp(name, commands[i]->name) == 0)
            return run_command(commands[i], count - 2, arguments + 2);
    }
    return unknown_command(help ? arguments[2] : name);
}

int main(int count, char **arguments)
{
    /* A limit on the size of files is an error of the write that meets it. Drivers write caches of their own, in
     * threads of their own. */
    signal(SIGXFSZ, SIG_IGN);
    int status = run(count, arguments);
    progress_end();
    if ((fflush(stdout) != 0 || ferror(stdout)) && status == EXIT_DONE)
        status = message_output("standard output", strerror(errno));
    return status;
}
