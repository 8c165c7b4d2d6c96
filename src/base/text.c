#include "base/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"

static bool reserve(text *t, size_t more)
{
    size_t wanted;
    if (t->failed || !size_add(t->size, more, &wanted) || !size_add(wanted, 1, &wanted) ||
        !mem_grow((void **)&t->data, &t->capacity, wanted, 1)) {
        t->failed = true;
        return false;
    }
    return true;
}

void text_append(text *t, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0)
        t->failed = true;
    else if (reserve(t, (size_t)length)) {
        vsnprintf(t->data + t->size, (size_t)length + 1, format, again);
        t->size += (size_t)length;
    }
    va_end(again);
}

void text_append_bytes(text *t, const char *bytes, size_t size)
{
    if (!reserve(t, size))
        return;
    if (size)
        memcpy(t->data + t->size, bytes, size);
    t->size += size;
    t->data[t->size] = '\0';
}

void text_release(text *t)
{
    mem_free(t->data);
    memset(t, 0, sizeof *t);
}

char *text_take(text *t)
{
    if (!t->failed && !t->data)
        text_append_bytes(t, "", 0);
    if (t->failed) {
        text_release(t);
        return NULL;
    }
    char *data = t->data;
    memset(t, 0, sizeof *t);
    return data;
}

static bool same_word(const char *from, const char *end, const char *word)
{
    for (; *word; from++, word++)
        if (from >= end || (*from | 0x20) != *word)
            return false;
    return true;
}

static const char *parse_word(const char *from, const char *end, double *out)
{
    if (same_word(from, end, "infinity"))
        return *out = INFINITY, from + 8;
    if (same_word(from, end, "inf"))
        return *out = INFINITY, from + 3;
    if (same_word(from, end, "nan"))
        return *out = NAN, from + 3;
    return NULL;
}

/* Reads "e[+-]digits" behind a mantissa; without digits the 'e' is not part of the number. */
static const char *parse_exponent(const char *at, const char *end, long *exponent)
{
    if (at >= end || (*at | 0x20) != 'e')
        return at;
    const char *p = at + 1;
    bool        negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+'))
        p++;
    if (p >= end || *p < '0' || *p > '9')
        return at;
    long value = 0;
    for (; p < end && *p >= '0' && *p <= '9'; p++)
        if (value < 100000)
            value = value * 10 + (*p - '0');
    *exponent += negative ? -value : value;
    return p;
}

static double scale_by_ten(double mantissa, long exponent)
{
    static const double exact[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    if (mantissa == 0.0)
        return mantissa;
    if (exponent >= 0 && exponent <= 22)
        return mantissa * exact[exponent];
    if (exponent < 0 && exponent >= -22)
        return mantissa / exact[-exponent];
    if (exponent > 400 || exponent < -400)
        return exponent > 0 ? mantissa * INFINITY : mantissa * 0.0;
    return (double)((long double)mantissa * powl(10.0L, (long double)exponent));
}

const char *text_parse_double(const char *from, const char *end, double *out)
{
    bool negative = from < end && *from == '-';
    if (from < end && (*from == '-' || *from == '+'))
        from++;
    const char *word_end = parse_word(from, end, out);
    if (word_end) {
        *out = negative ? -*out : *out;
        return word_end;
    }
    uint64_t    mantissa = 0;
    long        exponent = 0;
    bool        digits = false, behind_point = false;
    const char *p = from;
    for (; p < end; p++) {
        if (*p == '.' && !behind_point) {
            behind_point = true;
            continue;
        }
        if (*p < '0' || *p > '9')
            break;
        digits = true;
        /* 19 digits fit; what follows is below a double's precision and only moves the exponent. */
        if (mantissa < UINT64_C(922337203685477579)) {
            mantissa = mantissa * 10 + (uint64_t)(*p - '0');
            exponent -= behind_point;
        } else {
            exponent += !behind_point;
        }
    }
    if (!digits)
        return NULL;
    p = parse_exponent(p, end, &exponent);
    double value = scale_by_ten((double)mantissa, exponent);
    *out = negative ? -value : value;
    return p;
}

const char *text_parse_int(const char *from, const char *end, long long *out)
{
    bool negative = from < end && *from == '-';
    if (from < end && (*from == '-' || *from == '+'))
        from++;
    if (from >= end || *from < '0' || *from > '9')
        return NULL;
    long long value = 0;
    for (; from < end && *from >= '0' && *from <= '9'; from++)
        if (__builtin_mul_overflow(value, 10, &value) || __builtin_add_overflow(value, *from - '0', &value))
            return NULL;
    *out = negative ? -value : value;
    return from;
}

void text_with_point(char *out, const char *printed)
{
    size_t length = 0;
    for (const char *c = printed; *c; c++) {
        if (strchr("0123456789+-e", *c))
            out[length++] = *c;
        else if (length && out[length - 1] != '.')
            out[length++] = '.';
    }
    out[length] = '\0';
}

bool text_is_double(const char *whole, double *out)
{
    const char *end = whole + strlen(whole);
    return text_parse_double(whole, end, out) == end && end != whole;
}

bool text_is_int(const char *whole, long long *out)
{
    const char *end = whole + strlen(whole);
    return text_parse_int(whole, end, out) == end && end != whole;
}

bool text_glob(const char *pattern, const char *subject)
{
    const char *star = NULL, *retry = NULL;
    while (*subject) {
        if (*pattern == '*') {
            star = pattern++;
            retry = subject;
        } else if (*pattern == '?' || *pattern == *subject) {
            pattern++;
            subject++;
        } else if (star) {
            pattern = star + 1;
            subject = ++retry;
        } else {
            return false;
        }
    }
    while (*pattern == '*')
        pattern++;
    return *pattern == '\0';
}

bool text_is_utf8(const char *bytes, size_t size)
{
    const unsigned char *p = (const unsigned char *)bytes, *end = p + size;
    while (p < end) {
        unsigned lead = *p++;
        if (lead < 0x80)
            continue;
        int more = lead >= 0xF0 && lead <= 0xF4 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC2 ? 1 : -1;
        if (lead > 0xF4 || more < 0 || end - p < more)
            return false;
        unsigned code = lead & (0x3Fu >> more);
        for (int i = 0; i < more; i++, p++) {
            if ((*p & 0xC0) != 0x80)
                return false;
            code = code << 6 | (*p & 0x3F);
        }
        if ((more == 2 && (code < 0x800 || (code >= 0xD800 && code <= 0xDFFF))) ||
            (more == 3 && (code < 0x10000 || code > 0x10FFFF)))
            return false;
    }
    return true;
}

enum { NAME_MAX_COMPARED = 63 };

static size_t edit_distance(const char *a, size_t a_size, const char *b, size_t b_size)
{
    size_t row[NAME_MAX_COMPARED + 1];
    for (size_t j = 0; j <= b_size; j++)
        row[j] = j;
    for (size_t i = 1; i <= a_size; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b_size; j++) {
            size_t changed = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            size_t best = changed < row[j] + 1 ? changed : row[j] + 1;
            row[j] = best < row[j - 1] + 1 ? best : row[j - 1] + 1;
        }
    }
    return row[b_size];
}

const char *text_nearest(const char *name, const char *const *candidates, size_t count)
{
    const char *best = NULL;
    size_t      length = strlen(name), best_distance = length / 3 + 2;
    if (length > NAME_MAX_COMPARED)
        return NULL;
    for (size_t i = 0; i < count; i++) {
        size_t other = strlen(candidates[i]);
        if (other > NAME_MAX_COMPARED)
            continue;
        size_t distance = edit_distance(name, length, candidates[i], other);
        if (distance < best_distance && distance < other) {
            best_distance = distance;
            best = candidates[i];
        }
    }
    return best;
}

size_t text_byte_order_mark(const char *bytes, size_t size)
{
    return size >= 3 && memcmp(bytes, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
}

/* Is it a control character that a terminal would act on? Messages may have lines of their own. */
static bool is_control(const unsigned char *c)
{
    return (*c < 0x20 && *c != '\n' && *c != '\t') || *c == 0x7f || (*c == 0xc2 && c[1] >= 0x80 && c[1] < 0xa0);
}

/* Does it turn the direction of what stands around it? U+200E, U+200F, U+202A to U+202E, U+2066 to U+2069. */
static bool turns_text(const unsigned char *c)
{
    return c[0] == 0xe2 && ((c[1] == 0x80 && (c[2] == 0x8e || c[2] == 0x8f || (c[2] >= 0xaa && c[2] <= 0xae))) ||
                            (c[1] == 0x81 && c[2] >= 0xa6 && c[2] <= 0xa9));
}

/* Bytes of the character that begins here; 0: what is there is none, or only the first part of one. */
static size_t whole_character(const char *text)
{
    const unsigned char first = (unsigned char)text[0];
    const size_t        wanted = first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    return strnlen(text, wanted) == wanted && text_is_utf8(text, wanted) ? wanted : 0;
}

void text_escape_controls(char *text, size_t size)
{
    char shown[8];
    for (size_t i = 0; text[i];) {
        const unsigned char *c = (const unsigned char *)&text[i];
        const size_t         length = strlen(text + i), character = whole_character(text + i);
        size_t               taken = character ? character : 1;
        if (character == 0) /* cut off by a limit, here or where it was quoted */
            shown[0] = '\0';
        else if (is_control(c))
            snprintf(shown, sizeof shown, "\\x%02x", c[character - 1]);
        else if (turns_text(c))
            snprintf(shown, sizeof shown, "\\u%04x", 0x2000u | (c[1] & 0x3fu) << 6 | (c[2] & 0x3fu));
        else {
            i += taken;
            continue;
        }
        const size_t put = strlen(shown);
        if (put > taken && i + put + (length - taken) >= size) { /* no room: what is behind it goes */
            text[i] = '\0';
            return;
        }
        memmove(text + i + put, text + i + taken, length - taken + 1);
        memcpy(text + i, shown, put);
        i += put;
    }
}
