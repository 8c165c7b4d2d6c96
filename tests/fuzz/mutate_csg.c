/* Changes .csg files as trees: nodes are found by their brackets, then exchanged, repeated, left out, put below
 * another operation, or told other numbers. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "fuzz.h"

enum { SPANS_MOST = 2048 };

/* A piece of the text. */
typedef struct span {
    size_t begin, end;
} span;

typedef struct spans {
    span   items[SPANS_MOST];
    size_t count;
} spans;

/* A text in the making. */
typedef struct draft {
    char  *text;
    size_t size, most;
    bool   full;
} draft;

static void add(draft *d, const char *bytes, size_t size)
{
    if (size > d->most - d->size) {
        d->full = true;
        return;
    }
    memcpy(d->text + d->size, bytes, size);
    d->size += size;
}

static void add_text(draft *d, const char *text)
{
    add(d, text, strlen(text));
}

/* Behind the bracket that closes the one at `at`; `size` when none does. Texts in quotes are passed over. */
static size_t behind_bracket(const char *text, size_t size, size_t at)
{
    int depth = 0;
    for (; at < size; at++) {
        if (text[at] == '"')
            for (at++; at < size && text[at] != '"'; at++)
                at += text[at] == '\\';
        else if (strchr("([{", text[at]) && text[at])
            depth++;
        else if (strchr(")]}", text[at]) && text[at] && --depth <= 0)
            return at + 1;
    }
    return size;
}

/* All nodes: word, arguments, and what is below or a semicolon. */
static void find_nodes(spans *found, const char *text, size_t size)
{
    found->count = 0;
    for (size_t at = 0; at < size && found->count < SPANS_MOST;) {
        if (!isalpha((unsigned char)text[at]) && text[at] != '_') {
            at++;
            continue;
        }
        const size_t begin = at;
        while (at < size && (isalnum((unsigned char)text[at]) || text[at] == '_'))
            at++;
        if (at >= size || text[at] != '(')
            continue;
        size_t end = behind_bracket(text, size, at), inside = end;
        while (end < size && isspace((unsigned char)text[end]))
            end++;
        if (end < size && text[end] == '{')
            end = behind_bracket(text, size, end);
        else if (end < size && text[end] == ';')
            end++;
        found->items[found->count++] = (span){begin, end};
        at = inside;
    }
}

static void find_numbers(spans *found, const char *text, size_t size)
{
    found->count = 0;
    for (size_t at = 0; at < size && found->count < SPANS_MOST;) {
        const bool begins =
            (isdigit((unsigned char)text[at]) || text[at] == '-') && (at == 0 || strchr(" ,[=(", text[at - 1]));
        const size_t begin = at++;
        if (!begins)
            continue;
        while (at < size && (isalnum((unsigned char)text[at]) || strchr(".+-", text[at])) && text[at])
            at++;
        found->items[found->count++] = (span){begin, at};
    }
}

/* Bracketed lists: vectors and matrices. */
static void find_vectors(spans *found, const char *text, size_t size)
{
    found->count = 0;
    for (size_t at = 0; at < size && found->count < SPANS_MOST; at++)
        if (text[at] == '[')
            found->items[found->count++] = (span){at, behind_bracket(text, size, at)};
}

static const char *const operations[] = {
    "union() {",
    "difference() {",
    "intersection() {",
    "group() {",
    "hull() {",
    "minkowski(convexity = 0) {",
    "render(convexity = 1) {",
    "color([1, 0.5, 0, 0.5]) {",
    "resize(newsize = [3, 0, 1], auto = [true, false, true]) {",
    "projection(cut = true, convexity = 0) {",
    "projection(cut = false) {",
    "offset(r = -0.5, $fn = 8) {",
    "offset(delta = 1, chamfer = true) {",
    "linear_extrude(height = 4, center = true, scale = [0, 2], twist = 400, slices = 5, $fn = 9) {",
    "linear_extrude(height = 1, scale = [1, 1]) {",
    "rotate_extrude(angle = 90, $fn = 7) {",
    "rotate_extrude($fn = 5) {",
    "multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {",
    "multmatrix([[1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {",
    "multmatrix([[-1, 0, 0, 0], [0, 1e9, 0, 0], [0, 0, 1e-9, 0], [0, 0, 0, 1]]) {",
    "#",
    "%",
    "*",
    "!",
};

static const char *const leaves[] = {
    "cube(size = [1, 2, 3], center = true);",
    "sphere($fn = 6, r = 1);",
    "cylinder($fn = 5, h = 2, r1 = 1, r2 = 0, center = true);",
    "cylinder($fn = 0, $fa = 12, $fs = 2, h = 1, r1 = 0, r2 = 3);",
    "square(size = [2, 1], center = true);",
    "circle($fn = 7, r = 2);",
    "text(text = \"a B\\\"\", size = 3, font = \"\", halign = \"center\");",
    "polygon(points = [[0, 0], [2, 0], [0, 2], [2, 2]], paths = undef, convexity = 1);",
    "polygon(points = [[0, 0], [9, 0], [0, 9], [1, 1], [3, 1], [1, 3]], paths = [[0, 1, 2], [3, 4, 5]]);",
    "polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, "
    "3, 0]], convexity = 1);",
    "surface(file = \"none.dat\", center = true);",
    "import(file = \"none.stl\");",
    "group();",
    "unknown(a = 1);",
};

static span pick(const spans *s, uint32_t *state)
{
    return s->items[fuzz_random(state, (uint32_t)s->count)];
}

/* The text with `at` replaced by the other bytes. */
static void replace(draft *d, const char *text, size_t size, span at, const char *bytes, size_t count)
{
    add(d, text, at.begin);
    add(d, bytes, count);
    add(d, text + at.end, size - at.end);
}

static void exchange(draft *d, const char *text, size_t size, span a, span b)
{
    const span first = a.begin < b.begin ? a : b, second = a.begin < b.begin ? b : a;
    if (second.begin < first.end) { /* one inside the other: the inner one takes its place */
        replace(d, text, size, first, text + second.begin, second.end - second.begin);
        return;
    }
    add(d, text, first.begin);
    add(d, text + second.begin, second.end - second.begin);
    add(d, text + first.end, second.begin - first.end);
    add(d, text + first.begin, first.end - first.begin);
    add(d, text + second.end, size - second.end);
}

static void change_nodes(draft *d, const char *text, size_t size, const spans *nodes, uint32_t *state)
{
    const span a = pick(nodes, state), b = pick(nodes, state);
    switch (fuzz_random(state, 6)) {
    case 0: exchange(d, text, size, a, b); break;
    case 1: /* below an operation */
        add(d, text, a.begin);
        add_text(d, operations[fuzz_random(state, sizeof operations / sizeof *operations)]);
        add(d, text + a.begin, a.end - a.begin);
        if (strchr("#%*!", d->text[d->size - (a.end - a.begin) - 1]) == NULL)
            add_text(d, "}");
        add(d, text + a.end, size - a.end);
        break;
    case 2: replace(d, text, size, a, "", 0); break;
    case 3: { /* a leaf before it */
        const char *leaf = leaves[fuzz_random(state, sizeof leaves / sizeof *leaves)];
        replace(d, text, size, (span){a.begin, a.begin}, leaf, strlen(leaf));
        break;
    }
    case 4: /* b also where a is */
        replace(d, text, size, (span){a.begin, a.begin}, text + b.begin, b.end - b.begin);
        break;
    default: replace(d, text, size, a, text + b.begin, b.end - b.begin); break;
    }
}

static void change_number(draft *d, const char *text, size_t size, span at, uint32_t *state)
{
    static const char *const words[] = {"undef", "true", "nan", "inf", "-inf", "\"1\"", "[]", "[1, 2]"};
    char                     number[64];
    memcpy(number, text + at.begin, at.end - at.begin < 32 ? at.end - at.begin : 32);
    number[at.end - at.begin < 32 ? at.end - at.begin : 32] = '\0';
    double value = fuzz_number(state, strtod(number, NULL));
    /* Hundreds of thousands of facets are allowed and take long; beyond is a limit worth reaching. */
    if (at.begin >= 6 && memcmp(text + at.begin - 6, "$fn = ", 6) == 0 && value > 300 && value < 1e7)
        value = 300;
    if (fuzz_random(state, 8) == 0)
        snprintf(number, sizeof number, "%s", words[fuzz_random(state, sizeof words / sizeof *words)]);
    else
        snprintf(number, sizeof number, "%.6g", value);
    replace(d, text, size, at, number, strlen(number));
}

static void change_once(draft *d, const char *text, size_t size, spans *found, uint32_t *state)
{
    switch (fuzz_random(state, 5)) {
    case 0:
        find_vectors(found, text, size);
        if (found->count) {
            exchange(d, text, size, pick(found, state), pick(found, state));
            return;
        }
        break;
    case 1:
    case 2:
        find_numbers(found, text, size);
        if (found->count) {
            change_number(d, text, size, pick(found, state), state);
            return;
        }
        break;
    default:
        find_nodes(found, text, size);
        if (found->count) {
            change_nodes(d, text, size, found, state);
            return;
        }
        break;
    }
    const char *leaf = leaves[fuzz_random(state, sizeof leaves / sizeof *leaves)];
    replace(d, text, size, (span){0, 0}, leaf, strlen(leaf));
}

size_t fuzz_mutate_csg(uint8_t *bytes, size_t size, size_t most, unsigned seed)
{
    uint32_t state = seed;
    if (fuzz_random(&state, 12) == 0)
        return LLVMFuzzerMutate(bytes, size, most);
    spans *found = mem_alloc(sizeof *found);
    draft  d = {.text = mem_alloc(most), .most = most};
    if (found && d.text)
        for (uint32_t n = 1 + fuzz_random(&state, 3); n > 0; n--) {
            d.size = 0;
            d.full = false;
            change_once(&d, (const char *)bytes, size, found, &state);
            if (d.full)
                continue;
            memcpy(bytes, d.text, d.size);
            size = d.size;
        }
    mem_free(found);
    mem_free(d.text);
    return size;
}
