/* Completions for fish. */
#include "pages.h"

/* Text within '…'. */
static void write_quoted(FILE *out, const char *text)
{
    fputc('\'', out);
    for (; *text; text++)
        fprintf(out, *text == '\'' || *text == '\\' ? "\\%c" : "%c", *text);
    fputc('\'', out);
}

/* Words and files that can stand there, as arguments of `complete`. */
static void write_action(FILE *out, value_kind kind, const option *o)
{
    value_words w = value_words_of(kind, o);
    if (kind == VALUE_FILE)
        fputs(" -r -F", out);
    else if (kind == VALUE_FOLDER)
        fputs(" -x -a '(__fish_complete_directories)'", out);
    else if (*w.endings)
        fprintf(out, " -x -k -a '(__fish_complete_suffix %s) %s'", w.endings, w.words);
    else
        fputs(" -x", out);
    if (*w.words && !*w.endings) {
        fputs(" -a ", out);
        write_quoted(out, w.words);
    }
    value_words_free(&w);
}

static void write_option(FILE *out, const command *c, const option *o)
{
    char brief[2048];
    option_brief(o, brief, sizeof brief);
    fprintf(out, "complete -c limner -n '__fish_seen_subcommand_from %s' -l %s", c->name, o->name);
    if (o->short_name)
        fprintf(out, " -s %c", o->short_name);
    if (o->type != OPTION_FLAG)
        write_action(out, option_value_kind(c, o), o);
    fputs(" -d ", out);
    write_quoted(out, brief);
    fputc('\n', out);
}

void write_fish(FILE *out)
{
    fputs("# Completions of limner for fish; made from the command's own tables.\n\ncomplete -c limner -f\n"
          "complete -c limner -n __fish_use_subcommand -l version -d 'Print the version'\n"
          "complete -c limner -s h -l help -d 'Print the options'\n",
          out);
    for (size_t i = 0; commands[i]; i++) {
        const command *c = commands[i];
        fprintf(out, "\ncomplete -c limner -n __fish_use_subcommand -a %s -d ", c->name);
        write_quoted(out, c->summary);
        fputc('\n', out);
        for (size_t k = 0; k < c->option_count; k++)
            write_option(out, c, &c->options[k]);
        if (input_value_kind(c) != VALUE_PLAIN) {
            fprintf(out, "complete -c limner -n '__fish_seen_subcommand_from %s'", c->name);
            write_action(out, input_value_kind(c), NULL);
            fputc('\n', out);
        }
    }
}
