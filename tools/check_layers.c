/* check_layers ROOT: holds the sources against the rules of docs/ARCHITECTURE.md. Reads the table of modules there,
 * then all C and C++ files below src/, apps/, include/, tools/ and tests/. Prints FILE:LINE: what is wrong; exits 1
 * when anything is. */
#include <ctype.h>
#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum {
    NAME_SIZE = 64,
    PATH_SIZE = 1024,
    MODULES_MAX = 64,
    FILE_LINES_MAX = 1000,
    TEST_LINES_MAX = 1200,
    FUNCTION_LINES_MAX = 80
};

typedef struct module {
    char name[NAME_SIZE];
    int  level; /* a module uses only modules of lower levels */
} module;

typedef struct checker {
    module modules[MODULES_MAX];
    size_t module_count, files;
    int    mistakes;
} checker;

/* One file being checked. */
typedef struct source {
    checker    *all;
    const char *path;                               /* below the root: "src/look/look.c" */
    char        area[NAME_SIZE], module[NAME_SIZE]; /* "src", "look" */
    char       *text, *code;                        /* as it is, and with comments and literals blanked */
} source;

static void complain(source *s, int line, const char *what, const char *detail)
{
    fprintf(stderr, "%s:%d: %s%s%s\n", s->path, line, what, *detail ? ": " : "", detail);
    s->all->mistakes++;
}

static char *read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0)
        return NULL;
    long  size = ftell(file);
    char *text = size >= 0 ? malloc((size_t)size + 1) : NULL;
    rewind(file);
    if (text && fread(text, 1, (size_t)size, file) == (size_t)size) {
        text[size] = '\0';
    } else {
        free(text);
        text = NULL;
    }
    fclose(file);
    return text;
}

/* --- the table of modules ------------------------------------------------------------------------------- */

static const module *find_module(const checker *c, const char *name)
{
    for (size_t i = 0; i < c->module_count; i++)
        if (strcmp(c->modules[i].name, name) == 0)
            return &c->modules[i];
    return NULL;
}

/* A row is "| 3 | `gpu` `light` | what they do |". */
static void read_row(checker *c, const char *row)
{
    char       *names;
    long        level = strtol(row + 1, &names, 10);
    const char *end = *names ? strchr(names + 2, '|') : NULL;
    for (const char *at = names; level > 0 && end && at < end; at++) {
        if (*at != '`')
            continue;
        const char *close = strchr(at + 1, '`');
        if (!close || close > end || c->module_count == MODULES_MAX)
            return;
        module *m = &c->modules[c->module_count++];
        snprintf(m->name, sizeof m->name, "%.*s", (int)(close - at - 1), at + 1);
        m->level = (int)level;
        at = close;
    }
}

static bool read_modules(checker *c, const char *root)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/docs/ARCHITECTURE.md", root);
    char *text = read_file(path);
    for (const char *at = text; at && *at;) {
        if (*at == '|' && isdigit((unsigned char)at[1 + strspn(at + 1, " ")]))
            read_row(c, at);
        at = strchr(at, '\n');
        at = at ? at + 1 : NULL;
    }
    free(text);
    return c->module_count > 0;
}

/* --- blanking comments and literals --------------------------------------------------------------------- */

static char *blank_until(char *at, const char *end_mark)
{
    size_t length = strlen(end_mark);
    while (*at && strncmp(at, end_mark, length) != 0) {
        if (*at != '\n')
            *at = ' ';
        at++;
    }
    for (size_t i = 0; i < length && *at; i++, at++)
        if (*at != '\n')
            *at = ' ';
    return at;
}

static char *blank_literal(char *at)
{
    char quote = *at++;
    while (*at && *at != quote && *at != '\n') {
        if (*at == '\\' && at[1] && at[1] != '\n')
            *at++ = ' ';
        *at++ = ' ';
    }
    return *at == quote ? at + 1 : at;
}

static void blank(char *code)
{
    for (char *at = code; *at;) {
        if (at[0] == '/' && at[1] == '*')
            at = blank_until(at, "*/");
        else if (at[0] == '/' && at[1] == '/')
            at = blank_until(at, "\n");
        else if (*at == '"' || *at == '\'')
            at = blank_literal(at);
        else
            at++;
    }
}

/* --- the rules ------------------------------------------------------------------------------------------ */

static void check_include(source *s, int line, const char *directive)
{
    char        path[PATH_SIZE], folder[NAME_SIZE];
    const char *open = strchr(directive, '"'), *close = open ? strchr(open + 1, '"') : NULL;
    if (!close)
        return; /* a system header */
    snprintf(path, sizeof path, "%.*s", (int)(close - open - 1), open + 1);
    const char *slash = strchr(path, '/');
    if (!slash || strncmp(path, "limner/", 7) == 0)
        return; /* beside the file, or public */
    snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
    if (strcmp(s->area, "apps") == 0 || strcmp(s->area, "include") == 0)
        complain(s, line, "faces see only include/limner/", path);
    if (strcmp(s->area, "src") != 0 || strcmp(folder, s->module) == 0)
        return;
    const module *self = find_module(s->all, s->module), *used = find_module(s->all, folder);
    if (!used)
        complain(s, line, "the folder is not in docs/ARCHITECTURE.md", folder);
    else if (self && used->level >= self->level)
        complain(s, line, "includes a folder that is not below it", path);
}

static bool is_one_of(const char *word, const char *const *list)
{
    for (; *list; list++)
        if (strcmp(*list, word) == 0)
            return true;
    return false;
}

static void check_call(source *s, int line, const char *word)
{
    static const char *const never[] = {"sprintf", "strcpy", "strcat", "gets", "strtok", "atoi", "vsprintf", NULL};
    static const char *const base_only[] = {"rand", "srand", "time", NULL};
    static const char *const not_in_library[] = {"printf", "fprintf", "puts", "perror", "exit", "abort", NULL};
    bool                     library = strcmp(s->area, "src") == 0;
    if (is_one_of(word, never))
        complain(s, line, "unsafe function", word);
    if (library && strcmp(s->module, "base") != 0 && is_one_of(word, base_only))
        complain(s, line, "results must not depend on this", word);
    if (library && is_one_of(word, not_in_library))
        complain(s, line, "the library neither prints nor ends the process", word);
    if ((library || strcmp(s->area, "apps") == 0) && strcmp(s->module, "gpu") != 0 && word[0] == 'g' &&
        word[1] == 'l' && isupper((unsigned char)word[2]))
        complain(s, line, "OpenGL is called only in src/gpu", word);
}

/* Words that a '(' follows. */
static void check_calls(source *s, int line, const char *code)
{
    for (const char *at = code; *at && *at != '\n';) {
        if (!isalpha((unsigned char)*at) && *at != '_') {
            at++;
            continue;
        }
        char        word[NAME_SIZE];
        const char *start = at;
        while (isalnum((unsigned char)*at) || *at == '_')
            at++;
        snprintf(word, sizeof word, "%.*s", (int)(at - start), start);
        if (*at == '(' && (start == code || (start[-1] != '.' && start[-1] != '>')))
            check_call(s, line, word);
    }
}

/* "TO" "DO" needs an issue's number behind it: (#12). Written apart here for its own sake. */
static void check_promise(source *s, int line, const char *text)
{
    const char *end = strchr(text, '\n'), *found = strstr(text, "TO"
                                                                "DO");
    if (!found || (end && found > end))
        return;
    const char *hash = strchr(found, '#');
    if (!hash || (end && hash > end) || !isdigit((unsigned char)hash[1]))
        complain(s, line, "a promise without an issue's number (#12)", "");
}

static const char *next_line(const char *at)
{
    const char *end = strchr(at, '\n');
    return end ? end + 1 : NULL;
}

static void check_lines(source *s)
{
    int         line = 1, function_start = 0;
    const char *text = s->text;
    for (const char *code = s->code; code; code = next_line(code), line++) {
        size_t blanks = strspn(code, " \t");
        if (code[blanks] == '#' && strncmp(code + blanks + 1 + strspn(code + blanks + 1, " "), "include", 7) == 0)
            check_include(s, line, text);
        else
            check_calls(s, line, code);
        check_promise(s, line, text);
        if (strncmp(code, "{\n", 2) == 0)
            function_start = line;
        if (code[0] == '}' && function_start) {
            if (line - function_start - 1 > FUNCTION_LINES_MAX && strcmp(s->area, "tests") != 0)
                complain(s, function_start, "the function is longer than 80 lines", "");
            function_start = 0;
        }
        text = next_line(text);
    }
    int most = strcmp(s->area, "tests") == 0 ? TEST_LINES_MAX : FILE_LINES_MAX;
    if (line - 2 > most)
        complain(s, most,
                 most == TEST_LINES_MAX ? "the test is longer than 1200 lines" : "the file is longer than 1000 lines",
                 "");
}

static void check_file(checker *c, const char *root, const char *path)
{
    char   whole[PATH_SIZE * 2];
    source s = {.all = c, .path = path};
    snprintf(whole, sizeof whole, "%s/%s", root, path);
    s.text = read_file(whole);
    s.code = read_file(whole);
    const char *slash = strchr(path, '/'), *second = slash ? strchr(slash + 1, '/') : NULL;
    if (slash)
        snprintf(s.area, sizeof s.area, "%.*s", (int)(slash - path), path);
    if (second)
        snprintf(s.module, sizeof s.module, "%.*s", (int)(second - slash - 1), slash + 1);
    if (!s.text || !s.code) {
        complain(&s, 0, "cannot be read", "");
    } else {
        blank(s.code);
        if (strcmp(s.area, "src") == 0 && !find_module(c, s.module))
            complain(&s, 1, "the folder is not in docs/ARCHITECTURE.md", s.module);
        check_lines(&s);
        c->files++;
    }
    free(s.text);
    free(s.code);
}

static void check_folder(checker *c, const char *root, const char *below)
{
    char whole[PATH_SIZE * 2], path[PATH_SIZE];
    snprintf(whole, sizeof whole, "%s/%s", root, below);
    DIR *folder = opendir(whole);
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        struct stat status;
        if (entry->d_name[0] == '.')
            continue;
        int length = snprintf(path, sizeof path, "%s/%s", below, entry->d_name);
        if (length < 0 || length >= (int)sizeof path)
            continue;
        snprintf(whole, sizeof whole, "%s/%s", root, path);
        const char *dot = strrchr(entry->d_name, '.');
        if (stat(whole, &status) == 0 && S_ISDIR(status.st_mode))
            check_folder(c, root, path);
        else if (dot && (strcmp(dot, ".c") == 0 || strcmp(dot, ".h") == 0 || strcmp(dot, ".cpp") == 0))
            check_file(c, root, path);
    }
    if (folder)
        closedir(folder);
}

int main(int count, char **arguments)
{
    static const char *const areas[] = {"src", "apps", "include", "tools", "tests"};
    checker                  c = {0};
    const char              *root = count > 1 ? arguments[1] : ".";
    if (!read_modules(&c, root)) {
        fprintf(stderr, "%s/docs/ARCHITECTURE.md: the table of modules is missing\n", root);
        return 1;
    }
    for (size_t i = 0; i < sizeof areas / sizeof *areas; i++)
        check_folder(&c, root, areas[i]);
    printf("%zu files, %d mistakes\n", c.files, c.mistakes);
    return c.mistakes != 0;
}
