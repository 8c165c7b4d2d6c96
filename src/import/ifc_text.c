/* Entities of ISO 10303-21: "#12=IFCWALL('2O2Fr$t4X7Zf8NOew3FNr2',#2,'South wall',$,$,#30,#41,$);". */
#include "import/ifc_text.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"
#include "scene/scene.h"

enum { ARGUMENTS_MOST = 12, NAME = 2, SHAPE = 6, TYPE_MOST = 64 };

typedef struct span {
    const char *at, *end;
} span;

typedef struct scanner {
    const char *at, *end;
    ifc_text   *out;
    uint64_t   *shapes;   /* numbers of what products are drawn by */
    uint64_t   *shape_of; /* per thing, as the products refer to them; 0: nothing */
    size_t      shape_count, shape_capacity, of_capacity;
    bool        failed;
} scanner;

/* Behind a string or a comment that begins here; where it is, if none does. */
static const char *skip_closed(const char *at, const char *end)
{
    if (*at == '\'') {
        for (at++; at < end && *at != '\''; at++)
            ;
        return at < end ? at + 1 : end;
    }
    if (*at == '/' && at + 1 < end && at[1] == '*') {
        for (at += 2; at + 1 < end && !(at[0] == '*' && at[1] == '/'); at++)
            ;
        return at + 2 <= end ? at + 2 : end;
    }
    return at;
}

static span trimmed(const char *from, const char *to)
{
    while (from < to && isspace((unsigned char)*from))
        from++;
    while (to > from && isspace((unsigned char)to[-1]))
        to--;
    return (span){from, to};
}

/* What stands between the brackets from `at` on, up to so many; `*end` gets behind the closing one. */
static size_t split(const char *at, const char *limit, span *out, size_t most, const char **end)
{
    const char *from = at;
    size_t      count = 0;
    int         depth = 0;
    for (; at < limit;) {
        const char *behind = skip_closed(at, limit);
        if (behind != at) {
            at = behind;
            continue;
        }
        if (depth == 0 && (*at == ',' || *at == ')')) {
            if (count < most)
                out[count] = trimmed(from, at);
            count++;
            from = at + 1;
        }
        if (*at == ')' && depth-- == 0)
            break;
        depth += *at == '(';
        at++;
    }
    *end = at < limit ? at + 1 : limit;
    return count < most ? count : most;
}

/* --- strings -------------------------------------------------------------------------------------------- */

static char *put_letter(char *to, uint32_t c)
{
    if (c < 0x80) {
        *to++ = (char)c;
    } else if (c < 0x800) {
        *to++ = (char)(0xC0 | c >> 6);
        *to++ = (char)(0x80 | (c & 63));
    } else if (c < 0x10000) {
        *to++ = (char)(0xE0 | c >> 12);
        *to++ = (char)(0x80 | (c >> 6 & 63));
        *to++ = (char)(0x80 | (c & 63));
    } else {
        *to++ = (char)(0xF0 | (c >> 18 & 7));
        *to++ = (char)(0x80 | (c >> 12 & 63));
        *to++ = (char)(0x80 | (c >> 6 & 63));
        *to++ = (char)(0x80 | (c & 63));
    }
    return to;
}

static bool read_hex(const char *at, const char *end, int digits, uint32_t *out)
{
    *out = 0;
    if (end - at < digits)
        return false;
    for (int i = 0; i < digits; i++) {
        int c = toupper((unsigned char)at[i]);
        if (!isxdigit(c))
            return false;
        *out = *out << 4 | (uint32_t)(c <= '9' ? c - '0' : c - 'A' + 10);
    }
    return true;
}

/* \S\d is 128 more than d, \X\E4 one letter, \X2\00E400F6\X0\ several of four digits, \X4\ of eight. Returns behind it;
 * NULL: it is none. */
static const char *read_escape(const char *at, const char *end, char **to)
{
    uint32_t c;
    if (end - at > 3 && memcmp(at, "\\S\\", 3) == 0) {
        *to = put_letter(*to, 128u + (unsigned char)at[3]);
        return at + 4;
    }
    if (end - at > 3 && memcmp(at, "\\X\\", 3) == 0 && read_hex(at + 3, end, 2, &c)) {
        *to = put_letter(*to, c);
        return at + 5;
    }
    if (end - at < 4 || at[0] != '\\' || at[1] != 'X' || (at[2] != '2' && at[2] != '4') || at[3] != '\\')
        return NULL;
    int digits = at[2] == '2' ? 4 : 8;
    for (at += 4; read_hex(at, end, digits, &c); at += digits)
        *to = put_letter(*to, c < 0x110000 && c >= 32 ? c : 0xFFFD);
    return end - at >= 4 && memcmp(at, "\\X0\\", 4) == 0 ? at + 4 : at;
}

/* The words of a string; NULL: it is none, or empty, or memory is gone (`*failed`). */
static char *words_of(span s, bool *failed)
{
    if (s.end - s.at < 3 || s.at[0] != '\'' || s.end[-1] != '\'')
        return NULL;
    s.at++;
    s.end--;
    char *raw = mem_alloc(2 * (size_t)(s.end - s.at) + 8), *to = raw;
    if (!raw) {
        *failed = true;
        return NULL;
    }
    while (s.at < s.end) {
        const char *behind = *s.at == '\\' ? read_escape(s.at, s.end, &to) : NULL;
        if (behind) {
            s.at = behind;
            continue;
        }
        /* Apostrophes and backslashes stand twice. */
        bool twice = (*s.at == '\'' || *s.at == '\\') && s.at + 1 < s.end && s.at[1] == *s.at;
        *to++ = *s.at;
        s.at += twice ? 2 : 1;
    }
    char *clean = scene_clean_name(raw, (size_t)(to - raw));
    *failed = *failed || !clean;
    mem_free(raw);
    return clean;
}

/* --- entities ------------------------------------------------------------------------------------------- */

static uint64_t number_at(const char *at, const char *end)
{
    uint64_t number = 0;
    for (; at < end && isdigit((unsigned char)*at) && number < UINT64_MAX / 10 - 1; at++)
        number = 10 * number + (uint64_t)(*at - '0');
    return number;
}

static bool is(span s, const char *word)
{
    return (size_t)(s.end - s.at) == strlen(word) && strncasecmp(s.at, word, strlen(word)) == 0;
}

/* What has a shape and is none of the building's. */
static bool is_empty_kind(span type)
{
    static const char *const kinds[] = {"IFCSPACE",
                                        "IFCOPENINGELEMENT",
                                        "IFCOPENINGSTANDARDCASE",
                                        "IFCVIRTUALELEMENT",
                                        "IFCSPATIALZONE",
                                        "IFCANNOTATION",
                                        "IFCGRID",
                                        "IFCSITE"};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (is(type, kinds[i]))
            return true;
    return false;
}

static void take_thing(scanner *s, uint64_t number, span type, const span *arguments, size_t count)
{
    ifc_text *t = s->out;
    if (!mem_grow((void **)&t->things, &t->capacity, t->count + 1, sizeof *t->things) ||
        !mem_grow((void **)&s->shape_of, &s->of_capacity, t->count + 1, sizeof *s->shape_of)) {
        s->failed = true;
        return;
    }
    ifc_thing thing = {.number = number, .shaped = !is_empty_kind(type)};
    memcpy(thing.guid, arguments[0].at + 1, IFC_GUID);
    thing.type = scene_clean_name(type.at, (size_t)(type.end - type.at));
    s->failed = s->failed || !thing.type;
    if (count > NAME)
        thing.name = words_of(arguments[NAME], &s->failed);
    bool refers = count > SHAPE && arguments[SHAPE].at < arguments[SHAPE].end && *arguments[SHAPE].at == '#';
    s->shape_of[t->count] = refers ? number_at(arguments[SHAPE].at + 1, arguments[SHAPE].end) : 0;
    t->things[t->count++] = thing;
}

static void take_shape(scanner *s, uint64_t number)
{
    if (!mem_grow((void **)&s->shapes, &s->shape_capacity, s->shape_count + 1, sizeof *s->shapes))
        s->failed = true;
    else
        s->shapes[s->shape_count++] = number;
}

/* FILE_NAME('name','time',('author'),('organisation'),…) */
static void take_header(scanner *s, const span *arguments, size_t count)
{
    static const int from[IFC_FACTS] = {0, 2, 3, 1};
    for (int i = 0; i < IFC_FACTS; i++) {
        span        of = (size_t)from[i] < count ? arguments[from[i]] : (span){NULL, NULL}, first;
        const char *end;
        if (!of.at || s->out->facts[i])
            continue;
        if (of.at < of.end && *of.at == '(')
            of = split(of.at + 1, of.end, &first, 1, &end) ? first : (span){of.at, of.at};
        s->out->facts[i] = words_of(of, &s->failed);
    }
}

/* A word and what stands in its brackets; false: there is none here. */
static bool take_record(scanner *s, uint64_t number)
{
    span        arguments[ARGUMENTS_MOST];
    const char *from = s->at;
    while (s->at < s->end && (isalnum((unsigned char)*s->at) || *s->at == '_'))
        s->at++;
    span type = {from, s->at};
    while (s->at < s->end && isspace((unsigned char)*s->at))
        s->at++;
    if (type.end == type.at || type.end - type.at > TYPE_MOST || s->at == s->end || *s->at != '(')
        return false;
    size_t count = split(s->at + 1, s->end, arguments, ARGUMENTS_MOST, &s->at);
    if (number && is(type, "IFCPRODUCTDEFINITIONSHAPE"))
        take_shape(s, number);
    else if (number && count > NAME && arguments[0].end - arguments[0].at == IFC_GUID + 2 && *arguments[0].at == '\'')
        take_thing(s, number, type, arguments, count);
    else if (!number && is(type, "FILE_NAME"))
        take_header(s, arguments, count);
    return true;
}

static void scan(scanner *s)
{
    uint64_t number = 0;
    for (size_t steps = 0; s->at < s->end && !s->failed; steps++) {
        if (steps % 65536 == 0 && work_stopped())
            return;
        const char *behind = skip_closed(s->at, s->end);
        if (behind != s->at) {
            s->at = behind;
        } else if (*s->at == '#') {
            number = number_at(s->at + 1, s->end);
            for (s->at++; s->at < s->end && isdigit((unsigned char)*s->at); s->at++)
                ;
        } else if (isalpha((unsigned char)*s->at)) {
            if (take_record(s, number))
                number = 0;
        } else {
            s->at++;
        }
    }
}

static int compare_numbers(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return *x < *y ? -1 : *x > *y;
}

static int compare_things(const void *a, const void *b)
{
    const ifc_thing *x = a, *y = b;
    int              order = memcmp(x->guid, y->guid, IFC_GUID);
    return order ? order : x->number < y->number ? -1 : x->number > y->number;
}

lmn_status ifc_text_read(ifc_text *out, const char *bytes, size_t size, lmn_error *error)
{
    scanner s = {.at = bytes, .end = bytes + size, .out = out};
    *out = (ifc_text){NULL, 0, 0, {NULL}};
    scan(&s);
    if (s.shape_count)
        qsort(s.shapes, s.shape_count, sizeof *s.shapes, compare_numbers);
    for (size_t i = 0; i < out->count; i++)
        out->things[i].shaped =
            out->things[i].shaped && s.shape_of[i] && s.shape_count &&
            bsearch(&s.shape_of[i], s.shapes, s.shape_count, sizeof *s.shapes, compare_numbers) != NULL;
    if (out->count)
        qsort(out->things, out->count, sizeof *out->things, compare_things);
    mem_free(s.shapes);
    mem_free(s.shape_of);
    return s.failed || work_stopped() ? error_memory(error) : LMN_OK;
}

void ifc_text_release(ifc_text *t)
{
    for (size_t i = 0; i < t->count; i++) {
        mem_free(t->things[i].type);
        mem_free(t->things[i].name);
    }
    for (int i = 0; i < IFC_FACTS; i++)
        mem_free(t->facts[i]);
    mem_free(t->things);
    *t = (ifc_text){NULL, 0, 0, {NULL}};
}

const ifc_thing *ifc_text_find(const ifc_text *t, const char *node_name)
{
    size_t length = node_name ? strlen(node_name) : 0, low = 0, high = t->count;
    if (length < IFC_GUID)
        return NULL;
    const char *guid = node_name + length - IFC_GUID;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        int    order = memcmp(t->things[middle].guid, guid, IFC_GUID);
        if (order == 0)
            return &t->things[middle];
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return NULL;
}
