#include "options.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "message.h"

enum { COMPARED_MAX = 63, COLUMN = 26 };

typedef struct parser {
    const command *command;
    char         **arguments;
    int            count, next;
    void          *values;
    word_list     *inputs;
    bool          *given; /* by option */
    bool           help;
} parser;

bool word_list_add(word_list *list, const char *word)
{
    const char **grown = realloc((void *)list->items, (list->count + 1) * sizeof *grown);
    if (!grown)
        return false;
    list->items = grown;
    list->items[list->count++] = word;
    return true;
}

void word_list_release(word_list *list)
{
    free((void *)list->items);
    *list = (word_list){0};
}

static size_t distance_of(const char *a, const char *b)
{
    size_t row[COMPARED_MAX + 1], a_size = strlen(a), b_size = strlen(b);
    if (a_size > COMPARED_MAX || b_size > COMPARED_MAX)
        return COMPARED_MAX;
    for (size_t j = 0; j <= b_size; j++)
        row[j] = j;
    for (size_t i = 1; i <= a_size; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b_size; j++) {
            size_t best = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            if (row[j] + 1 < best)
                best = row[j] + 1;
            if (row[j - 1] + 1 < best)
                best = row[j - 1] + 1;
            row[j] = best;
        }
    }
    return row[b_size];
}

const char *options_nearest(const char *name, const char *(*candidate)(size_t index, const void *user),
                            const void *user)
{
    const char *best = NULL, *word;
    size_t      best_distance = strlen(name) / 3 + 2;
    for (size_t i = 0; (word = candidate(i, user)); i++) {
        size_t distance = distance_of(name, word);
        if (distance < best_distance && distance < strlen(word)) {
            best_distance = distance;
            best = word;
        }
    }
    return best;
}

static const char *option_name_at(size_t index, const void *user)
{
    const command *c = user;
    return index < c->option_count ? c->options[index].name : index == c->option_count ? "help" : NULL;
}

static const option *find_option(const command *c, const char *name, size_t length)
{
    for (size_t i = 0; i < c->option_count; i++)
        if (strlen(c->options[i].name) == length && strncmp(c->options[i].name, name, length) == 0)
            return &c->options[i];
    return NULL;
}

static const option *find_short(const command *c, char name)
{
    for (size_t i = 0; i < c->option_count; i++)
        if (c->options[i].short_name == name)
            return &c->options[i];
    return NULL;
}

static int wrong_value(const option *o, const char *value, const char *allowed)
{
    return message_usage(NULL, "--%s is '%s'; allowed is %s", o->name, value, allowed);
}

/* One number at the start of the text; the end of it, or NULL. strtod takes the C locale's point, since the command
 * never sets another; hexadecimal numbers, inf and nan are refused. */
static const char *parse_number(const char *text, double *out)
{
    char  *end;
    size_t length = strspn(text, "+-0123456789.eE");
    if (length == 0 || text[length] == 'x')
        return NULL;
    *out = strtod(text, &end);
    return end == text || !isfinite(*out) ? NULL : end;
}

static int set_number(const option *o, const char *value, option_number *out)
{
    char        allowed[96];
    const char *end = parse_number(value, &out->value);
    if (end && o->unit && strcmp(end, o->unit) == 0)
        end += strlen(end);
    if (end && *end == '\0' && out->value >= o->min && out->value <= o->max &&
        (o->type == OPTION_NUMBER || out->value == floor(out->value))) {
        out->given = true;
        return 0;
    }
    snprintf(allowed, sizeof allowed, "a %snumber from %.10g to %.10g%s%s", o->type == OPTION_WHOLE ? "whole " : "",
             o->min, o->max, o->unit ? " " : "", o->unit ? o->unit : "");
    return wrong_value(o, value, allowed);
}

static int set_vector(const option *o, const char *value, option_vector *out)
{
    const char *at = value;
    for (int i = 0; i < 3 && at; i++) {
        at = parse_number(at, &out->value[i]);
        if (at && i < 2)
            at = *at == ',' ? at + 1 : NULL;
    }
    if (!at || *at)
        return wrong_value(o, value, "three numbers X,Y,Z");
    out->given = true;
    return 0;
}

static int set_size(const option *o, const char *value, option_size *out)
{
    char allowed[96], *end = NULL;
    errno = 0;
    long width = isdigit((unsigned char)*value) ? strtol(value, &end, 10) : 0, height = 0;
    if (end && *end == 'x' && isdigit((unsigned char)end[1]))
        height = strtol(end + 1, &end, 10);
    if (errno || !end || *end || (double)width < o->min || (double)width > o->max || (double)height < o->min ||
        (double)height > o->max) {
        snprintf(allowed, sizeof allowed, "WxH, each from %.0f to %.0f, for example 1024x768", o->min, o->max);
        return wrong_value(o, value, allowed);
    }
    *out = (option_size){true, (int)width, (int)height};
    return 0;
}

static int set_choice(const option *o, const char *value, int *out)
{
    char allowed[160] = "one of";
    for (int i = 0; o->choices[i]; i++) {
        size_t length = strlen(allowed);
        if (strcmp(o->choices[i], value) == 0) {
            *out = i;
            return 0;
        }
        snprintf(allowed + length, sizeof allowed - length, "%s %s", i ? "," : "", o->choices[i]);
    }
    return wrong_value(o, value, allowed);
}

/* Of two values one would be dropped in silence. */
static int check_once(const parser *p, const option *o)
{
    size_t index = (size_t)(o - p->command->options);
    if (p->given[index] && o->type != OPTION_LIST && o->type != OPTION_FLAG)
        return message_usage(NULL, "--%s is given twice; it holds one value", o->name);
    p->given[index] = true;
    return 0;
}

static int set_option(const parser *p, const option *o, const char *value)
{
    void *field = (char *)p->values + o->offset;
    int   status = check_once(p, o);
    if (status)
        return status;
    switch (o->type) {
    case OPTION_FLAG: *(bool *)field = true; return 0;
    case OPTION_TEXT:
        if (!*value)
            return wrong_value(o, value, "anything but nothing");
        *(const char **)field = value;
        return 0;
    case OPTION_LIST: return word_list_add(field, value) ? 0 : message_out_of_memory();
    case OPTION_NUMBER:
    case OPTION_WHOLE: return set_number(o, value, field);
    case OPTION_VECTOR: return set_vector(o, value, field);
    case OPTION_SIZE: return set_size(o, value, field);
    case OPTION_CHOICE: return set_choice(o, value, field);
    }
    return 0;
}

/* The value may begin with '-' ("-1,2,3", "-"), but what begins with "--" is the next option. */
static int take_value(parser *p, const option *o, const char *attached, const char **out)
{
    *out = attached;
    if (o->type == OPTION_FLAG)
        return attached ? message_usage(NULL, "--%s takes no value", o->name) : 0;
    if (attached)
        return 0;
    if (p->next >= p->count || (p->arguments[p->next][0] == '-' && p->arguments[p->next][1] == '-')) {
        char hint[128];
        snprintf(hint, sizeof hint, "write --%s %s", o->name, o->argument);
        return message_usage(hint, "--%s needs a value", o->name);
    }
    *out = p->arguments[p->next++];
    return 0;
}

static int unknown_option(const parser *p, const char *argument, size_t length)
{
    char name[COMPARED_MAX + 1], hint[128];
    snprintf(name, sizeof name, "%.*s", (int)length, argument + strspn(argument, "-"));
    const char *near = options_nearest(name, option_name_at, p->command);
    if (near)
        snprintf(hint, sizeof hint, "did you mean '--%s'?", near);
    else
        snprintf(hint, sizeof hint, "`limner %s --help` lists all options", p->command->name);
    return message_usage(hint, "unknown option '%.80s'", argument);
}

static int parse_long(parser *p, const char *argument)
{
    const char *name = argument + 2, *equals = strchr(name, '=');
    size_t      length = equals ? (size_t)(equals - name) : strlen(name);
    if (strcmp(name, "help") == 0) {
        p->help = true;
        return 0;
    }
    const option *o = find_option(p->command, name, length);
    if (!o)
        return unknown_option(p, argument, length);
    const char *value;
    int         status = take_value(p, o, equals ? equals + 1 : NULL, &value);
    return status ? status : set_option(p, o, value);
}

static int parse_short(parser *p, const char *argument)
{
    if (strcmp(argument, "-h") == 0) {
        p->help = true;
        return 0;
    }
    const option *o = find_short(p->command, argument[1]);
    if (!o)
        return unknown_option(p, argument, strlen(argument));
    const char *value;
    int         status = take_value(p, o, argument[2] ? argument + 2 : NULL, &value);
    return status ? status : set_option(p, o, value);
}

static int parse_all(parser *p)
{
    int  status = 0;
    bool only_inputs = false;
    while (p->next < p->count && status == 0) {
        const char *argument = p->arguments[p->next++];
        if (!only_inputs && strcmp(argument, "--") == 0)
            only_inputs = true;
        else if (!only_inputs && strncmp(argument, "--", 2) == 0)
            status = parse_long(p, argument);
        else if (!only_inputs && argument[0] == '-' && argument[1])
            status = parse_short(p, argument);
        else if (!word_list_add(p->inputs, argument))
            status = message_out_of_memory();
    }
    return status;
}

int options_parse(const command *c, int count, char **arguments, void *values, word_list *inputs, bool *help)
{
    parser p = {.command = c,
                .arguments = arguments,
                .count = count,
                .values = values,
                .inputs = inputs,
                .given = calloc(c->option_count + 1, sizeof *p.given)};
    if (!p.given)
        return message_out_of_memory();
    for (size_t i = 0; i < c->option_count; i++)
        if (c->options[i].type == OPTION_CHOICE)
            *(int *)((char *)values + c->options[i].offset) = -1;
    int status = parse_all(&p);
    free(p.given);
    *help = p.help;
    if (status || p.help)
        return p.help ? 0 : status;
    char hint[96];
    snprintf(hint, sizeof hint, "`limner %s --help` shows how it is used", c->name);
    if (inputs->count < c->inputs_min)
        return message_usage(hint, "no %.*s is given", (int)strcspn(c->inputs, "\xE2"), c->inputs); /* without the … */
    if (inputs->count > c->inputs_max)
        return message_usage(hint, "'%.80s' is one argument too many", inputs->items[c->inputs_max]);
    return 0;
}

void options_release(const command *c, void *values, word_list *inputs)
{
    for (size_t i = 0; i < c->option_count; i++)
        if (c->options[i].type == OPTION_LIST)
            word_list_release((void *)((char *)values + c->options[i].offset));
    word_list_release(inputs);
}

/* --- back to a command line ------------------------------------------------------------------------------- */

static void print_quoted(const char *word)
{
    const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./:,=@%";
    if (*word && word[strspn(word, plain)] == '\0') {
        fputs(word, stdout);
        return;
    }
    putchar('\'');
    for (; *word; word++)
        if (*word == '\'')
            fputs("'\\''", stdout);
        else
            putchar(*word);
    putchar('\'');
}

static void print_given(const char *name, const char *value)
{
    printf(" --%s", name);
    if (value) {
        putchar(' ');
        print_quoted(value);
    }
}

static void print_value(const option *o, const void *at)
{
    char                 text[128];
    const option_number *number = at;
    const option_vector *vector = at;
    const option_size   *size = at;
    const word_list     *list = at;
    switch (o->type) {
    case OPTION_FLAG:
        if (*(const bool *)at)
            print_given(o->name, NULL);
        break;
    case OPTION_TEXT:
        if (*(const char *const *)at)
            print_given(o->name, *(const char *const *)at);
        break;
    case OPTION_LIST:
        for (size_t i = 0; i < list->count; i++)
            print_given(o->name, list->items[i]);
        break;
    case OPTION_NUMBER:
    case OPTION_WHOLE:
        snprintf(text, sizeof text, "%.17g", number->value);
        if (number->given)
            print_given(o->name, text);
        break;
    case OPTION_VECTOR:
        snprintf(text, sizeof text, "%.17g,%.17g,%.17g", vector->value[0], vector->value[1], vector->value[2]);
        if (vector->given)
            print_given(o->name, text);
        break;
    case OPTION_SIZE:
        snprintf(text, sizeof text, "%dx%d", size->width, size->height);
        if (size->given)
            print_given(o->name, text);
        break;
    case OPTION_CHOICE:
        if (*(const int *)at >= 0)
            print_given(o->name, o->choices[*(const int *)at]);
        break;
    }
}

void options_print_line(const command *c, const word_list *inputs, const void *values, const char *const *left_out)
{
    printf("%s", c->name);
    for (size_t i = 0; i < c->option_count; i++) {
        bool wanted = true;
        for (const char *const *name = left_out; *name; name++)
            wanted = wanted && strcmp(*name, c->options[i].name) != 0;
        if (wanted)
            print_value(&c->options[i], (const char *)values + c->options[i].offset);
    }
    for (size_t i = 0; i < inputs->count; i++) {
        putchar(' ');
        if (inputs->items[i][0] == '-') /* else taken for an option */
            fputs("./", stdout);
        print_quoted(inputs->items[i]);
    }
}

/* Text behind the option's column, broken at blanks. */
static void print_doc(const char *doc)
{
    enum { WIDTH = 72 };
    for (const char *at = doc; *at;) {
        size_t length = strlen(at);
        if (length > WIDTH) {
            length = WIDTH;
            while (length > 1 && at[length] != ' ')
                length--;
        }
        printf("%.*s\n", (int)length, at);
        at += length + strspn(at + length, " ");
        if (*at)
            printf("%*s", COLUMN, "");
    }
}

static void print_option(const option *o)
{
    char left[80], shown[16] = "    ";
    if (o->short_name)
        snprintf(shown, sizeof shown, "-%c, ", o->short_name);
    snprintf(left, sizeof left, "  %s--%s%s%s", shown, o->name, o->argument ? " " : "", o->argument ? o->argument : "");
    if (strlen(left) + 2 > COLUMN)
        printf("%s\n%*s", left, COLUMN, "");
    else
        printf("%-*s", COLUMN, left);
    char written[2048];
    if (o->write_doc)
        o->write_doc(written, sizeof written);
    print_doc(o->write_doc ? written : o->doc);
}

void options_print_usage(const command *c)
{
    printf("usage: limner %s%s%s%s\n\n%s\n", c->name, c->inputs ? " " : "", c->inputs ? c->inputs : "",
           c->option_count ? " [OPTION]…" : "", c->summary);
    if (c->detail)
        printf("\n%s\n", c->detail);
    printf("\noptions:\n");
    for (size_t i = 0; i < c->option_count; i++)
        print_option(&c->options[i]);
    printf("%-*sPrint this text.\n", COLUMN, "  -h, --help");
}
