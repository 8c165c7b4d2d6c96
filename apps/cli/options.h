/* Command lines: each command declares its options as a table; parsing, checking and the usage text follow from it. */
#ifndef LIMNER_CLI_OPTIONS_H
#define LIMNER_CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

typedef enum option_type {
    OPTION_FLAG,   /* bool */
    OPTION_TEXT,   /* const char *, NULL when not given */
    OPTION_LIST,   /* word_list; may be given several times */
    OPTION_NUMBER, /* option_number, min … max */
    OPTION_WHOLE,  /* the same without fraction */
    OPTION_VECTOR, /* option_vector: X,Y,Z */
    OPTION_SIZE,   /* option_size: WxH, each min … max */
    OPTION_CHOICE  /* int: index into choices, −1 when not given */
} option_type;

typedef struct word_list {
    const char **items; /* allocated; the words are the command line's own */
    size_t       count;
} word_list;

typedef struct option_number {
    bool   given;
    double value;
} option_number;

typedef struct option_vector {
    bool   given;
    double value[3];
} option_vector;

typedef struct option_size {
    bool given;
    int  width, height;
} option_size;

typedef struct option {
    const char        *name;       /* without the dashes */
    char               short_name; /* 0: none */
    option_type        type;
    size_t             offset;   /* of the value in the command's values */
    const char        *argument; /* what stands for the value in the usage text */
    const char        *doc;
    double             min, max;
    const char *const *choices;                /* NULL-terminated */
    const char        *unit;                   /* that may stand behind a number; NULL: none */
    void (*write_doc)(char *out, size_t size); /* instead of `doc`, where it lists what the library knows; NULL: none */
} option;

typedef struct command {
    const char   *name, *inputs; /* inputs: how the usage text calls them; NULL: takes none */
    const char   *summary;       /* one line */
    const char   *detail;        /* more lines for --help; NULL: none */
    const option *options;
    size_t        option_count, values_size;
    size_t        inputs_min, inputs_max;
    int (*run)(const word_list *inputs, const void *values);
} command;

#define OPTION_COUNT(array) (sizeof(array) / sizeof *(array))

/* Parses what stands behind the command's name. `values` (values_size bytes) is filled. Mistakes are printed.
 * Returns an exit status, 0 when all is well; `*help` says that --help was among the arguments. */
int options_parse(const command *c, int count, char **arguments, void *values, word_list *inputs, bool *help);

/* Frees the lists inside values and inputs. */
void options_release(const command *c, void *values, word_list *inputs);

/* Prints the command line that gives these values, quoted for a shell: the command's name, its options but those in
 * `left_out` (NULL-terminated), and the inputs. */
void options_print_line(const command *c, const word_list *inputs, const void *values, const char *const *left_out);

/* Prints the command's usage to standard output. */
void options_print_usage(const command *c);

/* The candidate nearest to `name`, or NULL when none is near. `candidate(i)` gives NULL at the end. */
const char *options_nearest(const char *name, const char *(*candidate)(size_t index, const void *user),
                            const void *user);

/* Adds a word; false when memory is gone. */
bool word_list_add(word_list *list, const char *word);
void word_list_release(word_list *list);

#endif
