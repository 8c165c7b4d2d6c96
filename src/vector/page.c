/* What descriptions of sheets say in words: pages, scales, views, units. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/text.h"
#include "vector/vector_private.h"

static const struct {
    const char *name;
    double      size[2]; /* mm; as it lies usually */
} pages[] = {
    {"A0", {1189, 841}},       {"A1", {841, 594}},          {"A2", {594, 420}}, {"A3", {420, 297}},
    {"A4", {210, 297}},        {"A5", {148, 210}},          {"A6", {105, 148}}, {"letter", {215.9, 279.4}},
    {"legal", {215.9, 355.6}}, {"tabloid", {431.8, 279.4}},
};

static bool same_letters(const char *a, const char *b, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if ((a[i] | 0x20) != (b[i] | 0x20))
            return false;
    return true;
}

static lmn_status refuse_page(const char *given, lmn_error *error)
{
    error_set(error, LMN_USAGE,
              "the page is '%.60s'; allowed is A0 to A6, letter, legal, tabloid, each with -landscape or -portrait, or "
              "WIDTHxHEIGHTmm",
              given);
    error_hint(error, "for example A4, A3-portrait or 120x80mm; sides of 1 to %d mm", PAGE_SIDE_MOST);
    return LMN_USAGE;
}

static bool parse_size(const char *text, double out[2])
{
    const char *end = text + strlen(text), *at = text_parse_double(text, end, &out[0]);
    if (!at || (*at | 0x20) != 'x')
        return false;
    at = text_parse_double(at + 1, end, &out[1]);
    if (!at || (*at && strcmp(at, "mm") != 0))
        return false;
    for (int k = 0; k < 2; k++)
        if (!(out[k] >= 1 && out[k] <= PAGE_SIDE_MOST))
            return false;
    return true;
}

lmn_status vector_parse_page(const char *text, double out[2], lmn_error *error)
{
    if (parse_size(text, out))
        return LMN_OK;
    for (size_t i = 0; i < sizeof pages / sizeof *pages; i++) {
        size_t length = strlen(pages[i].name);
        if (strlen(text) < length || !same_letters(text, pages[i].name, length))
            continue;
        const char *turn = text + length;
        double      less = fmin(pages[i].size[0], pages[i].size[1]), more = fmax(pages[i].size[0], pages[i].size[1]);
        bool        wide = strcmp(turn, "-landscape") == 0, tall = strcmp(turn, "-portrait") == 0;
        if (*turn && !wide && !tall)
            continue;
        out[0] = wide ? more : tall ? less : pages[i].size[0];
        out[1] = wide ? less : tall ? more : pages[i].size[1];
        return LMN_OK;
    }
    return refuse_page(text, error);
}

lmn_status vector_parse_scale(const char *text, double *out, lmn_error *error)
{
    const char *end = text + strlen(text);
    double      paper = 0, model = 0;
    const char *at = text_parse_double(text, end, &paper);
    if (at && *at == ':')
        at = text_parse_double(at + 1, end, &model);
    else
        at = NULL;
    *out = paper / model;
    if (at && at == end && paper > 0 && model > 0 && *out >= 1e-9 && *out <= 1e9)
        return LMN_OK;
    error_set(error, LMN_USAGE, "the scale is '%.60s'; allowed is PAPER:MODEL", text);
    error_hint(error, "for example 1:20, 1:1 or 5:1");
    return LMN_USAGE;
}

static const char *const view_names[] = {"iso", "front", "back", "left", "right", "top", "bottom"};

const char *vector_view_name(lmn_view view)
{
    return view_names[view];
}

lmn_status vector_parse_views(const char *text, vector_view out[VIEWS_MOST], size_t *count, lmn_error *error)
{
    *count = 0;
    for (const char *at = text;; at++) {
        size_t length = strcspn(at, ","), which = 0;
        while (which < VIEWS_MOST &&
               !(strlen(view_names[which]) == length && strncmp(view_names[which], at, length) == 0))
            which++;
        if (which == VIEWS_MOST)
            return error_set(
                error, LMN_USAGE,
                "the views are '%.80s'; allowed is iso, front, back, left, right, top and bottom, separated by commas",
                text);
        for (size_t i = 0; i < *count; i++)
            if (out[i].direction == (lmn_view)which)
                return error_set(error, LMN_USAGE, "the views are '%.80s'; %s is there twice", text, view_names[which]);
        out[*count] = (vector_view){.direction = (lmn_view)which};
        snprintf(out[*count].name, sizeof out[*count].name, "%s", view_names[which]);
        ++*count;
        at += length;
        if (!*at)
            return LMN_OK;
    }
}

/* ISO 5455: 1, 2 and 5 times powers of ten. */
double vector_usual_scale(double scale)
{
    static const double series[] = {1, 2, 5};
    if (!(scale > 1e-9) || !(scale < 1e9))
        return scale;
    double unit = pow(10, floor(log10(scale) + 1e-9)), best = unit;
    for (size_t i = 0; i < sizeof series / sizeof *series; i++)
        if (unit * series[i] <= scale * (1 + 1e-9))
            best = unit * series[i];
    return best;
}

void vector_print_scale(char out[32], double scale)
{
    double ratio = scale >= 1 ? scale : 1 / scale, rounded = round(ratio);
    bool   whole = fabs(ratio - rounded) < 1e-6 * ratio;
    char   number[20];
    snprintf(number, sizeof number, whole ? "%.0f" : "%.3g", whole ? rounded : ratio);
    if (scale >= 1)
        snprintf(out, 32, "%s:1", number);
    else
        snprintf(out, 32, "1:%s", number);
}
