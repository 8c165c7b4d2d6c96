/* include/limner/limits.h: limits as text, from their rows. */
#include "limner/limits.h"

#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/limit_rows.h"
#include "base/text.h"

#define KIB 1024.0
#define MIB (KIB * KIB)
#define GIB (KIB * MIB)

/* --- values as text ------------------------------------------------------------------------------------- */

typedef struct unit {
    const char *name;
    double      factor;
} unit;

/* The first one is how values are printed where it divides them. */
static const unit seconds[] = {{"s", 1}, {"min", 60}, {"h", 3600}, {"", 1}};
static const unit bytes[] = {{"G", GIB}, {"M", MIB}, {"k", KIB}, {"K", KIB}, {"", 1}};
static const unit counts[] = {{"G", 1e9}, {"M", 1e6}, {"k", 1e3}, {"K", 1e3}, {"", 1}};

static size_t units_of(limit_kind kind, const unit **out)
{
    *out = kind == LIMIT_SECONDS ? seconds : kind == LIMIT_BYTES ? bytes : counts;
    return kind == LIMIT_SECONDS ? sizeof seconds / sizeof *seconds : sizeof bytes / sizeof *bytes;
}

static void print_value(char *out, size_t size, const limit_row *row, double value)
{
    const unit *list;
    size_t      count = units_of(row->kind, &list), i = 0;
    if (value == 0) {
        snprintf(out, size, "none");
        return;
    }
    while (i + 1 < count &&
           (value < list[i].factor || value / list[i].factor != (double)(uint64_t)(value / list[i].factor)))
        i++;
    snprintf(out, size, "%.0f%s", value / list[i].factor, list[i].name);
}

static bool parse_value(const limit_row *row, const char *text, size_t length, double *out)
{
    const unit *list;
    size_t      count = units_of(row->kind, &list);
    if (length == 4 && strncmp(text, "none", 4) == 0) {
        *out = 0;
        return true;
    }
    const char *end = text + length, *behind = text_parse_double(text, end, out);
    if (!behind || !(*out > 0))
        return false;
    for (size_t i = 0; i < count; i++)
        if (strlen(list[i].name) == (size_t)(end - behind) &&
            strncmp(list[i].name, behind, (size_t)(end - behind)) == 0) {
            *out *= list[i].factor;
            return *out <= 9e15 && (row->kind == LIMIT_SECONDS || *out >= 1);
        }
    return false;
}

static const limit_row *find_row(const char *name, size_t length)
{
    for (size_t i = 0; i < limit_row_count; i++)
        if (strlen(limit_rows[i].name) == length && strncmp(limit_rows[i].name, name, length) == 0)
            return &limit_rows[i];
    return NULL;
}

static lmn_status set_one(lmn_limits *limits, const char *text, size_t length, lmn_error *error)
{
    const char      *equals = memchr(text, '=', length);
    size_t           name = equals ? (size_t)(equals - text) : length;
    const limit_row *row = find_row(text, name);
    double           value;
    if (!row || !equals) {
        error_set(error, LMN_USAGE, "the limit '%.*s' is not known", (int)(length < 60 ? length : 60), text);
        error_hint(error, "limits are time, memory, triangles, pixels and textures; for example time=30s,memory=2G");
        return LMN_USAGE;
    }
    if (!parse_value(row, equals + 1, length - name - 1, &value)) {
        error_set(error, LMN_USAGE, "the limit %s is '%.*s'; allowed is a number above 0 with %s, or none", row->name,
                  (int)(length - name - 1 < 40 ? length - name - 1 : 40), equals + 1,
                  row->kind == LIMIT_SECONDS ? "s, min or h" : "k, M or G");
        return LMN_USAGE;
    }
    limit_put(limits, row, value);
    return LMN_OK;
}

lmn_status lmn_limits_set(lmn_limits *limits, const char *text, lmn_error *error)
{
    if (!limits || limits->struct_size != sizeof *limits || !text)
        return error_set(error, LMN_USAGE, "limits begin with lmn_limits_standard or lmn_limits_safe");
    lmn_limits changed = *limits;
    for (const char *at = text;;) {
        size_t     length = strcspn(at, ",");
        lmn_status status = set_one(&changed, at, length, error);
        if (status != LMN_OK)
            return status;
        if (!at[length])
            break;
        at += length + 1;
    }
    *limits = changed;
    return LMN_OK;
}

bool lmn_limit_at(size_t index, lmn_limit_info *out)
{
    if (index >= limit_row_count || !out)
        return false;
    *out = (lmn_limit_info){.name = limit_rows[index].name, .doc = limit_rows[index].doc};
    print_value(out->standard, sizeof out->standard, &limit_rows[index], limit_rows[index].standard);
    print_value(out->safe, sizeof out->safe, &limit_rows[index], limit_rows[index].safe);
    return true;
}
