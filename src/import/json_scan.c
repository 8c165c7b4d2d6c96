#include "import/json_scan.h"

#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "scene/scene.h"

json_scan scan_of(json_span span)
{
    const char *at = span.at ? span.at : "";
    return (json_scan){.at = at, .end = at + (span.at ? span.size : 0)};
}

void scan_fail(json_scan *s, const char *what)
{
    if (!s->wrong) {
        s->wrong = what;
        s->wrong_at = s->at;
    }
    s->at = s->end;
}

char scan_peek(json_scan *s)
{
    while (*s->at == ' ' || *s->at == '\n' || *s->at == '\r' || *s->at == '\t')
        s->at++;
    return s->at < s->end ? *s->at : '\0';
}

bool scan_open(json_scan *s, char bracket)
{
    if (scan_peek(s) != bracket) {
        scan_fail(s, bracket == '{' ? "an object is expected" : "a list is expected");
        return false;
    }
    s->at++;
    if (scan_peek(s) != (bracket == '{' ? '}' : ']'))
        return true;
    s->at++;
    return false;
}

bool scan_next(json_scan *s, char closing)
{
    char c = scan_peek(s);
    if (c == ',') {
        s->at++;
        return true;
    }
    if (c == closing)
        s->at++;
    else
        scan_fail(s, closing == '}' ? "',' or '}' is expected" : "',' or ']' is expected");
    return false;
}

/* Behind a text that begins at a quote; NULL when it does not end. */
static const char *behind_text(const char *at, const char *end)
{
    for (at++; at < end; at++) {
        at = memchr(at, '"', (size_t)(end - at));
        if (!at)
            return NULL;
        size_t escapes = 0;
        while (at[-1 - (ptrdiff_t)escapes] == '\\')
            escapes++;
        if (escapes % 2 == 0)
            return at + 1;
    }
    return NULL;
}

json_span scan_string(json_scan *s)
{
    if (scan_peek(s) != '"') {
        scan_skip(s);
        return (json_span){NULL, 0};
    }
    const char *from = s->at, *to = behind_text(from, s->end);
    if (!to) {
        scan_fail(s, "the text does not end");
        return (json_span){NULL, 0};
    }
    s->at = to;
    return (json_span){from + 1, (size_t)(to - from) - 2};
}

json_span scan_key(json_scan *s)
{
    if (scan_peek(s) != '"') {
        scan_fail(s, "the name of a member is expected");
        return (json_span){"", 0};
    }
    json_span key = scan_string(s);
    if (!s->wrong && scan_peek(s) != ':')
        scan_fail(s, "':' is expected");
    if (s->wrong)
        return (json_span){"", 0};
    s->at++;
    return key;
}

/* Bytes at which skipping a list or object has to look. */
static const unsigned char stops[256] = {['"'] = 1, ['['] = 1, [']'] = 1, ['{'] = 1, ['}'] = 1, ['\0'] = 1};

static void skip_nested(json_scan *s)
{
    uint64_t    kinds[LIMIT_JSON_DEPTH / 64] = {0}; /* a bit a level: is it an object? */
    int         depth = 0;
    const char *at = s->at;
    do {
        while (!stops[(unsigned char)*at])
            at++;
        char c = *at;
        s->at = at;
        if (c == '"') {
            at = behind_text(at, s->end);
            if (!at) {
                scan_fail(s, "the text does not end");
                return;
            }
            continue;
        }
        bool object = c == '{' || c == '}';
        if (at >= s->end || c == '\0') {
            scan_fail(s, at >= s->end ? "the file ends within a list or object" : "a NUL byte");
            return;
        }
        at++;
        if (c == '[' || c == '{') {
            if (depth == LIMIT_JSON_DEPTH) {
                scan_fail(s, "nested too deeply");
                return;
            }
            uint64_t bit = UINT64_C(1) << (depth % 64), *word = &kinds[depth / 64];
            *word = object ? *word | bit : *word & ~bit;
            depth++;
        } else {
            depth--;
            if ((kinds[depth / 64] >> (depth % 64) & 1) != object) {
                scan_fail(s, "a bracket of the other kind is expected");
                return;
            }
        }
    } while (depth > 0);
    s->at = at;
}

json_span scan_skip(json_scan *s)
{
    char        c = scan_peek(s);
    const char *from = s->at;
    if (c == '"') {
        const char *to = behind_text(from, s->end);
        if (to)
            s->at = to;
        else
            scan_fail(s, "the text does not end");
    } else if (c == '[' || c == '{') {
        skip_nested(s);
    } else {
        while (s->at < s->end && !strchr(",]} \n\r\t", *s->at))
            s->at++;
        if (s->at == from)
            scan_fail(s, "a value is expected");
    }
    return s->wrong ? (json_span){from, 0} : (json_span){from, (size_t)(s->at - from)};
}

bool scan_number(json_scan *s, double *out)
{
    scan_peek(s);
    const char *at = s->at;
    bool        minus = *at == '-';
    long long   whole = 0;
    at += minus;
    const char *digits = at;
    while (*at >= '0' && *at <= '9' && at - digits < 18)
        whole = whole * 10 + (*at++ - '0');
    if (at > digits && *at != '.' && *at != 'e' && *at != 'E' && !(*at >= '0' && *at <= '9')) {
        *out = minus ? -(double)whole : (double)whole;
        s->at = at;
        return true;
    }
    const char *behind = text_parse_double(s->at, s->end, out);
    if (!behind) {
        scan_fail(s, "a number is expected");
        return false;
    }
    s->at = behind;
    return true;
}

bool scan_null(json_scan *s)
{
    if (scan_peek(s) != 'n' || s->end - s->at < 4 || memcmp(s->at, "null", 4) != 0)
        return false;
    s->at += 4;
    return true;
}

bool span_is(json_span span, const char *text)
{
    return span.at && strlen(text) == span.size && memcmp(span.at, text, span.size) == 0;
}

bool span_is_plain(json_span span)
{
    bool plain = true;
    for (size_t i = 0; i < span.size; i++)
        plain &= (unsigned char)span.at[i] - 0x20u < 0x5Fu && span.at[i] != '\\';
    return plain;
}

/* --- texts ---------------------------------------------------------------------------------------------- */

static int hex4(const char *at, const char *end)
{
    int value = 0;
    for (int i = 0; i < 4; i++) {
        char c = at + i < end ? at[i] : '\0';
        int  digit = c >= '0' && c <= '9'   ? c - '0'
                     : c >= 'a' && c <= 'f' ? c - 'a' + 10
                     : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                            : -1;
        if (digit < 0)
            return -1;
        value = value * 16 + digit;
    }
    return value;
}

static void append_character(text *t, uint32_t c)
{
    char   bytes[4];
    size_t size = c < 0x80 ? 1 : c < 0x800 ? 2 : c < 0x10000 ? 3 : 4;
    for (size_t i = size; i-- > 1; c >>= 6)
        bytes[i] = (char)(0x80 | (c & 0x3F));
    static const unsigned char first[] = {0, 0, 0xC0, 0xE0, 0xF0};
    bytes[0] = (char)(size == 1 ? c : first[size] | c);
    text_append_bytes(t, bytes, size);
}

/* Behind "\u" and what belongs to it. Half a pair of surrogates becomes U+FFFD. */
static const char *append_unicode(text *t, const char *at, const char *end)
{
    int high = hex4(at, end);
    if (high < 0)
        return at;
    at += 4;
    uint32_t c = (uint32_t)high;
    if (high >= 0xD800 && high < 0xE000) {
        int  low = high < 0xDC00 && end - at >= 6 && at[0] == '\\' && at[1] == 'u' ? hex4(at + 2, end) : -1;
        bool pair = low >= 0xDC00 && low < 0xE000;
        c = pair ? 0x10000 + ((uint32_t)(high - 0xD800) << 10) + (uint32_t)(low - 0xDC00) : 0xFFFD;
        at += pair ? 6 : 0;
    }
    append_character(t, c);
    return at;
}

char *span_decode(json_span span)
{
    if (!memchr(span.at, '\\', span.size))
        return scene_clean_name(span.at, span.size);
    static const char escapes[] = "\"\\/bfnrt", plain[] = "\"\\/\b\f\n\r\t";
    text              t = {0};
    const char       *end = span.at + span.size;
    for (const char *at = span.at; at < end;) {
        const char *found = at[0] == '\\' && at + 1 < end && at[1] ? strchr(escapes, at[1]) : NULL;
        if (found) {
            text_append_bytes(&t, &plain[found - escapes], 1);
            at += 2;
        } else if (at[0] == '\\' && at + 1 < end && at[1] == 'u') {
            at = append_unicode(&t, at + 2, end);
        } else {
            text_append_bytes(&t, at++, 1);
        }
    }
    char *clean = t.failed ? NULL : scene_clean_name(t.data ? t.data : "", t.size);
    text_release(&t);
    return clean;
}
