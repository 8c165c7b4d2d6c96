/* Manual pages and completions of the command, made from the tables that it parses its arguments with. */
#ifndef LIMNER_PAGES_H
#define LIMNER_PAGES_H

#include <stdio.h>

#include "cli.h"

/* What can stand for an argument. */
typedef enum value_kind {
    VALUE_PLAIN, /* nothing that a shell could know */
    VALUE_FILE,  /* any file */
    VALUE_FOLDER,
    VALUE_MODEL,   /* files of formats that are read */
    VALUE_LOOK,    /* the looks that ship, and files of JSON */
    VALUE_SETTING, /* KIND.PARAM=VALUE */
    VALUE_FORMAT,  /* what drawings and films are written as */
    VALUE_TEXTURE, /* what textures of strokes are written as */
    VALUE_PATTERN, /* patterns of strokes, and files of them */
    VALUE_CHOICE   /* one of the option's own */
} value_kind;

/* Words to choose from, and endings of files that do as well; each separated by blanks and allocated. */
typedef struct value_words {
    char *words, *endings;
} value_words;

value_kind option_value_kind(const command *c, const option *o);
value_kind input_value_kind(const command *c);

/* The words of a kind; `o` is for VALUE_CHOICE. Ends the program when there is no memory. */
value_words value_words_of(value_kind kind, const option *o);
void        value_words_free(value_words *w);

/* The first sentence of an option's text, without its full stop. */
void option_brief(const option *o, char *out, size_t size);
/* All of the text. */
void option_text(const option *o, char *out, size_t size);

/* One page or script each. */
void write_manual(FILE *out, const char *date);
void write_command_manual(FILE *out, const command *c, const char *date);
void write_look_manual(FILE *out, const char *date);
void write_bash(FILE *out);
void write_zsh(FILE *out);
void write_fish(FILE *out);

/* Text of a manual page: what troff would take for its own is escaped. */
void write_roff(FILE *out, const char *text);
/* The first line of a page: its name in capitals and its section. */
void write_title(FILE *out, const char *name, int section, const char *date);

#endif
