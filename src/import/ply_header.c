#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "import/build.h"
#include "import/ply.h"

enum { ELEMENTS_MAX = 64, PROPERTIES_MAX = 1024 };

/* The words of one header line. */
typedef struct words {
    const char *at[8];
    size_t      length[8];
    int         count;
} words;

size_t ply_type_size(ply_type type)
{
    static const size_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[type];
}

static bool is_word(const words *w, int i, const char *word)
{
    return i < w->count && w->length[i] == strlen(word) && memcmp(w->at[i], word, w->length[i]) == 0;
}

static ply_type type_of(const words *w, int i)
{
    static const struct {
        const char *name;
        ply_type    type;
    } names[] = {{"char", PLY_INT8},     {"int8", PLY_INT8},       {"uchar", PLY_UINT8},    {"uint8", PLY_UINT8},
                 {"short", PLY_INT16},   {"int16", PLY_INT16},     {"ushort", PLY_UINT16},  {"uint16", PLY_UINT16},
                 {"int", PLY_INT32},     {"int32", PLY_INT32},     {"uint", PLY_UINT32},    {"uint32", PLY_UINT32},
                 {"float", PLY_FLOAT32}, {"float32", PLY_FLOAT32}, {"double", PLY_FLOAT64}, {"float64", PLY_FLOAT64}};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (is_word(w, i, names[k].name))
            return names[k].type;
    return PLY_NONE;
}

static bool copy_word(const words *w, int i, char out[PLY_NAME_SIZE])
{
    if (i >= w->count || w->length[i] >= PLY_NAME_SIZE || !text_is_utf8(w->at[i], w->length[i]))
        return false;
    memcpy(out, w->at[i], w->length[i]);
    out[w->length[i]] = '\0';
    return true;
}

/* Splits the line at `at` and moves behind it. Lines end with LF, CR LF or a lone CR. False at the end of the file. */
static bool next_line(ply_reader *r, words *w)
{
    const char *p = r->at;
    w->count = 0;
    while (p < r->end && *p != '\n' && *p != '\r') {
        if (*p == ' ' || *p == '\t') {
            p++;
            continue;
        }
        const char *from = p;
        while (p < r->end && *p != '\n' && *p != '\r' && *p != ' ' && *p != '\t')
            p++;
        if (w->count < 8) {
            w->at[w->count] = from;
            w->length[w->count++] = (size_t)(p - from);
        }
    }
    if (p >= r->end)
        return false;
    bool pair = p[0] == '\r' && p + 1 < r->end && p[1] == '\n';
    if (r->at == r->begin)
        r->lone_returns = p[0] == '\r' && !pair;
    r->at = p + (pair && !r->lone_returns ? 2 : 1);
    return true;
}

static lmn_status wrong(const ply_reader *r, const words *w, const char *what)
{
    int line = build_line(r->begin, w->count ? w->at[0] : r->at);
    return error_in_file(r->error, LMN_FORMAT, r->job->path, line, "PLY header: %s", what);
}

static lmn_status read_format(ply_reader *r, const words *w)
{
    if (is_word(w, 1, "ascii"))
        r->encoding = PLY_ASCII;
    else if (is_word(w, 1, "binary_little_endian"))
        r->encoding = PLY_LITTLE;
    else if (is_word(w, 1, "binary_big_endian"))
        r->encoding = PLY_BIG;
    else
        return wrong(r, w, "the format is none of ascii, binary_little_endian, binary_big_endian");
    return LMN_OK;
}

static lmn_status read_element(ply_reader *r, const words *w)
{
    ply_element e = {.count = 0};
    long long   count = -1;
    if (w->count < 3 || !copy_word(w, 1, e.name) ||
        text_parse_int(w->at[2], w->at[2] + w->length[2], &count) != w->at[2] + w->length[2] || count < 0)
        return wrong(r, w, "expected \"element NAME COUNT\" with a count from 0");
    e.count = (uint64_t)count;
    if (r->element_count >= ELEMENTS_MAX)
        return wrong(r, w, "more than 64 elements");
    if (!mem_grow((void **)&r->elements, &r->element_capacity, r->element_count + 1, sizeof e))
        return error_memory(r->error);
    r->elements[r->element_count++] = e;
    return LMN_OK;
}

static lmn_status read_property(ply_reader *r, const words *w)
{
    if (r->element_count == 0)
        return wrong(r, w, "a property before the first element");
    ply_element *e = &r->elements[r->element_count - 1];
    ply_property p = {.type = PLY_NONE};
    bool         list = is_word(w, 1, "list");
    p.type = type_of(w, list ? 3 : 1);
    p.count_type = list ? type_of(w, 2) : PLY_NONE;
    if (p.type == PLY_NONE || (list && p.count_type == PLY_NONE))
        return wrong(r, w, "a property of unknown type (char, uchar, short, ushort, int, uint, float, double)");
    if (list && p.count_type >= PLY_FLOAT32)
        return wrong(r, w, "a list whose length is not an integer");
    if (!copy_word(w, list ? 4 : 2, p.name))
        return wrong(r, w, "a property without a name, or one longer than 63 bytes");
    if (e->property_count >= PROPERTIES_MAX)
        return wrong(r, w, "more than 1024 properties");
    if (!mem_grow((void **)&e->properties, &e->property_capacity, e->property_count + 1, sizeof p))
        return error_memory(r->error);
    e->properties[e->property_count++] = p;
    return LMN_OK;
}

static void read_comment(ply_reader *r, const words *w)
{
    if (w->count < 3 || !is_word(w, 1, "TextureFile"))
        return;
    const char *end = w->at[2];
    while (end < r->end && *end != '\n' && *end != '\r')
        end++;
    r->texture = w->at[2];
    r->texture_length = (size_t)(end - w->at[2]);
}

lmn_status ply_read_header(ply_reader *r)
{
    words w;
    bool  have_format = false;
    if (!next_line(r, &w) || !is_word(&w, 0, "ply"))
        return wrong(r, &w, "the first line is not \"ply\"");
    while (next_line(r, &w)) {
        lmn_status status = LMN_OK;
        if (w.count == 0 || is_word(&w, 0, "obj_info"))
            continue;
        if (is_word(&w, 0, "end_header"))
            return have_format ? LMN_OK : wrong(r, &w, "there is no \"format\" line");
        if (is_word(&w, 0, "comment"))
            read_comment(r, &w);
        else if (is_word(&w, 0, "format")) {
            status = read_format(r, &w);
            have_format = true;
        } else if (is_word(&w, 0, "element"))
            status = read_element(r, &w);
        else if (is_word(&w, 0, "property"))
            status = read_property(r, &w);
        else
            status = wrong(r, &w, "expected format, element, property, comment or end_header");
        if (status != LMN_OK)
            return status;
    }
    error_in_file(r->error, LMN_FORMAT, r->job->path, 0, "the file is cut off: its header has no \"end_header\"");
    error_hint(r->error, "copy or export the file again");
    return LMN_FORMAT;
}

void ply_release(ply_reader *r)
{
    for (size_t i = 0; i < r->element_count; i++)
        mem_free(r->elements[i].properties);
    mem_free(r->elements);
}
