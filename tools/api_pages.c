/* docs/api, from the headers: one page for each, with its functions, what they do, and what holds for them.
 *
 * Usage: api_pages INCLUDE FOLDER [--check]     --check: only tells whether the pages are what the headers say.
 *
 * A comment belongs to what follows it without an empty line between; so several functions can share one. A header's
 * first comment holds for all of it, and that of limner.h for everything. Functions without a comment, and functions
 * that can fail of which nobody says how, are mistakes. */
#include <ctype.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_MOST = 1 << 20, HEADERS_MOST = 64 };

/* What is written so far of a page. */
typedef struct page {
    char   text[TEXT_MOST];
    size_t length;
} page;

typedef struct header {
    char name[64]; /* "scene.h" */
    char text[TEXT_MOST];
} header;

/* A piece of a header between empty lines: a comment, and what it stands before. */
typedef struct block {
    const char *comment, *comment_end; /* NULL: none */
    const char *code, *end;
} block;

static int mistakes;

static void complain(const char *format, ...) __attribute__((format(printf, 1, 2)));
static void complain(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    mistakes++;
}

static void put(page *p, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void put(page *p, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int more = vsnprintf(p->text + p->length, sizeof p->text - p->length, format, arguments);
    va_end(arguments);
    p->length += more > 0 ? (size_t)more : 0;
    if (p->length >= sizeof p->text) {
        fprintf(stderr, "a page is too long\n");
        exit(1);
    }
}

static size_t read_all(const char *path, char *out)
{
    FILE *file = fopen(path, "rb");
    out[0] = 0;
    if (!file)
        return 0;
    size_t length = fread(out, 1, TEXT_MOST - 1, file);
    out[length] = 0;
    fclose(file);
    return length;
}

/* --- comments ------------------------------------------------------------------------------------------- */

/* Words of a comment, without stars and line breaks; an empty line stays one. */
static void comment_words(char *out, size_t size, const char *at, const char *end)
{
    size_t length = 0;
    int    breaks = 0;
    while (at < end && length + 3 < size) {
        if (*at == '\n') {
            breaks++;
            for (at++; at < end && (*at == ' ' || *at == '*'); at++)
                ;
            continue;
        }
        if (breaks)
            length += (size_t)snprintf(out + length, size - length, "%s", breaks > 1 ? "\n\n" : " ");
        breaks = 0;
        out[length++] = *at++;
    }
    while (length && isspace((unsigned char)out[length - 1]))
        length--;
    out[length] = 0;
}

/* Markdown takes some characters for itself. */
static void put_prose(page *p, const char *text)
{
    static const char *const topics[] = {"Errors:", "Ownership:", "NULL:", "Units:", "Threads:", "Since:", NULL};
    const char              *start = text;
    for (bool quoted = false; *text; text++) {
        int t = 0;
        while (topics[t] && (strncmp(text, topics[t], strlen(topics[t])) != 0 ||
                             (text > start && text[-1] != ' ' && text[-1] != '\n')))
            t++;
        if (topics[t] && !quoted) {
            while (p->length && p->text[p->length - 1] == ' ')
                p->length--;
            put(p, text == start || text[-1] == '\n' ? "**%s**" : "\n\n**%s**", topics[t]);
            text += strlen(topics[t]) - 1;
            continue;
        }
        quoted ^= *text == '`';
        if (!quoted && strchr("<>*_[]", *text) && !(*text == '_' && isalnum((unsigned char)text[1])))
            put(p, "\\");
        put(p, "%c", *text);
    }
}

static bool says(const char *text, const char *word)
{
    return strstr(text, word) != NULL;
}

/* --- blocks --------------------------------------------------------------------------------------------- */

static const char *line_end(const char *at)
{
    const char *end = strchr(at, '\n');
    return end ? end + 1 : at + strlen(at);
}

/* The comment at this position, with its sign left away; NULL: there is none. */
static const char *skip_comment(const char *at, block *b)
{
    if (strncmp(at, "/* ", 3) != 0)
        return NULL;
    const char *end = strstr(at, "*/");
    if (!end)
        return NULL;
    b->comment = at + 3;
    b->comment_end = end;
    return line_end(end);
}

static bool is_ruler(const block *b)
{
    return b->comment && strncmp(b->comment, "---", 3) == 0;
}

/* The next block behind `at`; false at the end of what is declared. */
static bool next_block(const char **at, block *b)
{
    *b = (block){NULL, NULL, NULL, NULL};
    while (**at == '\n')
        ++*at;
    if (!**at || strncmp(*at, "#ifdef __cplusplus\n}", 20) == 0)
        return false;
    const char *behind = skip_comment(*at, b);
    b->code = behind ? behind : *at;
    const char *end = b->code;
    int         depth = 0;
    while (*end && !(*end == '\n' && depth == 0)) {
        const char *next = line_end(end);
        for (const char *c = end; c < next; c++)
            depth += (*c == '{') - (*c == '}');
        end = next;
    }
    b->end = end;
    *at = end;
    return true;
}

/* --- declarations --------------------------------------------------------------------------------------- */

/* The function that is declared at this position: its name and where the declaration ends. */
static const char *function_at(const char *at, char *name, size_t size)
{
    const char *end = strchr(at, ';'), *open = strchr(at, '(');
    const char *start = open;
    while (start > at && (isalnum((unsigned char)start[-1]) || start[-1] == '_'))
        start--;
    snprintf(name, size, "%.*s", (int)(open - start), start);
    return end ? line_end(end) : at + strlen(at);
}

static bool can_fail(const char *at)
{
    return strncmp(at, "LMN_API lmn_status ", 19) == 0 && strncmp(at + 19, "lmn_status_", 11) != 0;
}

/* Inline functions are shown by what they take. */
static bool is_inline(const block *b)
{
    return strncmp(b->code, "static inline ", 14) == 0;
}

static void put_code(page *p, const block *b)
{
    put(p, "```c\n");
    if (is_inline(b)) {
        const char *body = strstr(b->code, "\n{");
        put(p, "%.*s;\n", (int)((body && body < b->end ? body : b->end) - b->code), b->code);
    } else {
        for (const char *at = b->code, *next; at < b->end; at = next) {
            next = line_end(at);
            if (strncmp(at, "#define ", 8) == 0 && next[-2] == '\\') { /* values are in the comments */
                put(p, "#define %.*s {…}\n", (int)strcspn(at + 8, " "), at + 8);
                while (next < b->end && next[-2] == '\\')
                    next = line_end(next);
                continue;
            }
            bool of_function = strncmp(b->code, "LMN_API ", 8) == 0;
            if (of_function && (strncmp(at, "LMN_API ", 8) == 0 || strncmp(at, "        ", 8) == 0))
                at += 8;
            put(p, "%.*s", (int)(next - at), at);
        }
    }
    put(p, "```\n\n");
}

/* Headings name what the block declares. */
static bool put_heading(page *p, const block *b, const header *h, const char *words, const char *all)
{
    bool any = false;
    for (const char *at = b->code, *next; at < b->end; at = next) {
        char name[128];
        next = line_end(at);
        if (strncmp(at, "LMN_API ", 8) != 0)
            continue;
        next = function_at(at, name, sizeof name);
        put(p, any ? ", `%s`" : "### `%s`", name);
        any = true;
        if (!words[0])
            complain("%s: %s has no comment", h->name, name);
        if (can_fail(at) && !says(words, "Errors:") && !says(words, "LMN_") && !says(all, "Errors:") &&
            !says(all, "Every function can fail"))
            complain("%s: nothing says how %s can fail", h->name, name);
    }
    if (any)
        put(p, "\n\n");
    return any;
}

/* The name of a type, where the block declares one. */
static void put_type_heading(page *p, const block *b)
{
    char        name[128];
    const char *at = b->code;
    if (strncmp(at, "typedef ", 8) != 0)
        return;
    const char *end = b->end;
    const char *macro = strstr(at, "\n#define");
    if (macro && macro < end)
        end = macro;
    const char *pointer = strstr(at, "(*");
    if (pointer && pointer < end && !memchr(at, '{', (size_t)(pointer - at))) {
        const char *close = strchr(pointer, ')');
        snprintf(name, sizeof name, "%.*s", (int)(close - pointer - 2), pointer + 2);
    } else {
        while (end > at && end[-1] != ';')
            end--;
        const char *last = end - 1, *start = last;
        while (start > at && (isalnum((unsigned char)start[-1]) || start[-1] == '_'))
            start--;
        snprintf(name, sizeof name, "%.*s", (int)(last - start), start);
    }
    put(p, "### `%s`\n\n", name);
}

/* --- pages ---------------------------------------------------------------------------------------------- */

static void put_ruler(page *p, const block *b)
{
    char words[4096];
    comment_words(words, sizeof words, b->comment, b->comment_end);
    char *start = words + strspn(words, "- "), *end = start + strlen(start);
    while (end > start && (end[-1] == '-' || end[-1] == ' ' || end[-1] == '\n'))
        *--end = 0;
    char *stop = strstr(start, ". ");
    if (stop)
        *stop = 0;
    put(p, "## %c%s\n\n", toupper((unsigned char)start[0]), start + 1);
    if (stop) {
        put_prose(p, stop + 2);
        put(p, "\n\n");
    }
}

static void put_block(page *p, const block *b, const header *h, const char *all)
{
    static char words[1 << 16];
    words[0] = 0;
    if (b->comment)
        comment_words(words, sizeof words, b->comment, b->comment_end);
    if (is_ruler(b)) {
        put_ruler(p, b);
    } else if (b->code == b->end || b->code[0] == '#' || strncmp(b->code, "extern ", 7) == 0) {
        if (b->code[0] == '#' && strncmp(b->code, "#define LMN_VERSION", 19) == 0)
            put_code(p, b);
        return;
    } else {
        if (!put_heading(p, b, h, words, all))
            put_type_heading(p, b);
        if (words[0]) {
            put_prose(p, words);
            put(p, "\n\n");
        }
        put_code(p, b);
        return;
    }
    if (b->code < b->end) { /* functions may follow a ruler at once */
        block rest = {NULL, NULL, b->code, b->end};
        put_block(p, &rest, h, all);
    }
}

/* What stands before all of a header. */
static void first_comment(const header *h, char *out, size_t size)
{
    block b = {NULL, NULL, NULL, NULL};
    out[0] = 0;
    if (skip_comment(h->text, &b))
        comment_words(out, size, b.comment, b.comment_end);
    else
        complain("%s does not begin with a comment", h->name);
}

static void make_page(page *p, const header *h)
{
    static char all[1 << 16];
    const char *at = strstr(h->text, "extern \"C\" {\n#endif\n");
    block       b;
    first_comment(h, all, sizeof all);
    p->length = 0;
    put(p, "<!-- Made by tools/api_pages.c from include/limner/%s. -->\n# limner/%s\n\n", h->name, h->name);
    put_prose(p, all);
    put(p, "\n\nWhat holds for all headers: [README.md](README.md).\n\n");
    for (at = at ? at + 20 : ""; next_block(&at, &b);)
        put_block(p, &b, h, all);
    while (p->length && p->text[p->length - 1] == '\n')
        p->length--;
    p->text[p->length] = 0;
    put(p, "\n");
}

/* Names of all functions of a header, for the list. */
static void put_names(page *p, const header *h)
{
    bool any = false;
    for (const char *at = h->text; (at = strstr(at, "\nLMN_API ")) != NULL; at++) {
        char name[128];
        function_at(at + 1, name, sizeof name);
        put(p, "%s`%s`", any ? ", " : "", name);
        any = true;
    }
}

static void make_index(page *p, header *const *headers, int count)
{
    static char all[1 << 16];
    p->length = 0;
    put(p, "<!-- Made by tools/api_pages.c from include/limner. -->\n# The interface\n\n");
    for (int i = 0; i < count; i++)
        if (strcmp(headers[i]->name, "limner.h") == 0) {
            first_comment(headers[i], all, sizeof all);
            put_prose(p, all);
        }
    put(p, "\n\n| header | functions |\n|---|---|\n");
    for (int i = 0; i < count; i++) {
        if (strcmp(headers[i]->name, "limner.h") == 0)
            continue;
        put(p, "| [%s](%.*s.md) | ", headers[i]->name, (int)strcspn(headers[i]->name, "."), headers[i]->name);
        put_names(p, headers[i]);
        put(p, " |\n");
    }
    put(p, "\nFor C++ there is [limner.hpp](../../include/limner/limner.hpp); "
           "[EMBEDDING.md](../EMBEDDING.md) shows programs in C, C++ and Python.\n");
}

/* --- files ---------------------------------------------------------------------------------------------- */

static void keep(const page *p, const char *folder, const char *name, bool check)
{
    static char old[TEXT_MOST];
    char        path[1024];
    snprintf(path, sizeof path, "%s/%.*s.md", folder, (int)strcspn(name, "."), name);
    read_all(path, old);
    if (strcmp(old, p->text) == 0)
        return;
    if (check) {
        complain("%s is not what the headers say; make it anew: cmake --build --preset dev --target api_pages", path);
        return;
    }
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(p->text, 1, p->length, file) != p->length)
        complain("%s cannot be written", path);
    if (file)
        fclose(file);
}

/* All headers that limner.h includes, in its order, and itself. */
static int read_headers(header **headers, const char *folder)
{
    char        path[1024];
    int         count = 1;
    header     *top = headers[0] = calloc(1, sizeof *top);
    const char *at;
    snprintf(path, sizeof path, "%s/limner.h", folder);
    if (!top || !read_all(path, top->text))
        return 0;
    snprintf(top->name, sizeof top->name, "limner.h");
    for (at = top->text; (at = strstr(at, "#include \"limner/")) != NULL && count < HEADERS_MOST; count++) {
        header *h = headers[count] = calloc(1, sizeof *h);
        at += 17;
        if (!h)
            return 0;
        snprintf(h->name, sizeof h->name, "%.*s", (int)strcspn(at, "\""), at);
        snprintf(path, sizeof path, "%s/%s", folder, h->name);
        if (!read_all(path, h->text))
            complain("%s cannot be read", path);
    }
    return count;
}

int main(int count, char **arguments)
{
    static page p;
    header     *headers[HEADERS_MOST] = {NULL};
    bool        check = count == 4 && strcmp(arguments[3], "--check") == 0;
    if (count < 3 || (count == 4 && !check) || count > 4) {
        fprintf(stderr, "usage: api_pages INCLUDE FOLDER [--check]\n");
        return 1;
    }
    int n = read_headers(headers, arguments[1]);
    if (n < 2) {
        fprintf(stderr, "%s/limner.h has nothing\n", arguments[1]);
        return 1;
    }
    for (int i = 1; i < n; i++) {
        make_page(&p, headers[i]);
        keep(&p, arguments[2], headers[i]->name, check);
    }
    make_index(&p, headers, n);
    keep(&p, arguments[2], "README.md", check);
    for (int i = 0; i < n; i++)
        free(headers[i]);
    return mistakes != 0;
}
