/* Tokens and syntax of .csg files: `word(name = value, …) { children }` or `;`, comments, modifiers. Nothing here
 * calls itself, so that nesting costs no stack. */
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "import/csg_tree.h"

typedef struct parser {
    csg_tree         *tree;
    const import_job *job;
    const char       *at, *end, *line_begin;
    int               line;
    lmn_error        *error;
} parser;

/* --- messages ------------------------------------------------------------------------------------------- */

/* Columns count bytes, as compilers do. */
static lmn_status fail_at(parser *p, lmn_status status, int line, const char *at, const char *message)
{
    error_in_file(p->error, status, p->job->path, line, "%s", message);
    if (p->error)
        p->error->column = (int)(at - p->line_begin) + 1;
    return status;
}

static lmn_status expected(parser *p, const char *what)
{
    char message[128];
    if (p->at >= p->end) {
        snprintf(message, sizeof message, "the file is cut off: expected %s", what);
    } else if ((unsigned char)*p->at > ' ' && (unsigned char)*p->at < 127) {
        snprintf(message, sizeof message, "expected %s, found '%c'", what, *p->at);
    } else {
        snprintf(message, sizeof message, "expected %s, found byte %d", what, (unsigned char)*p->at);
    }
    return fail_at(p, LMN_FORMAT, p->line, p->at, message);
}

static lmn_status too_much(parser *p, const char *what, size_t limit)
{
    return error_in_file(p->error, LMN_LIMIT, p->job->path, p->line, "%s; the limit is %zu", what, limit);
}

/* --- tokens --------------------------------------------------------------------------------------------- */

static void next_line(parser *p)
{
    p->line++;
    p->line_begin = p->at + 1;
}

/* An open comment runs to the end of the file. */
static void skip_comment(parser *p)
{
    bool block = p->at[1] == '*';
    for (p->at += 2; p->at < p->end; p->at++) {
        if (*p->at == '\n') {
            if (!block)
                return;
            next_line(p);
        } else if (block && *p->at == '*' && p->at + 1 < p->end && p->at[1] == '/') {
            p->at += 2;
            return;
        }
    }
}

static void skip_blanks(parser *p)
{
    while (p->at < p->end) {
        if (*p->at == '\n')
            next_line(p);
        if (*p->at == ' ' || *p->at == '\t' || *p->at == '\r' || *p->at == '\n')
            p->at++;
        else if (*p->at == '/' && p->at + 1 < p->end && (p->at[1] == '/' || p->at[1] == '*'))
            skip_comment(p);
        else
            return;
    }
}

static bool take(parser *p, char c)
{
    skip_blanks(p);
    if (p->at >= p->end || *p->at != c)
        return false;
    p->at++;
    return true;
}

static bool is_word_byte(char c, bool first)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$' || (!first && c >= '0' && c <= '9');
}

static size_t word_length(const parser *p)
{
    size_t length = 0;
    while (p->at + length < p->end && is_word_byte(p->at[length], length == 0))
        length++;
    return length;
}

static bool keep_bytes(csg_tree *t, const char *bytes, size_t size)
{
    if (!mem_grow((void **)&t->text, &t->text_capacity, t->text_size + size, 1))
        return false;
    memcpy(t->text + t->text_size, bytes, size);
    t->text_size += size;
    return true;
}

static lmn_status keep_word(parser *p, size_t length, size_t *out)
{
    *out = p->tree->text_size;
    if (!keep_bytes(p->tree, p->at, length) || !keep_bytes(p->tree, "", 1))
        return error_memory(p->error);
    p->at += length;
    return LMN_OK;
}

/* --- strings -------------------------------------------------------------------------------------------- */

static bool keep_code_point(csg_tree *t, uint32_t code)
{
    char bytes[4];
    if (code == 0 || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000))
        code = 0xFFFD;
    if (code < 0x80)
        return bytes[0] = (char)code, keep_bytes(t, bytes, 1);
    size_t size = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    for (size_t i = size; i-- > 1; code >>= 6)
        bytes[i] = (char)(0x80 | (code & 0x3F));
    bytes[0] = (char)((0xF00 >> size & 0xFF) | code);
    return keep_bytes(t, bytes, size);
}

/* \xHH, \uHHHH, \UHHHHHH; p->at is on the letter. */
static bool keep_number_escape(parser *p)
{
    int      digits = *p->at == 'x' ? 2 : *p->at == 'u' ? 4 : 6;
    uint32_t code = 0;
    for (int i = 1; i <= digits; i++) {
        char c = p->at + i < p->end ? p->at[i] : ' ';
        int  digit = c >= '0' && c <= '9'                     ? c - '0'
                     : (c | 0x20) >= 'a' && (c | 0x20) <= 'f' ? (c | 0x20) - 'a' + 10
                                                              : -1;
        if (digit < 0)
            return keep_bytes(p->tree, p->at - 1, 2);
        code = code * 16 + (uint32_t)digit;
    }
    p->at += digits;
    return keep_code_point(p->tree, code);
}

/* OpenSCAD 2021 writes text() without escapes, so that a backslash before anything else is itself. */
static bool keep_escape(parser *p)
{
    switch (*p->at) {
    case '"':
    case '\\': return keep_bytes(p->tree, p->at, 1);
    case 'n': return keep_bytes(p->tree, "\n", 1);
    case 't': return keep_bytes(p->tree, "\t", 1);
    case 'r': return keep_bytes(p->tree, "\r", 1);
    case 'x':
    case 'u':
    case 'U': return keep_number_escape(p);
    default: p->at--; return keep_bytes(p->tree, p->at, 1);
    }
}

/* For the same reason a quote ends a string only where one can end: before ',', ')', ']' or the end of the file. */
static bool is_closing_quote(const parser *p)
{
    if (*p->at != '"')
        return false;
    const char *next = p->at + 1;
    while (next < p->end && (*next == ' ' || *next == '\t' || *next == '\r' || *next == '\n'))
        next++;
    return next >= p->end || *next == ',' || *next == ')' || *next == ']';
}

static lmn_status parse_string(parser *p, csg_value *v)
{
    const char *opened = p->at++, *opened_line = p->line_begin;
    int         line = p->line;
    v->kind = CSG_STRING;
    v->as.string = p->tree->text_size;
    for (; p->at < p->end && !is_closing_quote(p); p->at++) {
        if (*p->at == '\n')
            next_line(p);
        bool escaped = *p->at == '\\' && p->at + 1 < p->end;
        p->at += escaped;
        if (!(escaped ? keep_escape(p) : *p->at == '\0' ? keep_bytes(p->tree, "?", 1) : keep_bytes(p->tree, p->at, 1)))
            return error_memory(p->error);
    }
    if (p->at >= p->end) {
        p->line_begin = opened_line;
        return fail_at(p, LMN_FORMAT, line, opened, "the string that begins here is never closed");
    }
    p->at++;
    size_t size = p->tree->text_size - v->as.string;
    if (size > UINT32_MAX)
        return too_much(p, "a string is too long", UINT32_MAX);
    v->count = (uint32_t)size;
    return keep_bytes(p->tree, "", 1) ? LMN_OK : error_memory(p->error);
}

/* --- values --------------------------------------------------------------------------------------------- */

static bool is_word(const parser *p, size_t length, const char *word)
{
    return strlen(word) == length && memcmp(p->at, word, length) == 0;
}

static lmn_status parse_plain(parser *p, csg_value *v)
{
    if (p->at < p->end && *p->at == '"')
        return parse_string(p, v);
    size_t length = word_length(p);
    bool   truth = is_word(p, length, "true");
    if (truth || is_word(p, length, "false")) {
        v->kind = CSG_BOOL;
        v->as.truth = truth;
        p->at += length;
        return LMN_OK;
    }
    if (is_word(p, length, "undef")) {
        p->at += length;
        return LMN_OK;
    }
    const char *from = p->at + (p->at < p->end && *p->at == '+');
    const char *behind = text_parse_double(from, p->end, &v->as.number);
    if (!behind || (behind < p->end && is_word_byte(*behind, false)))
        return expected(p, "a value");
    v->kind = CSG_NUMBER;
    p->at = behind;
    return LMN_OK;
}

static lmn_status append_value(parser *p, int32_t *index)
{
    csg_tree *t = p->tree;
    if (t->value_count >= LIMIT_CSG_VALUES)
        return too_much(p, "too many numbers and other values", LIMIT_CSG_VALUES);
    if (!mem_grow((void **)&t->values, &t->value_capacity, t->value_count + 1, sizeof *t->values))
        return error_memory(p->error);
    *index = (int32_t)t->value_count++;
    t->values[*index] = (csg_value){.kind = CSG_UNDEF};
    return LMN_OK;
}

/* Closes vectors as long as there are brackets to; then *more tells whether another element follows. */
static lmn_status close_vectors(parser *p, const int32_t *open, int *depth, bool *more)
{
    *more = false;
    while (*depth > 0) {
        skip_blanks(p);
        if (take(p, ',')) {
            /* OpenSCAD allows a comma behind the last element. */
            skip_blanks(p);
            if (p->at >= p->end || *p->at != ']') {
                *more = true;
                return LMN_OK;
            }
        }
        if (!take(p, ']'))
            return expected(p, "',' or ']'");
        p->tree->values[open[--*depth]].after = (int32_t)p->tree->value_count;
    }
    return LMN_OK;
}

static lmn_status parse_value(parser *p)
{
    int32_t open[LIMIT_CSG_DEPTH], index = NONE;
    int     depth = 0;
    bool    more = true;
    while (more) {
        skip_blanks(p);
        lmn_status status = append_value(p, &index);
        if (status != LMN_OK)
            return status;
        if (depth > 0)
            p->tree->values[open[depth - 1]].count++;
        if (take(p, '[')) {
            if (depth >= LIMIT_CSG_DEPTH)
                return too_much(p, "vectors are nested too deep", LIMIT_CSG_DEPTH);
            p->tree->values[index].kind = CSG_VECTOR;
            open[depth++] = index;
            skip_blanks(p);
            if (p->at < p->end && *p->at != ']')
                continue;
        } else {
            csg_value v = {.kind = CSG_UNDEF};
            status = parse_plain(p, &v);
            v.after = index + 1;
            p->tree->values[index] = v;
        }
        if (status == LMN_OK)
            status = close_vectors(p, open, &depth, &more);
        if (status != LMN_OK)
            return status;
    }
    return LMN_OK;
}

/* --- statements ----------------------------------------------------------------------------------------- */

static lmn_status parse_argument(parser *p)
{
    csg_tree    *t = p->tree;
    csg_argument a = {.value = (int32_t)t->value_count};
    skip_blanks(p);
    size_t      length = word_length(p);
    const char *behind = p->at + length;
    while (behind < p->end && (*behind == ' ' || *behind == '\t'))
        behind++;
    if (length > 0 && behind < p->end && *behind == '=') {
        lmn_status status = keep_word(p, length, &a.name);
        if (status != LMN_OK)
            return status;
        p->at = behind + 1;
    }
    if (t->argument_count >= LIMIT_CSG_VALUES)
        return too_much(p, "too many arguments", LIMIT_CSG_VALUES);
    if (!mem_grow((void **)&t->arguments, &t->argument_capacity, t->argument_count + 1, sizeof a))
        return error_memory(p->error);
    t->arguments[t->argument_count++] = a;
    return parse_value(p);
}

static lmn_status parse_arguments(parser *p)
{
    if (!take(p, '('))
        return expected(p, "'('");
    if (take(p, ')'))
        return LMN_OK;
    for (;;) {
        lmn_status status = parse_argument(p);
        if (status != LMN_OK)
            return status;
        if (take(p, ')'))
            return LMN_OK;
        if (!take(p, ','))
            return expected(p, "',' or ')'");
        if (take(p, ')'))
            return LMN_OK;
    }
}

static uint8_t take_modifiers(parser *p)
{
    uint8_t found = 0;
    for (;; p->at++) {
        skip_blanks(p);
        switch (p->at < p->end ? *p->at : '\0') {
        case '#': found |= CSG_SHOWN; break;
        case '%': found |= CSG_BACKGROUND; break;
        case '*': found |= CSG_DISABLED; break;
        case '!': found |= CSG_ROOT; break;
        default: return found;
        }
    }
}

static lmn_status append_node(parser *p, int32_t *index)
{
    csg_tree *t = p->tree;
    if (t->node_count >= LIMIT_NODES)
        return too_much(p, "too many objects", LIMIT_NODES);
    if (!mem_grow((void **)&t->nodes, &t->node_capacity, t->node_count + 1, sizeof *t->nodes))
        return error_memory(p->error);
    *index = (int32_t)t->node_count++;
    t->nodes[*index] = (csg_node){.line = (uint32_t)p->line,
                                  .first_argument = (int32_t)t->argument_count,
                                  .first_value = (int32_t)t->value_count};
    return (t->node_count & 0xFFF) == 0
               ? import_progress(p->job, 0.2 * (1 - (double)(p->end - p->at) / (double)p->job->file->size), "reading",
                                 p->error)
               : LMN_OK;
}

/* Modifiers, word and arguments. */
static lmn_status parse_head(parser *p, int32_t *index)
{
    uint8_t modifiers = take_modifiers(p);
    size_t  length = word_length(p);
    if (length == 0)
        return expected(p, "an object such as \"cube\"");
    lmn_status status = append_node(p, index);
    if (status != LMN_OK)
        return status;
    p->tree->nodes[*index].modifiers = modifiers;
    status = keep_word(p, length, &p->tree->nodes[*index].word);
    if (status == LMN_OK)
        status = parse_arguments(p);
    csg_node *n = &p->tree->nodes[*index];
    n->argument_count = (int32_t)p->tree->argument_count - n->first_argument;
    n->value_count = (int32_t)p->tree->value_count - n->first_value;
    n->after = (int32_t)p->tree->node_count;
    return status;
}

static lmn_status never_closed(parser *p, int32_t node)
{
    const csg_node *n = &p->tree->nodes[node];
    error_in_file(p->error, LMN_FORMAT, p->job->path, p->line,
                  "the file is cut off: the block of %.60s in line %u is never closed", p->tree->text + n->word,
                  (unsigned)n->line);
    error_hint(p->error, "export it again from OpenSCAD");
    return LMN_FORMAT;
}

static lmn_status parse_statements(parser *p)
{
    int32_t open[LIMIT_CSG_DEPTH], index = NONE;
    int     depth = 0;
    for (;;) {
        skip_blanks(p);
        if (p->at >= p->end)
            return depth > 0 ? never_closed(p, open[depth - 1]) : LMN_OK;
        if (take(p, ';'))
            continue;
        if (*p->at == '}') {
            if (depth == 0)
                return fail_at(p, LMN_FORMAT, p->line, p->at, "this '}' closes nothing");
            p->at++;
            p->tree->nodes[open[--depth]].after = (int32_t)p->tree->node_count;
            continue;
        }
        lmn_status status = parse_head(p, &index);
        if (status != LMN_OK)
            return status;
        if (take(p, '{')) {
            if (depth >= LIMIT_CSG_DEPTH)
                return too_much(p, "blocks are nested too deep", LIMIT_CSG_DEPTH);
            open[depth++] = index;
        } else if (!take(p, ';')) {
            return expected(p, "';' or '{'");
        }
    }
}

/* --- sameness ------------------------------------------------------------------------------------------- */

static uint64_t mix(uint64_t hash, uint64_t value)
{
    hash = (hash ^ value) * 0x9E3779B97F4A7C15u;
    return hash ^ (hash >> 32);
}

static uint64_t hash_text(uint64_t hash, const char *text)
{
    for (; *text; text++)
        hash = mix(hash, (unsigned char)*text);
    return hash;
}

static uint64_t value_bits(const csg_value *v)
{
    uint64_t bits = 0;
    if (v->kind == CSG_NUMBER)
        memcpy(&bits, &v->as.number, sizeof bits);
    return v->kind == CSG_BOOL ? v->as.truth : bits;
}

static uint64_t hash_own(const csg_tree *t, const csg_node *n)
{
    uint64_t hash = hash_text(n->modifiers, t->text + n->word);
    for (int32_t i = 0; i < n->argument_count; i++)
        hash = hash_text(mix(hash, 1), t->text + t->arguments[n->first_argument + i].name);
    for (int32_t i = 0; i < n->value_count; i++) {
        const csg_value *v = &t->values[n->first_value + i];
        hash = mix(mix(hash, (uint64_t)v->kind << 32 | v->count), value_bits(v));
        if (v->kind == CSG_STRING)
            hash = hash_text(hash, t->text + v->as.string);
    }
    return hash;
}

/* Children come after their parents: from the back, theirs are complete. */
static void hash_nodes(csg_tree *t)
{
    for (size_t i = t->node_count; i-- > 0;) {
        uint64_t hash = hash_own(t, &t->nodes[i]);
        for (int32_t c = csg_first_child(t, (int32_t)i); c != NONE; c = csg_next_child(t, (int32_t)i, c))
            hash = mix(hash, t->nodes[c].hash);
        t->nodes[i].hash = hash;
    }
}

static bool same_own(const csg_tree *t, const csg_node *a, const csg_node *b)
{
    if (a->modifiers != b->modifiers || a->argument_count != b->argument_count || a->value_count != b->value_count ||
        strcmp(t->text + a->word, t->text + b->word) != 0)
        return false;
    for (int32_t i = 0; i < a->argument_count; i++)
        if (strcmp(t->text + t->arguments[a->first_argument + i].name,
                   t->text + t->arguments[b->first_argument + i].name) != 0)
            return false;
    for (int32_t i = 0; i < a->value_count; i++) {
        const csg_value *v = &t->values[a->first_value + i], *w = &t->values[b->first_value + i];
        if (v->kind != w->kind || v->count != w->count || value_bits(v) != value_bits(w) ||
            (v->kind == CSG_STRING && memcmp(t->text + v->as.string, t->text + w->as.string, v->count) != 0))
            return false;
    }
    return true;
}

bool csg_equal(const csg_tree *t, int32_t a, int32_t b)
{
    int32_t count = t->nodes[a].after - a;
    if (t->nodes[a].hash != t->nodes[b].hash || t->nodes[b].after - b != count)
        return false;
    for (int32_t i = 0; i < count; i++)
        if (t->nodes[a + i].after - a != t->nodes[b + i].after - b || !same_own(t, &t->nodes[a + i], &t->nodes[b + i]))
            return false;
    return true;
}

/* --- the tree ------------------------------------------------------------------------------------------- */

int32_t csg_first_child(const csg_tree *tree, int32_t node)
{
    return node + 1 < tree->nodes[node].after ? node + 1 : NONE;
}

int32_t csg_next_child(const csg_tree *tree, int32_t parent, int32_t child)
{
    int32_t next = tree->nodes[child].after;
    return next < tree->nodes[parent].after ? next : NONE;
}

const char *csg_word(const csg_tree *tree, int32_t node)
{
    return tree->text + tree->nodes[node].word;
}

void csg_release(csg_tree *tree)
{
    mem_free(tree->nodes);
    mem_free(tree->arguments);
    mem_free(tree->values);
    mem_free(tree->text);
    memset(tree, 0, sizeof *tree);
}

lmn_status csg_parse(csg_tree *out, const import_job *job, lmn_error *error)
{
    const char *begin = (const char *)job->file->data;
    parser      p = {.tree = out,
                     .job = job,
                     .at = begin,
                     .end = begin + job->file->size,
                     .line_begin = begin,
                     .line = 1,
                     .error = error};
    if (job->file->size >= 3 && memcmp(begin, "\xEF\xBB\xBF", 3) == 0)
        p.at = p.line_begin = begin + 3;
    int32_t root;
    *out = (csg_tree){0};
    if (!keep_bytes(out, "", 1))
        return error_memory(error);
    lmn_status status = append_node(&p, &root);
    if (status == LMN_OK)
        status = parse_statements(&p);
    if (status != LMN_OK)
        return status;
    out->nodes[0].after = (int32_t)out->node_count;
    hash_nodes(out);
    return LMN_OK;
}
