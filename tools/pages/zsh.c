/* Completions for zsh. */
#include "pages.h"

#include <string.h>

/* Text within '…' and an argument's specification of _arguments. */
static void write_spec(FILE *out, const char *text)
{
    for (; *text; text++)
        if (*text == '\'')
            fputs("'\\''", out);
        else
            fprintf(out, strchr("[]:\\", *text) ? "\\%c" : "%c", *text);
}

/* ".glb .stl" as a pattern: *.(glb|stl) in any case. */
static void write_pattern(FILE *out, const char *endings)
{
    fputs("_files -g \"(#i)*.(", out);
    for (const char *at = endings; *at; at++)
        if (*at == ' ')
            fputc('|', out);
        else if (*at != '.')
            fputc(*at, out);
    fputs(")\"", out);
}

static void write_action(FILE *out, value_kind kind, const option *o)
{
    value_words w = value_words_of(kind, o);
    if (kind == VALUE_FILE)
        fputs("_files", out);
    else if (kind == VALUE_FOLDER)
        fputs("_files -/", out);
    else if (kind == VALUE_LOOK)
        fputs("_limner_look", out);
    else if (kind == VALUE_SETTING)
        fputs("_limner_setting", out);
    else if (kind == VALUE_PATTERN)
        fputs("_limner_pattern", out);
    else if (*w.words)
        fprintf(out, "(%s)", w.words);
    else if (*w.endings)
        write_pattern(out, w.endings);
    value_words_free(&w);
}

static void write_option(FILE *out, const command *c, const option *o)
{
    char brief[2048];
    option_brief(o, brief, sizeof brief);
    fputs("            ", out);
    if (o->type == OPTION_LIST)
        fputs("'*'", out);
    else if (o->short_name)
        fprintf(out, "'(-%c --%s)'", o->short_name, o->name);
    /* The value stands in the same word or in the next one. */
    bool valued = o->type != OPTION_FLAG;
    if (o->short_name)
        fprintf(out, "{-%c%s,--%s%s}'[", o->short_name, valued ? "+" : "", o->name, valued ? "=" : "");
    else
        fprintf(out, "'--%s%s[", o->name, valued ? "=" : "");
    write_spec(out, brief);
    fputc(']', out);
    if (valued) {
        fputc(':', out);
        write_spec(out, o->argument);
        fputc(':', out);
        write_action(out, option_value_kind(c, o), o);
    }
    fputs("' \\\n", out);
}

static void write_command(FILE *out, const command *c)
{
    fprintf(out, "        %s)\n            _arguments -s -S \\\n", c->name);
    for (size_t i = 0; i < c->option_count; i++)
        write_option(out, c, &c->options[i]);
    fputs("            '(- *)'{-h,--help}'[Print the options]'", out);
    if (c->inputs) {
        fprintf(out, " \\\n            '%s:", c->inputs_max > 1 ? "*" : "1");
        write_spec(out, c->inputs);
        fputc(':', out);
        write_action(out, input_value_kind(c), NULL);
        fputc('\'', out);
    }
    fputs("\n            ;;\n", out);
}

static void write_words_function(FILE *out, const char *name, value_kind kind)
{
    value_words w = value_words_of(kind, NULL);
    fprintf(out, "_limner_%s() {\n    local -a words=(%s)\n", name, w.words);
    if (kind == VALUE_SETTING)
        fputs("    compadd -S '' -a words\n", out);
    else
        fputs("    compadd -a words\n", out);
    if (*w.endings) {
        fputs("    ", out);
        write_pattern(out, w.endings);
        fputc('\n', out);
    }
    fputs("}\n\n", out);
    value_words_free(&w);
}

void write_zsh(FILE *out)
{
    fputs("#compdef limner\n# Completions of limner for zsh; made from the command's own tables.\n\n", out);
    write_words_function(out, "look", VALUE_LOOK);
    write_words_function(out, "setting", VALUE_SETTING);
    write_words_function(out, "pattern", VALUE_PATTERN);
    fputs("_limner() {\n    local context state state_descr line\n    typeset -A opt_args\n"
          "    _arguments -C '(- *)'{-h,--help}'[List the commands]' '(- *)--version[Print the version]' \\\n"
          "        '1:command:->command' '*::argument:->argument' && return 0\n"
          "    case $state in\n    command)\n        local -a commands=(\n",
          out);
    for (size_t i = 0; commands[i]; i++) {
        fprintf(out, "            '%s:", commands[i]->name);
        write_spec(out, commands[i]->summary);
        fputs("'\n", out);
    }
    fputs("        )\n        _describe -t commands command commands\n        ;;\n    argument)\n"
          "        case $line[1] in\n",
          out);
    for (size_t i = 0; commands[i]; i++)
        write_command(out, commands[i]);
    fputs("        esac\n        ;;\n    esac\n}\n\n"
          "if [[ $funcstack[1] == _limner ]]; then\n    _limner \"$@\"\nelse\n    compdef _limner limner\nfi\n",
          out);
}
