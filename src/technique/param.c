#include "technique/param.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/paper.h"
#include "base/text.h"

enum { NUMBER_SIZE = 32, RANGE_SIZE = 2 * NUMBER_SIZE + 32, CONDITION_SIZE = 128 };

const char *param_type_text(param_type type)
{
    static const char *const names[] = {"int", "float", "bool", "enum", "colour", "direction", "palette", "text"};
    return (size_t)type < PARAM_COUNT(names) ? names[type] : "unknown";
}

const char *param_unit_text(param_unit unit)
{
    static const char *const names[] = {"", "pt", "deg", "count", "fraction"};
    return (size_t)unit < PARAM_COUNT(names) ? names[unit] : "";
}

size_t param_size(param_type type)
{
    switch (type) {
    case PARAM_INT:
    case PARAM_ENUM: return sizeof(int32_t);
    case PARAM_FLOAT: return sizeof(float);
    case PARAM_BOOL: return sizeof(bool);
    case PARAM_COLOUR: return sizeof(colour);
    case PARAM_DIRECTION: return sizeof(direction);
    case PARAM_PALETTE: return sizeof(palette);
    case PARAM_TEXT: return sizeof(param_words);
    }
    return 0;
}

/* The shortest decimal that gives the same float again. */
static void print_float(float value, char out[NUMBER_SIZE])
{
    if (value == truncf(value) && fabsf(value) < 1e7f) {
        snprintf(out, NUMBER_SIZE, "%.0f", (double)value);
        return;
    }
    for (int digits = 1; digits <= 9; digits++) {
        char raw[NUMBER_SIZE];
        snprintf(raw, sizeof raw, "%.*g", digits, (double)value);
        text_with_point(out, raw);
        double again;
        if (text_is_double(out, &again) && (float)again == value)
            return;
    }
}

static void print_number(double value, char out[NUMBER_SIZE])
{
    if (value == trunc(value) && fabs(value) < 1e15)
        snprintf(out, NUMBER_SIZE, "%.0f", value);
    else
        print_float((float)value, out);
}

void param_print_range(const param *p, char *out, size_t size)
{
    char        low[NUMBER_SIZE], high[NUMBER_SIZE];
    const char *unit = p->unit == UNIT_PT || p->unit == UNIT_DEGREES ? param_unit_text(p->unit) : "";
    print_number(p->min, low);
    print_number(p->max, high);
    snprintf(out, size, "%s to %s%s%s%s", low, high, *unit ? " " : "", unit, p->can_auto ? ", or auto" : "");
}

static void *field_of(const param *p, void *values)
{
    return (char *)values + p->offset;
}

const void *param_field(const param *p, const void *values)
{
    return (const char *)values + p->offset;
}

static void set_default(const param *p, void *values)
{
    void *field = field_of(p, values);
    switch (p->type) {
    case PARAM_INT:
    case PARAM_ENUM: *(int32_t *)field = (int32_t)p->def; break;
    case PARAM_FLOAT: *(float *)field = p->def_auto ? NAN : (float)p->def; break;
    case PARAM_BOOL: *(bool *)field = p->def != 0; break;
    case PARAM_COLOUR:
        *(colour *)field = p->def_colour;
        if (p->def_auto)
            ((colour *)field)->r = NAN;
        break;
    case PARAM_DIRECTION:
        *(direction *)field = p->def_direction;
        if (p->def_auto)
            ((direction *)field)->x = NAN;
        break;
    case PARAM_PALETTE: *(palette *)field = p->def_palette; break;
    case PARAM_TEXT:
        memset(field, 0, sizeof(param_words));
        if (p->def_text)
            memcpy(field, p->def_text, strnlen(p->def_text, PARAM_TEXT_MAX - 1));
        break;
    }
}

void params_set_defaults(const param *params, size_t count, void *values)
{
    for (size_t i = 0; i < count; i++)
        set_default(&params[i], values);
}

static lmn_status wrong_value(const param *p, const char *given, lmn_error *error)
{
    char range[RANGE_SIZE];
    switch (p->type) {
    case PARAM_INT:
        param_print_range(p, range, sizeof range);
        return error_set(error, LMN_USAGE, "%s is '%.60s'; allowed is a whole number from %s", p->key, given, range);
    case PARAM_FLOAT:
        param_print_range(p, range, sizeof range);
        return error_set(error, LMN_USAGE, "%s is '%.60s'; allowed is a number from %s%s", p->key, given, range,
                         p->unit == UNIT_PT ? "; lengths may say mm, cm, in, pt or px (1/96 in)" : "");
    case PARAM_BOOL: return error_set(error, LMN_USAGE, "%s is '%.60s'; allowed is true or false", p->key, given);
    case PARAM_COLOUR:
        return error_set(error, LMN_USAGE,
                         "%s is '%.60s'; allowed is a colour: #rgb, #rrggbb, #rrggbbaa, a basic CSS name, or none%s",
                         p->key, given, p->can_auto ? ", or auto" : "");
    case PARAM_DIRECTION:
        return error_set(error, LMN_USAGE, "%s is '%.60s'; allowed are three numbers X,Y,Z that are not all 0%s",
                         p->key, given, p->can_auto ? ", or auto" : "");
    case PARAM_PALETTE:
        return error_set(error, LMN_USAGE, "%s is '%.60s'; allowed are 1 to %d colours with commas between them",
                         p->key, given, PALETTE_MAX);
    case PARAM_TEXT:
        return error_set(error, LMN_USAGE,
                         "%s is '%.60s'; allowed is a text of up to %d bytes without control characters", p->key, given,
                         PARAM_TEXT_MAX - 1);
    case PARAM_ENUM: break;
    }
    return error_set(error, LMN_USAGE, "%s is '%.60s'", p->key, given);
}

static lmn_status wrong_name(const param *p, const char *name, lmn_error *error)
{
    text   list = {0};
    size_t count = 0;
    for (; p->names[count]; count++)
        text_append(&list, "%s%s", count ? ", " : "", p->names[count]);
    lmn_status status = error_set(error, LMN_USAGE, "%s is '%.60s'; allowed is one of %.300s", p->key, name,
                                  list.data ? list.data : "its names");
    text_release(&list);
    const char *near = text_nearest(name, p->names, count);
    if (near)
        error_hint(error, "did you mean '%s'?", near);
    return status;
}

static const char *skip_blanks(const char *at)
{
    while (*at == ' ')
        at++;
    return at;
}

static bool is_auto(const param *p, const char *given)
{
    return p->can_auto && strcmp(given, "auto") == 0;
}

static bool parse_int(const param *p, const char *given, int32_t *out)
{
    long long value;
    if (!text_is_int(given, &value) || (double)value < p->min || (double)value > p->max)
        return false;
    *out = (int32_t)value;
    return true;
}

/* A number, for lengths also with a unit: "0.5mm". What has none is points. */
static bool parse_number(const param *p, const char *given, double *out)
{
    static const struct {
        const char *name;
        double      points;
    } units[] = {{"", 1},
                 {"pt", 1},
                 {"mm", 1 / MM_PER_POINT},
                 {"cm", 10 / MM_PER_POINT},
                 {"in", POINTS_PER_INCH},
                 {"px", POINTS_PER_INCH / PX_PER_INCH}};
    if (p->unit != UNIT_PT)
        return text_is_double(given, out);
    const char *unit = text_parse_double(given, given + strlen(given), out);
    if (!unit)
        return false;
    for (size_t i = 0; i < PARAM_COUNT(units); i++)
        if (strcmp(skip_blanks(unit), units[i].name) == 0) {
            *out *= units[i].points;
            return true;
        }
    return false;
}

static bool parse_float(const param *p, const char *given, float *out)
{
    double value;
    if (is_auto(p, given)) {
        *out = NAN;
        return true;
    }
    /* Written so that NaN is refused. */
    if (!parse_number(p, given, &value) || !(value >= p->min && value <= p->max) || !isfinite(value))
        return false;
    *out = (float)value;
    return true;
}

static bool parse_bool(const char *given, bool *out)
{
    static const char *const yes[] = {"true", "yes", "on", "1"}, *const no[] = {"false", "no", "off", "0"};
    for (size_t i = 0; i < PARAM_COUNT(yes); i++) {
        if (strcmp(given, yes[i]) == 0)
            return *out = true;
        if (strcmp(given, no[i]) == 0) {
            *out = false;
            return true;
        }
    }
    return false;
}

static bool parse_direction(const param *p, const char *given, direction *out)
{
    float *const parts[3] = {&out->x, &out->y, &out->z};
    const char  *at = given, *end = given + strlen(given);
    if (is_auto(p, given)) {
        *out = (direction){NAN, 0, 0};
        return true;
    }
    for (int i = 0; i < 3; i++) {
        double value;
        at = skip_blanks(at);
        if (i && *at++ != ',')
            return false;
        at = text_parse_double(skip_blanks(at), end, &value);
        if (!at || !isfinite((float)value) || (p->max > p->min && (value < p->min || value > p->max)))
            return false;
        *parts[i] = (float)value;
    }
    return *skip_blanks(at) == '\0' && (out->x != 0 || out->y != 0 || out->z != 0);
}

static bool parse_palette(const char *given, palette *out)
{
    palette result = {0};
    for (const char *at = given;;) {
        at = skip_blanks(at);
        size_t length = strcspn(at, ", ");
        char   word[24];
        if (result.count == PALETTE_MAX || length == 0 || length >= sizeof word)
            return false;
        memcpy(word, at, length);
        word[length] = '\0';
        if (!colour_parse(word, &result.colours[result.count++]))
            return false;
        at = skip_blanks(at + length);
        if (*at == '\0')
            break;
        if (*at++ != ',')
            return false;
    }
    *out = result;
    return true;
}

/* Control characters, those of UTF-8 too, and what turns text round or is none: marks of byte order, embeddings,
 * overrides and isolates, lines and paragraphs that end. */
static bool is_control(const unsigned char *c)
{
    static const char *const hidden[] = {"\xEF\xBB\xBF", "\xE2\x80\xA8", "\xE2\x80\xA9", "\xE2\x80\xAA",
                                         "\xE2\x80\xAB", "\xE2\x80\xAC", "\xE2\x80\xAD", "\xE2\x80\xAE",
                                         "\xE2\x81\xA6", "\xE2\x81\xA7", "\xE2\x81\xA8", "\xE2\x81\xA9"};
    if (*c < ' ' || *c == 127 || (*c == 0xC2 && c[1] >= 0x80 && c[1] < 0xA0))
        return true;
    for (size_t i = 0; i < PARAM_COUNT(hidden); i++)
        if (strncmp((const char *)c, hidden[i], 3) == 0)
            return true;
    return false;
}

static bool parse_words(const char *given, param_words *out)
{
    size_t length = strlen(given);
    if (length >= sizeof out->text)
        return false;
    for (size_t i = 0; i < length; i++)
        if (is_control((const unsigned char *)given + i))
            return false;
    memset(out, 0, sizeof *out);
    memcpy(out->text, given, length);
    return true;
}

/* Sets nothing when it returns false. */
static bool parse_value(const param *p, const char *given, void *field)
{
    direction d;
    colour    c;
    switch (p->type) {
    case PARAM_INT: return parse_int(p, given, field);
    case PARAM_FLOAT: return parse_float(p, given, field);
    case PARAM_BOOL: return parse_bool(given, field);
    case PARAM_COLOUR:
        if (is_auto(p, given))
            c = (colour){NAN, 0, 0, 0};
        else if (!colour_parse(given, &c))
            return false;
        *(colour *)field = c;
        return true;
    case PARAM_DIRECTION:
        if (!parse_direction(p, given, &d))
            return false;
        *(direction *)field = d;
        return true;
    case PARAM_PALETTE: return parse_palette(given, field);
    case PARAM_TEXT: return parse_words(given, field);
    case PARAM_ENUM:
        for (int32_t i = 0; p->names[i]; i++)
            if (strcmp(p->names[i], given) == 0) {
                *(int32_t *)field = i;
                return true;
            }
        return false;
    }
    return false;
}

lmn_status param_set_text(const param *p, void *values, const char *given, lmn_error *error)
{
    if (p->type == PARAM_TEXT && p->check && given[0]) {
        lmn_status status = p->check(given, error);
        if (status != LMN_OK)
            return status;
    }
    if (parse_value(p, given, field_of(p, values)))
        return LMN_OK;
    return p->type == PARAM_ENUM ? wrong_name(p, given, error) : wrong_value(p, given, error);
}

bool param_is_auto(const param *p, const void *values)
{
    const void *field = param_field(p, values);
    return p->can_auto && ((p->type == PARAM_FLOAT && isnan(*(const float *)field)) ||
                           (p->type == PARAM_COLOUR && isnan(((const colour *)field)->r)) ||
                           (p->type == PARAM_DIRECTION && isnan(((const direction *)field)->x)));
}

static void print_direction(direction d, char *out, size_t size)
{
    char x[NUMBER_SIZE], y[NUMBER_SIZE], z[NUMBER_SIZE];
    print_float(d.x, x);
    print_float(d.y, y);
    print_float(d.z, z);
    snprintf(out, size, "%s,%s,%s", x, y, z);
}

static void print_palette(const palette *list, char *out, size_t size)
{
    size_t length = 0;
    out[0] = '\0';
    for (int32_t i = 0; i < list->count && i < PALETTE_MAX; i++) {
        char one[10];
        colour_print(list->colours[i], one);
        int written = snprintf(out + length, size - length, "%s%s", i ? "," : "", one);
        if (written < 0 || (size_t)written >= size - length)
            return;
        length += (size_t)written;
    }
}

void param_print(const param *p, const void *values, char *out, size_t size)
{
    const void *field = param_field(p, values);
    char        number[NUMBER_SIZE];
    if (param_is_auto(p, values)) {
        snprintf(out, size, "auto");
        return;
    }
    switch (p->type) {
    case PARAM_INT: snprintf(out, size, "%d", (int)*(const int32_t *)field); break;
    case PARAM_FLOAT:
        print_float(*(const float *)field, number);
        snprintf(out, size, "%s", number);
        break;
    case PARAM_BOOL: snprintf(out, size, "%s", *(const bool *)field ? "true" : "false"); break;
    case PARAM_ENUM: snprintf(out, size, "%s", p->names[*(const int32_t *)field]); break;
    case PARAM_COLOUR:
        colour_print(*(const colour *)field, number);
        snprintf(out, size, "%s", number);
        break;
    case PARAM_DIRECTION: print_direction(*(const direction *)field, out, size); break;
    case PARAM_PALETTE: print_palette(field, out, size); break;
    case PARAM_TEXT: snprintf(out, size, "%s", ((const param_words *)field)->text); break;
    }
}

/* Compared as printed: colours count as equal when no file could tell them apart. */
bool param_is_default(const param *p, const void *values)
{
    param_value standard;
    param       alone = *p;
    char        is[128], was[128];
    alone.offset = 0;
    memset(&standard, 0, sizeof standard);
    set_default(&alone, &standard);
    param_print(&alone, &standard, was, sizeof was);
    param_print(p, values, is, sizeof is);
    return strcmp(is, was) == 0;
}

static const param *find_row(const param *params, size_t count, const char *key, size_t length)
{
    for (size_t i = 0; i < count; i++)
        if (strncmp(params[i].key, key, length) == 0 && params[i].key[length] == '\0')
            return &params[i];
    return NULL;
}

/* Anything but 0, false, "auto", a transparent colour and an empty text. */
static bool is_set(const param *p, const void *values)
{
    const void *field = param_field(p, values);
    switch (p->type) {
    case PARAM_INT:
    case PARAM_ENUM: return *(const int32_t *)field != 0;
    case PARAM_FLOAT: return *(const float *)field != 0 && !param_is_auto(p, values);
    case PARAM_BOOL: return *(const bool *)field;
    case PARAM_COLOUR: return ((const colour *)field)->a != 0 && !param_is_auto(p, values);
    case PARAM_DIRECTION: return !param_is_auto(p, values);
    case PARAM_PALETTE: return ((const palette *)field)->count != 0;
    case PARAM_TEXT: return ((const param_words *)field)->text[0] != '\0';
    }
    return false;
}

/* One term of a condition: [!]KEY, or [!]KEY, a sign and what it is held against. */
typedef struct condition_term {
    const char *key, *sign, *end; /* sign == end: there is none */
    bool        negated;
} condition_term;

static condition_term term_at(const char *at)
{
    condition_term term = {.negated = *at == '!', .end = at + strcspn(at, "&")};
    term.key = at + term.negated;
    term.sign = term.key;
    while (term.sign < term.end && !strchr("=<>", *term.sign))
        term.sign++;
    return term;
}

static const param *term_row(condition_term term, const param *params, size_t count)
{
    return find_row(params, count, term.key, (size_t)(term.sign - term.key));
}

static bool is_number(const param *p)
{
    return p->type == PARAM_INT || p->type == PARAM_FLOAT;
}

static bool number_holds(condition_term term, const param *p, const void *values)
{
    double bound;
    if (!is_number(p) || text_parse_double(term.sign + 1, term.end, &bound) != term.end)
        return false;
    const void *field = param_field(p, values);
    double      number = p->type == PARAM_INT ? *(const int32_t *)field : (double)*(const float *)field;
    return *term.sign == '>' ? number > bound : number < bound;
}

/* The next of the words behind '=', and its length; NULL behind the last. */
static const char *next_word(condition_term term, const char *word, size_t *length)
{
    word = word ? word + *length + 1 : term.sign + 1;
    if (word > term.end)
        return NULL;
    const char *comma = memchr(word, ',', (size_t)(term.end - word));
    *length = (size_t)((comma ? comma : term.end) - word);
    return word;
}

static bool prints_as_a_word(condition_term term, const param *p, const void *values)
{
    char   is[CONDITION_SIZE];
    size_t length = 0;
    param_print(p, values, is, sizeof is);
    for (const char *word = NULL; (word = next_word(term, word, &length));)
        if (strlen(is) == length && memcmp(is, word, length) == 0)
            return true;
    return false;
}

static bool term_holds(condition_term term, const param *params, size_t count, const void *values)
{
    const param *p = term_row(term, params, count);
    if (!p)
        return false;
    bool holds;
    if (term.sign == term.end)
        holds = is_set(p, values);
    else if (*term.sign == '=')
        holds = prints_as_a_word(term, p, values);
    else
        holds = number_holds(term, p, values);
    return holds != term.negated;
}

bool params_condition(const char *condition, const param *params, size_t count, const void *values)
{
    if (!condition)
        return true;
    for (const char *at = condition;; at++) {
        condition_term term = term_at(at);
        if (!term_holds(term, params, count, values))
            return false;
        at = term.end;
        if (!*at)
            return true;
    }
}

/* A word is a value when it is what the value prints as: "0.50" never equals anything. */
static bool is_value(const param *p, const char *word, size_t length)
{
    param       alone = *p;
    param_value value;
    char        text[CONDITION_SIZE], is[CONDITION_SIZE];
    if (length >= sizeof text)
        return false;
    snprintf(text, sizeof text, "%.*s", (int)length, word);
    alone.offset = 0;
    memset(&value, 0, sizeof value);
    if (param_set_text(&alone, &value, text, NULL) != LMN_OK)
        return false;
    param_print(&alone, &value, is, sizeof is);
    return strcmp(is, text) == 0;
}

static lmn_status check_words(condition_term term, const param *p, const char *condition, lmn_error *error)
{
    size_t length = 0;
    for (const char *word = NULL; (word = next_word(term, word, &length));)
        if (!is_value(p, word, length))
            return error_set(error, LMN_USAGE, "condition '%.200s': '%.*s' is no value of %s", condition, (int)length,
                             word, p->key);
    return LMN_OK;
}

static lmn_status check_number(condition_term term, const param *p, const char *condition, lmn_error *error)
{
    double bound;
    if (!is_number(p))
        return error_set(error, LMN_USAGE, "condition '%.200s': %s is no number but %s; name its values: %s=…",
                         condition, p->key, param_type_text(p->type), p->key);
    if (text_parse_double(term.sign + 1, term.end, &bound) != term.end)
        return error_set(error, LMN_USAGE, "condition '%.200s': %s is compared with no number", condition, p->key);
    return LMN_OK;
}

void params_scale_lengths(const param *params, size_t count, void *values, double factor)
{
    for (size_t i = 0; i < count; i++)
        if (params[i].unit == UNIT_PT && params[i].type == PARAM_FLOAT) {
            float *length = (float *)((char *)values + params[i].offset);
            *length = (float)((double)*length * factor);
        }
}

lmn_status params_condition_check(const char *condition, const param *params, size_t count, lmn_error *error)
{
    for (const char *at = condition; at; at++) {
        condition_term term = term_at(at);
        const param   *p = term_row(term, params, count);
        if (!p)
            return error_set(error, LMN_USAGE, "condition '%.200s': there is no parameter '%.*s'", condition,
                             (int)(term.sign - term.key), term.key);
        lmn_status status = LMN_OK;
        if (term.sign < term.end)
            status =
                *term.sign == '=' ? check_words(term, p, condition, error) : check_number(term, p, condition, error);
        at = term.end;
        if (status != LMN_OK || !*at)
            return status;
    }
    return LMN_OK;
}
