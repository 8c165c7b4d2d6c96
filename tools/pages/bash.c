/* Completions for bash. */
#include "pages.h"

static const char functions[] =
    "# Completions of limner for bash; made from the command's own tables.\n\n"
    "# Words of a list that begin with what is there.\n"
    "_limner_words() {\n"
    "    COMPREPLY+=($(compgen -W \"$1\" -- \"$cur\"))\n"
    "}\n\n"
    "# Files with these endings, and folders on the way to them; any file without endings.\n"
    "_limner_files() {\n"
    "    local file ending\n"
    "    compopt -o filenames 2> /dev/null\n"
    "    while IFS= read -r file; do\n"
    "        [[ -z $1 || -d $file ]] && COMPREPLY+=(\"$file\") && continue\n"
    "        for ending in $1; do\n"
    "            [[ ${file,,} == *\"$ending\" ]] && COMPREPLY+=(\"$file\") && break\n"
    "        done\n"
    "    done < <(compgen -f -- \"$cur\")\n"
    "}\n\n"
    "_limner_folders() {\n"
    "    local folder\n"
    "    compopt -o filenames 2> /dev/null\n"
    "    while IFS= read -r folder; do COMPREPLY+=(\"$folder\"); done < <(compgen -d -- \"$cur\")\n"
    "}\n\n"
    "# Words of the line as limner sees them: bash takes '=' for an end of words.\n"
    "_limner_join() {\n"
    "    local i\n"
    "    words=() cur=\n"
    "    for ((i = 0; i <= COMP_CWORD; i++)); do\n"
    "        if ((i > 1)) && [[ ${COMP_WORDS[i]} == '=' || ${COMP_WORDS[i - 1]} == '=' ]]; then\n"
    "            words[${#words[@]} - 1]+=${COMP_WORDS[i]}\n"
    "        else\n"
    "            words+=(\"${COMP_WORDS[i]}\")\n"
    "        fi\n"
    "    done\n"
    "    cur=${words[${#words[@]} - 1]}\n"
    "}\n\n";

static const char entry[] =
    "_limner() {\n"
    "    local cur prev words option='' i\n"
    "    COMPREPLY=()\n"
    "    _limner_join\n"
    "    prev=${words[${#words[@]} - 2]:-}\n"
    "    if ((${#words[@]} == 2)) || [[ ${words[1]} == help ]]; then\n"
    "        _limner_words \"$_limner_commands help --help --version\"\n"
    "        return\n"
    "    fi\n"
    "    # The value stands in the same word as its option, or in the next one.\n"
    "    if [[ $cur == --*=* ]]; then\n"
    "        option=${cur%%=*} cur=${cur#*=}\n"
    "    elif [[ $prev == -* ]]; then\n"
    "        option=$prev\n"
    "    fi\n"
    "    _limner_value \"${words[1]}\" \"$option\" || {\n"
    "        if [[ $cur == -* ]]; then\n"
    "            _limner_words \"$(_limner_options \"${words[1]}\")\"\n"
    "        else\n"
    "            _limner_input \"${words[1]}\"\n"
    "        fi\n"
    "    }\n"
    "    [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *= ]] && compopt -o nospace 2> /dev/null\n"
    "    # Where '=' ends words, what is before it is not to be written again.\n"
    "    if [[ $cur == *=* && $COMP_WORDBREAKS == *=* ]]; then\n"
    "        for i in \"${!COMPREPLY[@]}\"; do COMPREPLY[i]=${COMPREPLY[i]#\"${cur%\"${cur##*=}\"}\"}; done\n"
    "    fi\n"
    "    return 0\n"
    "}\n"
    "complete -F _limner limner\n";

static void write_action(FILE *out, value_kind kind, const option *o)
{
    value_words w = value_words_of(kind, o);
    if (kind == VALUE_FILE)
        fputs("_limner_files ''", out);
    else if (kind == VALUE_FOLDER)
        fputs("_limner_folders", out);
    else if (kind == VALUE_LOOK || kind == VALUE_SETTING)
        fprintf(out, "_limner_words \"$_limner_%s\"", kind == VALUE_LOOK ? "looks" : "settings");
    else if (*w.words)
        fprintf(out, "_limner_words '%s'", w.words);
    else if (!*w.endings)
        fputs(":", out);
    if (*w.endings)
        fprintf(out, "%s_limner_files '%s'", *w.words ? "; " : "", w.endings);
    fputs(" ;;\n", out);
    value_words_free(&w);
}

static void write_list(FILE *out, const char *name, value_kind kind)
{
    value_words w = value_words_of(kind, NULL);
    fprintf(out, "_limner_%s='%s'\n", name, w.words);
    value_words_free(&w);
}

static void write_values(FILE *out)
{
    fputs("# The value of an option; false when there is none to be completed.\n"
          "_limner_value() {\n    case \"$1 $2\" in\n",
          out);
    for (size_t i = 0; commands[i]; i++)
        for (size_t k = 0; k < commands[i]->option_count; k++) {
            const option *o = &commands[i]->options[k];
            if (o->type == OPTION_FLAG)
                continue;
            fprintf(out, "    '%s --%s'", commands[i]->name, o->name);
            if (o->short_name)
                fprintf(out, " | '%s -%c'", commands[i]->name, o->short_name);
            fputs(") ", out);
            write_action(out, option_value_kind(commands[i], o), o);
        }
    fputs("    *) return 1 ;;\n    esac\n}\n\n", out);
}

void write_bash(FILE *out)
{
    fputs(functions, out);
    fputs("_limner_commands='", out);
    for (size_t i = 0; commands[i]; i++)
        fprintf(out, "%s%s", i ? " " : "", commands[i]->name);
    fputs("'\n", out);
    write_list(out, "looks", VALUE_LOOK);
    write_list(out, "settings", VALUE_SETTING);
    fputs("\n_limner_options() {\n    case $1 in\n", out);
    for (size_t i = 0; commands[i]; i++) {
        fprintf(out, "    %s) echo '--help", commands[i]->name);
        for (size_t k = 0; k < commands[i]->option_count; k++)
            fprintf(out, " --%s", commands[i]->options[k].name);
        fputs("' ;;\n", out);
    }
    fputs("    esac\n}\n\n", out);
    write_values(out);
    fputs("_limner_input() {\n    case $1 in\n", out);
    for (size_t i = 0; commands[i]; i++) {
        fprintf(out, "    %s) ", commands[i]->name);
        write_action(out, input_value_kind(commands[i]), NULL);
    }
    fputs("    esac\n}\n\n", out);
    fputs(entry, out);
}
